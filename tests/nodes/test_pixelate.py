"""Pixelate against numpy and OpenCV."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.distort.pixelate import Pixelate
from scipy.ndimage import map_coordinates


@pytest.mark.parametrize("side", [(4, 4), (6, 2), (24, 12)])
def test_whole_squares_are_their_averages(run, hdr, side):
    picture = hdr(24, 12)
    blocks = picture.astype(np.float64).reshape(12 // side[1], side[1], 24 // side[0], side[0], 4).mean((1, 3))
    expected = np.kron(blocks, np.ones((side[1], side[0], 1)))
    assert np.abs(run(Pixelate(size=side), {"image": picture}) - expected).max() < 1e-6 * picture.max()


def test_broken_squares_are_opencvs_areas(run, hdr):
    picture = hdr(40, 30)
    small = cv2.resize(picture, (16, 8), interpolation=cv2.INTER_AREA)
    y, x = np.mgrid[:30, :40] + 0.5
    expected = small[(y / 3.75).astype(int), (x / 2.5).astype(int)]
    assert np.abs(run(Pixelate(size=(2.5, 3.75)), {"image": picture}) - expected).max() < 2e-6 * picture.max()


@pytest.mark.parametrize("size", [(23, 17), (2, 3), (1, 1)])
def test_squares_are_cut_off_by_the_picture(run, hdr, size):
    picture = hdr(*size)
    out = run(Pixelate(size=(5.0, 5.0)), {"image": picture})
    expected = np.zeros(picture.shape)
    for top in range(0, size[1], 5):
        for left in range(0, size[0], 5):
            block = np.s_[top : top + 5, left : left + 5]
            expected[block] = picture[block].astype(np.float64).mean((0, 1))
    assert np.abs(out - expected).max() < 1e-6 * picture.max()


def test_the_light_stays(run, hdr):
    picture = hdr(48, 32)
    out = run(Pixelate(), {"image": picture})
    assert np.abs(out.mean((0, 1)) / picture.mean((0, 1)) - 1.0).max() < 1e-5


def test_centers_are_pixels_of_the_picture(run, hdr):
    picture = hdr(25, 15)
    out = run(Pixelate(size=(5.0, 3.0), sampling="center"), {"image": picture})
    np.testing.assert_array_equal(out, np.kron(picture[1::3, 2::5], np.ones((3, 5, 1))))


def test_centers_between_pixels_are_scipys_interpolation(run, hdr):
    """Squares of an even number of pixels have their center between them; those at the far edges are cut off."""
    picture, side = hdr(30, 18), (4.0, 2.5)
    out = run(Pixelate(size=side, sampling="center"), {"image": picture})
    first = [np.arange(0.0, count, step) for count, step in zip((30, 18), side, strict=True)]
    across, down = (
        0.5 * (low + np.minimum(low + step, count)) for low, step, count in zip(first, side, (30, 18), strict=True)
    )
    places = np.meshgrid(down - 0.5, across - 0.5, indexing="ij")
    squares = np.stack(
        [
            map_coordinates(layer, places, order=1, mode="nearest")
            for layer in np.moveaxis(picture.astype(np.float64), 2, 0)
        ],
        2,
    )
    y, x = np.mgrid[:18, :30] + 0.5
    expected = squares[(y / side[1]).astype(int), (x / side[0]).astype(int)]
    assert np.abs(out - expected).max() < 1e-6 * picture.max()


def test_centers_lie_at_the_same_place_at_twice_the_size(run):
    """A slope that both pictures show exactly has the same squares."""
    small, large = (np.repeat(((np.arange(width) + 0.5) / width)[None, :, None], 4, 2) for width in (40, 80))
    small, large = (np.repeat(row, 8, 0) for row in (small, large))
    found = [
        run(Pixelate(size=(side, 4.0), sampling="center"), {"image": p}) for side, p in ((4.0, small), (8.0, large))
    ]
    np.testing.assert_allclose(found[0][:4], found[1][:4, ::2], atol=1e-6)


def test_a_proxy_has_as_many_squares(run, hdr):
    picture = hdr(48, 32)
    full, half = (run(Pixelate(), {"image": picture}, scale=scale) for scale in (1.0, 0.5))
    assert [len(np.unique(out[..., 0])) for out in (full, half)] == [24, 24]
    assert Pixelate(size=(1.0, 1.0)).identity() == "image"
