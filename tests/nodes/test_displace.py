"""Displacement against scipy and OpenCV."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.distort.displace import Displace
from scipy.ndimage import map_coordinates


def vectors(width: int, height: int) -> np.ndarray:
    return np.random.default_rng(width + height).uniform(-1.0, 1.0, (height, width, 2)).astype(np.float32)


def moved(picture: np.ndarray, by: np.ndarray, mode: str) -> np.ndarray:
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    where = [y + by[..., 1].astype(np.float64), x + by[..., 0].astype(np.float64)]
    return np.stack([map_coordinates(c, where, order=1, mode=mode) for c in np.moveaxis(picture, -1, 0)], axis=-1)


@pytest.mark.parametrize("size", [(41, 29), (6, 5), (1, 3), (1, 1)])
@pytest.mark.parametrize("amount", [(0.8, 0.8), (7.0, -3.0), (60.0, 45.0)])
def test_it_equals_scipy(run, hdr, edge, size, amount):
    picture, map_ = hdr(*size), vectors(*size)
    expected = moved(picture.astype(np.float64), map_ * np.float32(amount), edge.scipy_map)
    found = run(Displace(amount=amount, edge=edge.name), {"image": picture, "vector": map_})
    # A position in 32 bits is known to 4e-6 pixels: an error of that times the steepest slope.
    assert np.abs(found - expected).max() <= 1e-5 * picture.max()


def test_it_equals_opencv(run, hdr):
    picture = hdr(64, 48)
    by = np.round(vectors(64, 48) * 5.0 * 32.0) / 32.0  # OpenCV knows fractions of 1/32
    y, x = np.mgrid[:48, :64].astype(np.float32)
    expected = cv2.remap(picture, x + by[..., 0], y + by[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    found = run(Displace(amount=(1.0, 1.0)), {"image": picture, "vector": by})
    assert np.abs(found - expected).max() <= 1e-4 * picture.max()


def test_whole_pixels_move_exactly(run, hdr):
    picture = hdr(23, 19)
    right = np.zeros((19, 23, 2), np.float32)
    right[...] = (0.5, -0.25)
    found = run(Displace(amount=(6.0, 8.0), edge="wrap"), {"image": picture, "vector": right})
    np.testing.assert_array_equal(found, np.roll(picture, (2, -3), (0, 1)))


def test_nothing_moves_without_vectors_or_amount(run, hdr):
    picture, still = hdr(14, 9), Displace(amount=(0.0, 0.0))
    assert still.identity() == "image"
    np.testing.assert_array_equal(run(still, {"image": picture, "vector": vectors(14, 9)}), picture)
    np.testing.assert_array_equal(run(Displace(), {"image": picture, "vector": np.zeros((9, 14, 2))}), picture)
    np.testing.assert_array_equal(run(Displace(), {"image": picture}), picture)


@pytest.mark.parametrize("wild", [np.nan, np.inf, -np.inf, 1e30, -3e38])
def test_wild_vectors_stay_harmless(run, hdr, edge, wild):
    picture, map_ = hdr(11, 10), vectors(11, 10)
    map_[4, 5] = wild
    picture[7, 7, 0] = np.nan
    assert np.isfinite(run(Displace(edge=edge.name), {"image": picture, "vector": map_})).all()
