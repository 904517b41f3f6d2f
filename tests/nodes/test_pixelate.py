"""Pixelate against numpy and OpenCV."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.distort.pixelate import Pixelate


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
    picture = hdr(24, 12)
    out = run(Pixelate(size=(4.0, 4.0), sampling="center"), {"image": picture})
    np.testing.assert_array_equal(out, np.kron(picture[2::4, 2::4], np.ones((4, 4, 1))))


def test_a_proxy_has_as_many_squares(run, hdr):
    picture = hdr(48, 32)
    full, half = (run(Pixelate(), {"image": picture}, scale=scale) for scale in (1.0, 0.5))
    assert [len(np.unique(out[..., 0])) for out in (full, half)] == [24, 24]
    assert Pixelate(size=(1.0, 1.0)).identity() == "image"
