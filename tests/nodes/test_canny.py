"""Canny against OpenCV, and pixel by pixel against the algorithm in 64 bits with scipy."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.edge.canny import Canny
from scipy.ndimage import gaussian_filter, label, sobel


def light_of(tone: np.ndarray) -> np.ndarray:
    """An opaque gray picture that a display shows with this tone."""
    picture = np.ones((*tone.shape, 4))
    picture[..., :3] = np.where(tone <= 0.04045, tone / 12.92, ((tone + 0.055) / 1.055) ** 2.4)[..., None]
    return picture.astype(np.float32)


def canny(tone: np.ndarray, sigma: float, low: float, high: float, mode: str) -> np.ndarray:
    blurred = gaussian_filter(tone, sigma, mode=mode) if sigma else tone
    across, down = (sobel(blurred, axis, mode=mode) / 4.0 for axis in (1, 0))
    strength = np.pad(np.hypot(across, down), 1)
    height, width = tone.shape
    keep = np.zeros(tone.shape, bool)
    for y in range(height):
        for x in range(width):
            angle = np.degrees(np.arctan2(down[y, x], across[y, x])) % 180.0
            dx, dy = ((1, 0), (1, 1), (0, 1), (-1, 1))[int((angle + 22.5) // 45.0) % 4]
            here = strength[y + 1, x + 1]
            keep[y, x] = here > max(low, strength[y + 1 + dy, x + 1 + dx], strength[y + 1 - dy, x + 1 - dx])
    parts, _ = label(keep, np.ones((3, 3)))
    strong = np.unique(parts[keep & (strength[1:-1, 1:-1] > high)])
    return np.isin(parts, strong[strong > 0])


@pytest.mark.parametrize(
    ("sigma", "low", "high"),
    [(0.0, 0.05, 0.15), (1.0, 0.05, 0.15), (2.3, 0.05, 0.15), (2.3, 0.01, 0.03), (6.0, 5e-4, 2e-3)],
)
@pytest.mark.parametrize("size", [(61, 43), (12, 1), (1, 1)])
def test_it_equals_the_algorithm(run, edge, sigma, low, high, size):
    tone = gaussian_filter(np.random.default_rng(size[0]).random(size[::-1]), 0.8)
    found = run(Canny(sigma=sigma, low=low, high=high, edge=edge.name), {"image": light_of(tone)}, output="lines")
    np.testing.assert_array_equal(found[..., 0] > 0.5, canny(tone, sigma, low, high, edge.scipy))


def test_it_equals_opencv(run):
    """Of 8 bits, where neighbors are often alike and rounding of the tone decides: hence nearly all pixels."""
    tone = gaussian_filter(np.random.default_rng(8).random((80, 100)), 2.0)
    eight = np.round(255.0 * (tone - tone.min()) / np.ptp(tone)).astype(np.uint8)
    expected = cv2.Canny(eight, 60, 140, L2gradient=True) > 0
    found = run(Canny(sigma=0.0, low=60 / 1020, high=140 / 1020), {"image": light_of(eight / 255.0)}, output="lines")
    found = found[..., 0] > 0.5
    shared = (found & expected).sum()
    assert 2.0 * shared / (found.sum() + expected.sum()) >= 0.99
    assert expected.sum() > 300


def test_a_step_is_one_thin_line(run):
    for flip in (False, True):
        tone = np.zeros((16, 20))
        tone[:, 10:] = 0.6
        tone = tone.T.copy() if flip else tone
        found = run(Canny(), {"image": light_of(tone)}, output="lines")[..., 0]
        np.testing.assert_array_equal(found.sum(axis=0 if flip else 1), 1.0)


@pytest.mark.parametrize("reach", [0.0, 9.0, 30.0, 90.0])
def test_a_weak_edge_is_followed_as_far_as_it_reaches(run, reach):
    """A step that is strong at its left end only: the line goes on for as many pixels as asked for, or three more."""
    tone = np.zeros((12, 120))
    tone[6:, :20] = 0.16
    tone[6:, 20:] = 0.14
    found = run(Canny(sigma=0.0, reach=reach), {"image": light_of(tone)}, output="lines")[..., 0]
    length = int(found.sum()) - 20
    assert found[:, 20 : 20 + length].sum() == length
    assert reach <= length <= reach + 3


def test_lines_are_white_where_the_picture_is(run, hdr):
    picture = hdr(20, 15)
    found, lines = (run(Canny(), {"image": picture}, output=name) for name in ("out", "lines"))
    np.testing.assert_array_equal(found[..., :3], np.repeat(lines * picture[..., 3:], 3, axis=-1))
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])
