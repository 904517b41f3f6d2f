"""Shapes: coverage against polygons that are clipped in 64 bits, and against areas in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.input.shape import Shape
from polygons import Corners, measure_coverage

WIDTH, HEIGHT = 64, 48
SIZE = (WIDTH, HEIGHT)


def arc(center: tuple[float, float], radii: tuple[float, float], start: float, end: float, count: int = 500) -> Corners:
    turns = np.radians(np.linspace(start, end, count))
    return np.column_stack([center[0] + radii[0] * np.cos(turns), center[1] + radii[1] * np.sin(turns)])


def trace(node: Shape) -> Corners:
    """The outline of a shape as a polygon with many corners."""
    a, b = node.size[0] * HEIGHT / 2.0, node.size[1] * HEIGHT / 2.0
    if node.shape == "ellipse":
        outline = arc((0.0, 0.0), (a, b), 0.0, 360.0, 3000)
    elif node.shape == "line":
        outline = np.vstack([arc((a, 0.0), (b, b), -90.0, 90.0), arc((-a, 0.0), (b, b), 90.0, 270.0)])
    elif node.shape == "rectangle":
        r = node.roundness * min(a, b)
        quarters = ((a - r, b - r, 0.0), (r - a, b - r, 90.0), (r - a, r - b, 180.0), (a - r, r - b, 270.0))
        outline = np.vstack([arc((x, y), (r, r), turn, turn + 90.0) for x, y, turn in quarters])
    else:
        count = node.points * (2 if node.shape == "star" else 1)
        turns = 2.0 * np.pi * np.arange(count) / count
        radii = np.where((np.arange(count) % 2 == 1) & (node.shape == "star"), node.inner, 1.0)
        outline = np.column_stack([radii * a * np.sin(turns), -radii * b * np.cos(turns)])
    c, s = np.cos(np.radians(node.rotation)), np.sin(np.radians(node.rotation))
    middle = np.array([node.center[0] * WIDTH, node.center[1] * HEIGHT])
    return outline @ np.array([[c, s], [-s, c]]) + middle


CASES = {
    "rectangle": Shape(center=(0.52, 0.47), size=(0.71, 0.43)),
    "turned rectangle": Shape(size=(0.71, 0.43), rotation=27.0),
    "rounded rectangle": Shape(size=(0.9, 0.5), rotation=-13.0, roundness=0.6),
    "ellipse": Shape(shape="ellipse", size=(0.9, 0.5), rotation=33.0),
    "circle": Shape(shape="ellipse", center=(0.31, 0.6), size=(0.41, 0.41)),
    "line": Shape(shape="line", size=(0.8, 0.06), rotation=21.0),
    "triangle": Shape(shape="polygon", points=3, size=(0.8, 0.8), rotation=5.0),
    "octagon": Shape(shape="polygon", points=8, size=(0.9, 0.6)),
    "star": Shape(shape="star", points=5, inner=0.45, size=(0.9, 0.9), rotation=11.0),
}


@pytest.mark.parametrize("node", CASES.values(), ids=CASES)
def test_coverage_equals_clipped_polygons(run, node):
    mask = run(node, size=(WIDTH, HEIGHT), output="mask")[..., 0]
    np.testing.assert_allclose(mask, measure_coverage(trace(node), SIZE), atol=2e-3)
    picture = run(node.with_values(color=(0.2, 0.4, 0.6, 0.8)), size=(WIDTH, HEIGHT))
    np.testing.assert_allclose(picture, mask[..., None] * (0.2, 0.4, 0.6, 0.8), atol=1e-6)


def test_an_upright_rectangle_is_exact(run):
    mask = run(Shape(center=(0.5, 0.5), size=(0.5, 0.25)), size=(101, 99), output="mask")[..., 0]
    across = np.clip(0.5 * 99 / 2.0 - np.abs(np.arange(101) + 0.5 - 50.5) + 0.5, 0.0, 1.0)
    down = np.clip(0.25 * 99 / 2.0 - np.abs(np.arange(99) + 0.5 - 49.5) + 0.5, 0.0, 1.0)
    np.testing.assert_allclose(mask, np.outer(down, across), atol=2e-3)


@pytest.mark.parametrize(("node", "size"), [
    (Shape(shape="ellipse", size=(0.8, 0.6)), np.pi * 0.4 * 0.3),
    (Shape(shape="polygon", points=6, size=(0.8, 0.8)), 6 / 2 * np.sin(np.pi / 3) * 0.4**2),
    (Shape(shape="line", size=(0.6, 0.1), rotation=40.0), 0.6 * 0.1 + np.pi * 0.05**2),
    (Shape(size=(0.7, 0.5), rotation=40.0, roundness=1.0), 0.7 * 0.5 - (4.0 - np.pi) * 0.25**2),
])  # fmt: skip
def test_the_whole_area_is_that_of_geometry(run, node, size):
    mask = run(node, size=(160, 120), output="mask")[..., 0].astype(np.float64)
    np.testing.assert_allclose(mask.sum() / 120.0**2, size, rtol=2e-4)


def test_it_is_the_same_at_half_the_size(run):
    node = Shape(shape="star", size=(0.8, 0.8), softness=0.1)
    whole, half = (run(node, size=size, output="mask")[..., 0] for size in ((128, 96), (64, 48)))
    np.testing.assert_allclose(whole.reshape(48, 2, 64, 2).mean((1, 3)), half, atol=0.02)
    proxy = run(node, size=(128, 96), scale=0.5, output="mask")[..., 0]
    np.testing.assert_array_equal(proxy, half)


def test_a_soft_edge_is_half_way_on_the_edge(run):
    mask = run(Shape(size=(1.0, 0.5), softness=0.2), size=(100, 100), output="mask")[:, 50, 0]
    np.testing.assert_allclose(mask[[24, 25]].mean(), 0.5, atol=1e-3)
    assert mask[14] == 0.0 and mask[36] == 1.0 and (np.diff(mask[:50]) >= 0.0).all()


def test_the_opposite_and_a_shape_of_no_size(run):
    node = Shape(shape="ellipse")
    mask, opposite = (run(node.with_values(invert=on), size=(32, 24), output="mask")[..., 0] for on in (False, True))
    np.testing.assert_allclose(mask + opposite, 1.0, atol=1e-6)
    for shape in ("rectangle", "ellipse", "polygon", "star", "line"):
        nothing = run(Shape(shape=shape, size=(0.0, 0.0)), size=(32, 24), output="mask")
        assert np.isfinite(nothing).all() and nothing.max() < 0.02


def test_the_spline_of_a_new_shape_is_a_drop() -> None:
    """The same left and right, from the top to the bottom of its box, with a corner at the top and round elsewhere."""
    rows = np.array(Shape(shape="spline").spline).reshape(-1, 7)
    places, before, after = rows[:, :2], rows[:, 2:4], rows[:, 4:6]
    order = [0, 3, 2, 1]
    np.testing.assert_allclose(places[order], places * (-1.0, 1.0) + (1.0, 0.0))
    np.testing.assert_allclose(after[order], before * (-1.0, 1.0))
    assert places.min(axis=0).tolist() == [0.0, 0.0] and places.max(axis=0).tolist() == [1.0, 1.0]
    assert not rows[0, 2:].any() and places[0].tolist() == [0.5, 0.0]
    np.testing.assert_allclose(before[1:], -after[1:])
    assert (before[1:] @ (1.0, 1.0) != 0.0).all() and not rows[:, 6].any()
    assert (places[1, 1] - 0.5) * 2.0 < np.hypot(*before[2]) + 0.1 and places[1, 1] + after[1, 1] < 1.0
