"""Pixelate against numpy and OpenCV."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.distort.pixelate import Pixelate
from scipy.interpolate import interp1d


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


def mean_between(picture, low, high):
    """The means of rows of numbers between places, from their integral; [places, ...]."""
    whole = np.concatenate([np.zeros((1, *picture.shape[1:])), np.cumsum(picture.astype(np.float64), 0)])
    integral = interp1d(np.arange(len(whole)), whole, axis=0)
    wide = (high - low).reshape(-1, *[1] * (picture.ndim - 1))
    return (integral(high) - integral(low)) / wide


@pytest.mark.parametrize("side", [(4.0, 2.5), (20.0, 9.0), (16.5, 12.0)])
def test_centers_are_the_means_of_their_middles(run, hdr, side):
    """Squares at the far edges are cut off, and so are their centers."""
    picture = hdr(46, 30)
    out = run(Pixelate(size=side, sampling="center"), {"image": picture})
    squares = picture
    for axis, (step, count) in enumerate(zip(reversed(side), (30, 46), strict=True)):
        low = np.arange(0.0, count, step)
        high = np.minimum(low + step, count)
        reach = 0.5 * np.minimum(max(step / 8.0, 1.0), high - low)
        middle = 0.5 * (low + high)
        squares = np.moveaxis(mean_between(np.moveaxis(squares, axis, 0), middle - reach, middle + reach), 0, axis)
    y, x = np.mgrid[:30, :46] + 0.5
    expected = squares[(y / side[1]).astype(int), (x / side[0]).astype(int)]
    assert np.abs(out - expected).max() < 1e-6 * picture.max()


@pytest.mark.parametrize("side", [(4.0, 4.0), (16.0, 8.0), (20.0, 12.0)])
def test_centers_show_the_same_at_twice_the_size(run, hdr, side):
    """Of a picture and one with each pixel twice as wide and high."""
    small = hdr(32, 16)
    large = np.kron(small, np.ones((2, 2, 1), np.float32))
    one = run(Pixelate(size=side, sampling="center"), {"image": small})
    other = run(Pixelate(size=(2.0 * side[0], 2.0 * side[1]), sampling="center"), {"image": large})
    assert np.abs(other - np.kron(one, np.ones((2, 2, 1)))).max() < 1e-6 * small.max()


def test_a_proxy_has_as_many_squares(run, hdr):
    picture = hdr(48, 32)
    full, half = (run(Pixelate(), {"image": picture}, scale=scale) for scale in (1.0, 0.5))
    assert [len(np.unique(out[..., 0])) for out in (full, half)] == [24, 24]
    assert Pixelate(size=(1.0, 1.0)).identity() == "image"
