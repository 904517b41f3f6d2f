"""Filled holes against scipy's binary_fill_holes, at every level of a soft matte."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.matte.fill_holes import FillHoles
from scipy import ndimage


def make_blobs(seed: int, size: tuple[int, int] = (70, 52), sigma: float = 2.5) -> np.ndarray:
    noise = ndimage.gaussian_filter(np.random.default_rng(seed).random(size[::-1]), sigma)
    return (noise - noise.min()) / np.ptp(noise)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("threshold", [0.32, 0.4])
def test_hard_mattes_are_filled_as_by_scipy(run, seed, threshold):
    matte = make_blobs(seed) > threshold
    filled = run(FillHoles(), {"matte": matte})[..., 0]
    expected = ndimage.binary_fill_holes(matte)
    assert (expected != matte).any()
    np.testing.assert_array_equal(filled, expected)


@pytest.mark.parametrize("size", [(70, 52), (33, 64), (1, 9)])
def test_soft_mattes_are_filled_at_every_level(run, size):
    levels = np.round(15.0 * make_blobs(9, size, 1.5 if min(size) > 1 else 0.5)) / 15.0
    expected = np.zeros(levels.shape)
    for level in np.unique(levels)[1:]:
        expected = np.where(ndimage.binary_fill_holes(levels >= level), level, expected)
    # Beyond the picture everything is 0, so that the border is not higher than it was.
    expected = np.maximum(expected, levels)
    filled = run(FillHoles(turns=16), {"matte": levels})[..., 0]
    np.testing.assert_allclose(filled, expected, atol=1e-6)


def make_spiral() -> np.ndarray:
    """Walls with a way out that turns eleven times."""
    matte = np.ones((26, 26), bool)
    y, x, step = 0, 1, 24
    way = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    matte[y, x] = False
    for turn in range(12):
        for _ in range(step):
            y, x = y + way[turn % 4][0], x + way[turn % 4][1]
            matte[y, x] = False
        step -= 2 if turn % 2 and turn > 0 else 0
        step -= 1 if turn == 0 else 0
    return matte


def test_ways_that_turn_too_often_count_as_closed(run):
    spiral = make_spiral()
    assert not (ndimage.binary_fill_holes(spiral) != spiral).any()
    np.testing.assert_array_equal(run(FillHoles(turns=8), {"matte": spiral})[..., 0], spiral)
    assert (run(FillHoles(turns=1), {"matte": spiral})[..., 0] != spiral).any()
