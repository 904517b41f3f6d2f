"""Tools for mattes: soft edges against the error function, ranges and mattes against their formulas in NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.matte.edge_matte import EdgeMatte
from halation.nodes.matte.feather import Feather
from halation.nodes.matte.map_range import MapRange
from halation.nodes.matte.set_matte import SetMatte
from scipy.special import erf


def half_plane(width: int = 120, height: int = 8) -> np.ndarray:
    matte = np.zeros((height, width, 4), np.float32)
    matte[:, width // 2 :] = 1.0
    return matte


def gaussian_edge(sigma: float, width: int = 120) -> np.ndarray:
    """The hard edge in the middle after a Gaussian blur: the error function."""
    return 0.5 + 0.5 * erf((np.arange(width) + 0.5 - width / 2) / (sigma * np.sqrt(2.0)))


def test_a_feathered_edge_is_the_error_function(run):
    soft = gaussian_edge(5.0)
    both = run(Feather(width=20.0), {"image": half_plane()})[0, :, 0]
    np.testing.assert_allclose(both, soft, atol=2e-3)
    assert 0.95 < np.sum(np.diff(both)[49:70]) < 0.97


@pytest.mark.parametrize(("side", "formula"), [
    ("inside", lambda soft, hard: np.minimum(hard, np.maximum(2.0 * soft - 1.0, 0.0))),
    ("outside", lambda soft, hard: np.maximum(hard, np.minimum(2.0 * soft, 1.0))),
])  # fmt: skip
def test_a_feather_on_one_side_leaves_the_other_one_alone(run, side, formula):
    hard = half_plane()
    feathered = run(Feather(width=10.0, side=side), {"image": hard})[0, :, 0]
    np.testing.assert_allclose(feathered, formula(gaussian_edge(5.0), hard[0, :, 0]), atol=4e-3)
    untouched = slice(0, 60) if side == "inside" else slice(60, None)
    np.testing.assert_array_equal(feathered[untouched], hard[0, untouched, 0])


@pytest.mark.parametrize("side", ["both", "inside", "outside"])
def test_an_edge_matte_is_highest_on_the_edge(run, side):
    hard = half_plane()[..., 0]
    soft = gaussian_edge(16.0 / (2.0 * 1.617))
    part = {"both": np.ones(120), "inside": hard[0], "outside": 1.0 - hard[0]}[side]
    edge = run(EdgeMatte(width=16.0, side=side), {"matte": hard})[0, :, 0]
    np.testing.assert_allclose(edge, 4.0 * soft * (1.0 - soft) * part, atol=4e-3)
    if side == "both":
        assert np.count_nonzero(edge > 0.2) == 16


def test_ranges_are_mapped_linearly(run):
    field = np.linspace(-2.0, 4.0, 61, dtype=np.float32)[None]
    node = MapRange(from_low=0.5, from_high=2.5, to_low=10.0, to_high=-10.0)
    t = (field.astype(np.float64) - 0.5) / 2.0
    expected = 10.0 - 20.0 * np.clip(t, 0.0, 1.0)
    np.testing.assert_allclose(run(node, {"field": field})[..., 0], expected, atol=2e-5)
    free = run(node.with_values(limit=False), {"field": field})[..., 0]
    np.testing.assert_allclose(free, 10.0 - 20.0 * t, atol=2e-5)


def test_smooth_ranges_and_steps(run):
    field = np.linspace(-0.5, 1.5, 81, dtype=np.float32)[None]
    t = np.clip(field.astype(np.float64), 0.0, 1.0)
    smooth = run(MapRange(kind="smooth"), {"field": field})[..., 0]
    np.testing.assert_allclose(smooth, t * t * (3.0 - 2.0 * t), atol=1e-6)
    smoother = run(MapRange(kind="smoother"), {"field": field})[..., 0]
    np.testing.assert_allclose(smoother, 6.0 * t**5 - 15.0 * t**4 + 10.0 * t**3, atol=1e-6)
    steps = run(MapRange(kind="steps", steps=5.0), {"field": field})[..., 0]
    assert sorted(set(np.round(steps.ravel(), 6))) == [0.0, 0.25, 0.5, 0.75, 1.0]


def test_a_range_of_length_zero_is_a_threshold(run):
    field = np.array([[0.2, 0.49, 0.5, 0.9]], np.float32)
    threshold = run(MapRange(from_low=0.5, from_high=0.5), {"field": field})[0, :, 0]
    np.testing.assert_array_equal(threshold, (0.0, 0.0, 1.0, 1.0))


@pytest.mark.parametrize(("operation", "alpha"), [
    ("replace", lambda a, m: m), ("multiply", lambda a, m: a * m), ("maximum", np.maximum),
    ("subtract", lambda a, m: a * (1.0 - m)),
])  # fmt: skip
def test_a_new_matte_keeps_the_straight_color(run, operation, alpha):
    rng = np.random.default_rng(6)
    color, old, matte = rng.random((6, 9, 3)), 0.1 + 0.9 * rng.random((6, 9)), rng.random((6, 9))
    picture = np.dstack([color * old[..., None], old]).astype(np.float32)
    new = alpha(old, matte)
    given = {"image": picture, "matte": matte.astype(np.float32)}
    expected = np.dstack([color * new[..., None], new])
    np.testing.assert_allclose(run(SetMatte(operation=operation), given), expected, atol=1e-6)
    inverted = {"image": picture, "matte": (1.0 - matte).astype(np.float32)}
    np.testing.assert_allclose(run(SetMatte(operation=operation, invert=True), inverted), expected, atol=1e-6)


def test_straight_color_is_only_multiplied(run):
    picture = np.zeros((2, 2, 4), np.float32)
    picture[..., :3] = 0.8
    out = run(SetMatte(color="straight"), {"image": picture, "matte": np.full((2, 2), 0.5, np.float32)})
    np.testing.assert_allclose(out, np.full((2, 2, 4), (0.4, 0.4, 0.4, 0.5)), atol=1e-6)
