"""The ST map against OpenImageIO's st_warp and scipy."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.distort.st_map import StMap
from oiio_pictures import make_buffer
from warps import sample_bilinear


def positions(width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    y, x = np.mgrid[:height, :width] + 0.5
    return x, y


def st(x: np.ndarray, y: np.ndarray, origin: str) -> np.ndarray:
    height, width = x.shape
    return np.stack([x / width, 1 - y / height if origin == "bottom left" else y / height], -1).astype(np.float32)


@pytest.mark.parametrize("origin", StMap.values["origin"].choices)
@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
def test_it_looks_up_what_the_map_says(run, hdr, edge, size, origin):
    picture = hdr(*size)
    x, y = positions(*size)
    x, y = x + 0.3 * np.sin(0.5 * y) - 1.3, 0.9 * y + 2.2 + 0.2 * np.cos(0.4 * x)
    x = x * 0.9
    map_ = st(x, y, origin)
    out = run(StMap(origin=origin, edge=edge.name), {"image": picture, "st": map_})
    assert np.abs(out - sample_bilinear(picture, x, y, edge.scipy_map)).max() < 1e-5 * picture.max()


@pytest.mark.parametrize("shift", [0.0, 0.5, 3.0])
def test_it_is_openimageios(run, hdr, shift):
    picture = hdr(32, 16)
    x, y = positions(32, 16)
    map_ = st(x + shift, y, "top left")
    expected = oiio.ImageBufAlgo.st_warp(make_buffer(picture), oiio.ImageBuf(map_), "triangle").get_pixels("float")
    out = run(StMap(origin="top left", edge="clamp"), {"image": picture, "st": map_})
    inside = np.s_[1:-1, 4:-6]
    assert np.abs(out - expected)[inside].max() < 1e-5 * picture.max()


def test_a_map_that_shrinks_averages(run):
    stripes = np.zeros((32, 32, 4), np.float32)
    stripes[:, ::2] = 1.0
    x, y = positions(32, 32)
    out = run(StMap(edge="wrap"), {"image": stripes, "st": st(4 * x, 4 * y, "bottom left")})
    assert np.abs(out - 0.5)[2:-2, 2:-2].max() < 0.01


def test_holes_in_the_map_show_nothing(run, hdr):
    picture, map_ = hdr(9, 7), st(*positions(9, 7), "bottom left")
    map_[3, 4] = np.nan
    map_[5, 1] = np.inf
    out = run(StMap(), {"image": picture, "st": map_})
    assert np.isfinite(out).all() and not out[3, 4].any() and not out[5, 1].any() and out[0, 0].any()
