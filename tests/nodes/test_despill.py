"""Despill against the published limits in NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.matte.despill import Despill

LIMITS = {
    "average": lambda first, second: (first + second) / 2.0,
    "maximum": np.maximum,
    "minimum": np.minimum,
    "double": lambda first, second: (2.0 * first + second) / 3.0,
}


@pytest.mark.parametrize("screen", ["red", "green", "blue"])
@pytest.mark.parametrize("limit", LIMITS)
def test_the_screens_channel_stays_below_the_limit(run, screen, limit):
    picture = np.random.default_rng(2).random((9, 13, 4)).astype(np.float32)
    at = ("red", "green", "blue").index(screen)
    first, second = (picture[..., channel].astype(np.float64) for channel in range(3) if channel != at)
    expected = picture.astype(np.float64)
    expected[..., at] = np.minimum(expected[..., at], 0.9 * LIMITS[limit](first, second))
    cleaned = run(Despill(screen=screen, limit=limit, scale=0.9), {"image": picture})
    np.testing.assert_allclose(cleaned, expected, atol=1e-6)


def test_a_picture_without_spill_does_not_change(run):
    picture = np.full((3, 3, 4), (0.8, 0.5, 0.4, 1.0), np.float32)
    np.testing.assert_array_equal(run(Despill(), {"image": picture}), picture)


def test_the_light_that_is_removed_can_come_back(run):
    picture = np.full((3, 3, 4), (0.2, 0.8, 0.4, 1.0), np.float32)
    weights = np.array([0.2126, 0.7152, 0.0722])
    kept = run(Despill(keep_light=1.0), {"image": picture})[0, 0, :3]
    np.testing.assert_allclose(kept @ weights, np.array([0.2, 0.8, 0.4]) @ weights, atol=1e-6)


def test_a_half_covered_pixel_gets_half_of_the_color(run):
    picture = np.random.default_rng(3).random((5, 5, 4)).astype(np.float32)
    whole = run(Despill(keep_light=0.5), {"image": picture})
    np.testing.assert_allclose(run(Despill(keep_light=0.5), {"image": 0.5 * picture}), 0.5 * whole, atol=1e-6)
