"""Directional blur against scipy and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.blur.directional_blur import DirectionalBlur
from scipy.ndimage import map_coordinates, uniform_filter1d


def along(picture: np.ndarray, angle: float, length: float, shift: float, mode: str) -> np.ndarray:
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    count = math.ceil(length)
    sum_ = np.zeros(picture.shape)
    for t in (np.arange(count) + 0.5) / count - 0.5 + shift:
        dx, dy = length * t * math.cos(math.radians(angle)), -length * t * math.sin(math.radians(angle))
        sum_ += np.stack(
            [
                map_coordinates(channel, [y - dy, x - dx], order=1, mode=mode)
                for channel in np.moveaxis(picture.astype(np.float64), -1, 0)
            ],
            axis=-1,
        )
    return sum_ / count


@pytest.mark.parametrize("size", [(31, 22), (1, 5), (1, 1)])
@pytest.mark.parametrize(("angle", "length", "shift"), [(33.0, 12.5, 0.0), (-120.0, 40.0, 0.5)])
def test_it_equals_scipy(run, hdr, edge, size, angle, length, shift):
    picture = hdr(*size)
    node = DirectionalBlur(angle=angle, length=length, shift=shift, edge=edge.name)
    found = run(node, {"image": picture})
    expected = along(picture, angle, length, shift, edge.scipy_map)
    # A position in 32 bits is known to 4e-6 pixels.
    assert np.abs(found - expected).max() <= 1e-5 * picture.max()


@pytest.mark.parametrize("length", [3, 9, 31])
def test_an_odd_length_along_a_row_is_a_box(run, hdr, length):
    picture = hdr(40, 7)
    expected = uniform_filter1d(picture.astype(np.float64), length, axis=1, mode="nearest")
    found = run(DirectionalBlur(length=float(length)), {"image": picture})
    assert np.abs(found - expected).max() <= 1e-5 * picture.max()


def test_angles_turn_against_the_clock_from_the_right(run):
    dot = np.zeros((21, 21, 4), np.float32)
    dot[10, 10] = 1.0
    up = run(DirectionalBlur(angle=90.0, length=8.0, shift=0.5), {"image": dot})[..., 0]
    assert up[2:10].sum() > 0.9 and up[11:].max() < 1e-5
    right = run(DirectionalBlur(length=8.0, shift=0.5), {"image": dot})[..., 0]
    np.testing.assert_allclose(right, up[::-1].T, atol=1e-5)


def test_no_length_changes_nothing():
    assert DirectionalBlur(length=0.0).identity() == "image"
