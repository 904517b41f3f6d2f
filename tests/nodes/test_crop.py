"""Crop against slices and OpenImageIO."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.nodes.distort.crop import Crop
from oiio_pictures import make_buffer

CORNERS = {"top_left": (0.25, 0.1), "bottom_right": (0.8, 0.9)}


@pytest.mark.parametrize("size", [(40, 30), (23, 17), (2, 3), (1, 1)])
def test_it_is_openimageios(run, hdr, size):
    picture = hdr(*size)
    left, top, right, bottom = Crop(**CORNERS).box(size)
    roi = oiio.ROI(left, right, top, bottom)
    out = run(Crop(**CORNERS), {"image": picture})
    np.testing.assert_array_equal(out, oiio.ImageBufAlgo.cut(make_buffer(picture), roi).get_pixels("float"))
    kept = run(Crop(**CORNERS, resize=False), {"image": picture})
    expected = np.zeros_like(picture)
    expected[top:bottom, left:right] = picture[top:bottom, left:right]
    np.testing.assert_array_equal(kept, expected)


def test_corners_are_rounded_sorted_and_kept_inside():
    assert Crop(**CORNERS).box((40, 30)) == (10, 3, 32, 27)
    assert Crop(top_left=(0.8, 0.9), bottom_right=(0.25, 0.1)).box((40, 30)) == (10, 3, 32, 27)
    assert Crop(top_left=(-3.0, 0.5), bottom_right=(7.0, 0.5)).box((40, 30)) == (0, 15, 40, 16)
    assert Crop(top_left=(1.0, 1.0)).box((40, 30)) == (39, 29, 40, 30)


def test_all_of_the_picture_vanishes():
    assert Crop().identity() == "image" and Crop(softness=1.0).identity() is None


def test_softness_fades_evenly(run):
    out = run(Crop(softness=10.0), {"image": np.ones((40, 60, 4))})
    across = np.minimum(np.arange(60) + 0.5, 59.5 - np.arange(60)).clip(0, 10) / 10
    down = np.minimum(np.arange(40) + 0.5, 39.5 - np.arange(40)).clip(0, 10) / 10
    assert np.abs(out - (down[:, None] * across)[..., None]).max() < 1e-6


def test_a_proxy_shows_the_same_part(run):
    picture = np.zeros((40, 60, 4), np.float32)
    picture[8:20, 12:48] = 1.0
    node = Crop(top_left=(0.2, 0.2), bottom_right=(0.8, 0.5))
    half = run(node, {"image": picture}, scale=0.5)
    assert half.shape == (6, 18, 4) and half[1:-1, 1:-1].min() > 0.99
