"""Splines of `shape`: coverage against clipped polygons and soft edges against distances, both in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.document.reading import loads
from halation.document.writing import dumps
from halation.errors import GraphError
from halation.graph import Graph, Key, Keys, Output, Port, evaluate_at_frame
from halation.nodes import Kind, RotoShape, catalogue, join_points, make_ellipse, name_roto_shapes, split_points
from halation.nodes.input.shape import Shape
from halation.resources.sandbox import UNRESTRICTED
from polygons import Corners, measure_coverage
from soft_edges import measure_soft_coverage

WIDTH, HEIGHT = 80, 60
SIZE = (WIDTH, HEIGHT)
CORNERS = ((0.0, 0.0), (1.0, 0.2), (0.7, 1.0), (0.4, 0.5))
POINTS = Port("shape", "spline")


def trace(node: Shape, count: int = 400) -> Corners:
    """The outline as a polygon with many corners: points in the box, then turned about the center."""
    rows = np.array(split_points(node.spline))
    t = np.linspace(0.0, 1.0, count, endpoint=False)[:, None]
    parts = []
    for start, end in zip(rows, np.roll(rows, -1, 0), strict=True):
        a, b, c, d = start[:2], start[:2] + start[4:6], end[:2] + end[2:4], end[:2]
        parts.append((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d)
    inside = (np.vstack(parts) - 0.5) * node.size * HEIGHT
    angle = np.radians(node.rotation)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return inside @ turn + np.array(node.center) * SIZE


def mask_of(run, node: Shape, size=SIZE, **options) -> np.ndarray:
    return run(node, size=size, output="mask", **options)[..., 0]


CASES = {
    "the drop": Shape(shape="spline", size=(0.6, 0.7)),
    "turned": Shape(shape="spline", size=(0.7, 0.5), rotation=37.0, center=(0.47, 0.52)),
    "corners": Shape(shape="spline", spline=join_points(CORNERS), size=(0.9, 0.8), rotation=-12.0),
    "an ellipse": Shape(shape="spline", spline=make_ellipse(0.5, 0.5, 1.0, 1.0), size=(0.9, 0.5), rotation=20.0),
    "points outside of the box": Shape(shape="spline", spline=make_ellipse(1.0, 0.5, 1.5, 0.6), size=(0.5, 0.5)),
}


@pytest.mark.parametrize("node", CASES.values(), ids=CASES)
def test_coverage_equals_clipped_polygons(run, node):
    expected = measure_coverage(trace(node), SIZE)
    mask = mask_of(run, node)
    np.testing.assert_allclose(mask, expected, atol=2e-3)
    np.testing.assert_allclose(mask_of(run, node.with_values(invert=True)), 1.0 - expected, atol=2e-3)
    picture = run(node.with_values(color=(0.2, 0.4, 0.6, 0.8)), size=SIZE)
    np.testing.assert_allclose(picture, mask[..., None] * (0.2, 0.4, 0.6, 0.8), atol=1e-6)


def test_a_spline_of_an_ellipse_is_the_ellipse(run):
    """Four cubics are within 2.7e-4 of the radius of a circle (Goldapp 1991), here 7e-3 of a pixel."""
    values = {"size": (0.8, 0.6), "rotation": 25.0}
    spline = Shape(shape="spline", spline=make_ellipse(0.5, 0.5, 1.0, 1.0), **values)
    np.testing.assert_allclose(mask_of(run, spline), mask_of(run, Shape(shape="ellipse", **values)), atol=1e-2)


@pytest.mark.parametrize("name", ["the drop", "corners"])
def test_softness_is_the_mean_of_a_smooth_step_of_the_distance(run, name):
    node = CASES[name].with_values(softness=0.2)
    corners = trace(node, 60)
    expected = measure_soft_coverage(corners, np.full(len(corners), 0.2 * HEIGHT), SIZE)
    np.testing.assert_allclose(mask_of(run, node), expected, atol=2e-3)


def test_softness_can_differ_from_point_to_point(run):
    """The right side of a square that fills the left of the picture is soft by a fifth of its height."""
    soft = (0.0, 0.0, 0.0, 0.0, 0.2)
    rows = [(0.2, -1.0), (0.8, -1.0, *soft), (0.8, 2.0, *soft), (0.2, 2.0)]
    mask = mask_of(run, Shape(shape="spline", spline=join_points(rows), size=(1.0, 1.0)), size=(100, 100))
    t = np.clip(0.5 + (80.0 - np.arange(100) - 0.5) / 20.0, 0.0, 1.0)
    np.testing.assert_allclose(mask[50, 50:], (3.0 * t**2 - 2.0 * t**3)[50:], atol=5e-3)
    np.testing.assert_allclose(mask[50, :50], np.arange(50) >= 20, atol=1e-5)


def test_it_draws_as_roto_does(run):
    """A box of the height of a square picture is the whole picture, so that points mean the same."""
    points = make_ellipse(0.4, 0.55, 0.5, 0.7)
    roto = catalogue()["roto"](shapes=name_roto_shapes(a=RotoShape(points=points, feather=0.05)))
    masks = [
        run(node, size=(64, 64), output="mask")
        for node in (roto, Shape(shape="spline", spline=points, size=(1.0, 1.0), softness=0.05))
    ]
    np.testing.assert_allclose(*masks, atol=1e-6)


def test_a_proxy_is_the_picture_at_its_size(run):
    node = CASES["turned"].with_values(softness=0.1)
    np.testing.assert_array_equal(mask_of(run, node, size=(160, 120), scale=0.5), mask_of(run, node, size=(80, 60)))


def test_a_file_has_a_line_for_each_point():
    graph = Graph().add("shape", Shape(shape="spline", spline=join_points([*CORNERS, (0.1, 0.5, 0.0, -0.1, 0.0, 0.1)])))
    moved = join_points([(x + 0.1, y) for x, y in CORNERS] + [(0.2, 0.5, 0.0, -0.1, 0.0, 0.1)])
    graph = graph.animate(POINTS, Keys((Key(1, graph.value(POINTS)), Key(3, moved))))
    text = dumps(graph)
    assert loads(text, sandbox=UNRESTRICTED) == graph
    lines = [line.strip(" ,") for line in text.splitlines()]
    assert lines.count("[0.7, 1.0]") == 1 and "[0.1, 0.5, 0.0, -0.1, 0.0, 0.1]" in lines
    points = split_points(evaluate_at_frame(graph, 2).value(POINTS))
    np.testing.assert_allclose([point[0] for point in points], [0.05, 1.05, 0.75, 0.45, 0.15])


def linked(value: str) -> Graph:
    graph = Graph().add("shape", Shape(shape="spline")).add_output("mask", Output(Kind.FIELD))
    graph = graph.connect(Port("shape", "mask"), Port("outputs", "mask"))
    graph = graph.add("other", Shape())
    return graph.connect(Port("other", "mask"), Port("shape", value))


def test_a_picture_cannot_drive_what_places_a_spline(run):
    with pytest.raises(GraphError, match="a picture is linked to 'rotation'"):
        run(linked("rotation"), size=SIZE)
    graph = linked("rotation").set(Port("shape", "shape"), "ellipse")
    assert run(graph, size=SIZE).any()
