"""Narrow soft edges at tips, corners and beside hard points, against means of many places of each pixel in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import RotoShape, join_points, name_roto_shapes
from halation.nodes.input.roto import Roto
from selection import list_cases
from soft_edges import measure_soft_coverage

SIZE = WIDTH, HEIGHT = 48, 36

FEATHERS = {
    "3 pixels": [3.0],
    "8 pixels": [8.0],
    "a pixel": [1.0],
    "half a pixel": [0.5],
    "hard beside 3 pixels": [0.0, 3.0],
    "hard beside 10 pixels": [0.0, 10.0],
    "two hard ones beside 3 pixels": [0.0, 0.0, 3.0],
    "3 beside 9 pixels": [3.0, 9.0],
    "less than a pixel": [0.2, 0.6],
}
"""The feathers of points, in turn."""


def make_star(seed: int, tips: int, feathers: list[float]) -> np.ndarray:
    """The corners of an uneven star and their feathers, in pixels: its tips have angles of 20 to 60 degrees."""
    rng, count = np.random.default_rng(seed), 2 * tips
    turns = np.arange(count) * 2.0 * np.pi / count + rng.uniform(0.0, 7.0)
    radii = np.where(np.arange(count) % 2, 6.0, 15.0) * rng.uniform(0.85, 1.1, count)
    middle = np.array([0.5 * WIDTH, 0.5 * HEIGHT]) + rng.uniform(-1.0, 1.0, 2)
    corners = middle + radii[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return np.column_stack([corners, np.resize(feathers, count)])


def mask_of(run, corners: np.ndarray) -> np.ndarray:
    rows = [(x / WIDTH, y / HEIGHT, 0.0, 0.0, 0.0, 0.0, feather / HEIGHT) for x, y, feather in corners.tolist()]
    node = Roto(shapes=name_roto_shapes(star=RotoShape(points=join_points(rows))))
    return run(node, size=SIZE, output="mask")[..., 0]


@pytest.mark.parametrize("seed", list_cases([1], [2]))
@pytest.mark.parametrize("feathers", FEATHERS.values(), ids=FEATHERS)
def test_tips_and_corners_are_as_exact_as_hard_coverage(run, feathers, seed):
    corners = make_star(seed, 3 + seed, feathers)
    expected = measure_soft_coverage(corners[:, :2], corners[:, 2], SIZE)
    np.testing.assert_allclose(mask_of(run, corners), expected, atol=2e-3)


@pytest.mark.parametrize("feather", [1.0, 3.0])
def test_a_kink_between_two_sides_may_lie_anywhere_in_a_pixel(run, feather):
    """A bar as wide as its feather: its middle is a ridge, here upright and level at eighths of a pixel."""
    for shift in (0.0, 0.125, 0.3125, 0.5):
        box = [(10.0, 8.0), (10.0 + feather, 8.0), (10.0 + feather, 28.0), (10.0, 28.0)]
        corners = np.array([(x + shift, y + shift, feather) for x, y in box])
        expected = measure_soft_coverage(corners[:, :2], corners[:, 2], SIZE)
        np.testing.assert_allclose(mask_of(run, corners), expected, atol=2e-3)
