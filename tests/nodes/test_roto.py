"""Rotoscopes: coverage against clipped polygons, soft edges against distances, both in 64 bits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from devices import form_to_test
from halation.document.reading import loads
from halation.document.writing import dumps
from halation.errors import HalationError
from halation.graph import Control, Graph, Key, Keys, Output, Port, evaluate_at_frame, problems
from halation.graph.rules import BAD_CONTROL
from halation.nodes import (
    ROTO_SHAPES,
    Kind,
    RotoShape,
    insert_point,
    join_points,
    list_curves,
    list_rows,
    make_ellipse,
    name_roto_shapes,
    read_rows,
    split_points,
)
from halation.nodes.input.roto import Roto
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace as change
from polygons import measure_coverage, measure_distance
from selection import list_cases
from soft_edges import measure_soft_coverage

WIDTH, HEIGHT = 101, 75
SIZE = (WIDTH, HEIGHT)
SQUARE = ((0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75))


def trace(outline: RotoShape, count: int = 300) -> np.ndarray:
    """The corners of a polygon with many corners that is an outline in pixels, moved as it says."""
    t = np.linspace(0.0, 1.0, count, endpoint=False)[:, None]
    parts = []
    for curve in list_curves(split_points(outline.points)):
        a, b, c, d = map(np.array, curve)
        parts.append((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d)
    corners, pivot = np.vstack(parts) * SIZE, np.array(outline.pivot) * SIZE
    angle = np.radians(outline.rotation)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return ((corners - pivot) * outline.scale) @ turn + pivot + np.array(outline.position) * SIZE


def wave(count: int, lobes: int) -> tuple[float, ...]:
    """A closed wave of smooth points."""
    turns = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    radii, arm = 0.32 + 0.08 * np.cos(lobes * turns), 0.6 / count
    x, y = np.cos(turns), np.sin(turns)
    rows = np.column_stack([0.5 + radii * x, 0.5 + radii * y, arm * y, -arm * x, -arm * y, arm * x])
    return join_points(map(tuple, rows.tolist()))


CASES = {
    "ellipse": RotoShape(),
    "corners": RotoShape(points=join_points([(0.1, 0.2), (0.9, 0.15), (0.7, 0.9), (0.3, 0.6)])),
    "a diagonal through corners of tiles": RotoShape(points=join_points([(0.0, 0.0), (1.0, 1.0), (0.0, 1.0)])),
    "an upright square": RotoShape(points=join_points(SQUARE)),
    "counterclockwise": RotoShape(points=join_points(SQUARE[::-1])),
    "larger than the picture": RotoShape(points=make_ellipse(0.1, 0.5, 1.4, 0.8)),
    "from the left": RotoShape(points=join_points([(-0.5, 0.2), (0.5, 0.5), (-0.5, 0.8)])),
    "a sliver": RotoShape(points=join_points([(0.1, 0.5), (0.9, 0.504), (0.9, 0.507)])),
    "a wave of 40 points": RotoShape(points=wave(40, 5)),
    "a wave of 500 points": RotoShape(points=wave(500, 31)),
    "moved": RotoShape(position=(0.1, -0.2), rotation=33.0, scale=(1.4, 0.7), pivot=(0.3, 0.6)),
}


def mask_of(run, *outlines: RotoShape, size=SIZE, **options) -> np.ndarray:
    shapes = name_roto_shapes(**{f"shape_{number}": outline for number, outline in enumerate(outlines, 1)})
    return run(Roto(shapes=shapes), size=size, output="mask", **options)[..., 0]


@pytest.mark.parametrize("outline", CASES.values(), ids=CASES)
def test_coverage_equals_clipped_polygons(run, outline):
    np.testing.assert_allclose(mask_of(run, outline), measure_coverage(trace(outline), SIZE), atol=2e-3)


@pytest.mark.parametrize("name", ["ellipse", "corners", "a wave of 40 points"])
def test_a_wide_soft_edge_is_a_smooth_step_of_the_distance(run, name):
    outline = CASES[name]
    mask = mask_of(run, RotoShape(points=outline.points, feather=0.6))
    t = np.clip(0.5 + measure_distance(trace(outline), SIZE) / (0.6 * HEIGHT), 0.0, 1.0)
    np.testing.assert_allclose(mask, 3.0 * t**2 - 2.0 * t**3, atol=5e-3)


@pytest.mark.parametrize("feather", [0.02, 0.1])
@pytest.mark.parametrize("name", ["ellipse", "corners", "a wave of 40 points"])
def test_a_narrow_soft_edge_is_the_mean_of_a_smooth_step(run, name, feather):
    """Edges of 1.5 and 7.5 pixels change within a pixel, most of all at corners."""
    outline = CASES[name]
    corners = trace(outline, 60)
    expected = measure_soft_coverage(corners, np.full(len(corners), feather * HEIGHT), SIZE)
    mask = mask_of(run, RotoShape(points=outline.points, feather=feather))
    np.testing.assert_allclose(mask, expected, atol=2e-3)


@pytest.mark.parametrize(("feather", "each"), list_cases([(0.2, 0.0), (0.0, 0.2)], [(0.1, 0.1)]))
def test_few_chords_of_a_soft_edge_are_as_exact_as_hard_coverage(run, feather, each):
    """Handles across the way: most of each curve is passed in its middle, and its ends are sharp bends."""
    rows = np.reshape(wave(60, 7), (60, 7))
    rows[:, 6] = each
    points = join_points(map(tuple, rows.tolist()))
    mask = mask_of(run, RotoShape(points=points, feather=feather))
    corners = trace(RotoShape(points=points), 100)
    expected = measure_soft_coverage(corners, np.full(len(corners), 0.2 * HEIGHT), SIZE, samples=8)
    np.testing.assert_allclose(mask, expected, atol=2e-3)


def test_a_feather_can_differ_from_point_to_point(run):
    rows = [(0.2, -1.0), (0.8, -1.0, 0.0, 0.0, 0.0, 0.0, 0.2), (0.8, 2.0, 0.0, 0.0, 0.0, 0.0, 0.2), (0.2, 2.0)]
    mask = mask_of(run, RotoShape(points=join_points(rows)), size=(100, 100))
    t = np.clip(0.5 + (80.0 - np.arange(100) - 0.5) / 20.0, 0.0, 1.0)
    np.testing.assert_allclose(mask[50, 50:], (3.0 * t**2 - 2.0 * t**3)[50:], atol=5e-3)
    np.testing.assert_allclose(mask[50, :50], np.arange(50) >= 20, atol=1e-5)


@pytest.mark.parametrize(("narrow", "wide"), list_cases([(0.05, 0.6)], [(0.1, 0.4), (0.2, 0.21)]))
def test_feathers_that_differ_have_no_steps(run, narrow, wide):
    """The point of the outline counts whose distance is the least part of its feather."""
    rows = np.reshape(wave(12, 3), (12, 7))
    rows[:, 6] = np.where(np.arange(12) % 2, wide, narrow)
    points, t = join_points(map(tuple, rows.tolist())), np.linspace(0.0, 1.0, 60, endpoint=False)
    widths = HEIGHT * (rows[:, 6:] + (np.roll(rows[:, 6:], -1, axis=0) - rows[:, 6:]) * t).ravel()
    expected = measure_soft_coverage(trace(RotoShape(points=points), 60), widths, SIZE)
    np.testing.assert_allclose(mask_of(run, RotoShape(points=points)), expected, atol=2e-3)


def test_shapes_are_combined_in_the_order_of_their_names(run):
    first, second, third = (
        RotoShape(points=make_ellipse(x, 0.5, 0.5, 0.6), feather=feather, opacity=opacity)
        for x, feather, opacity in ((0.4, 0.0, 0.9), (0.6, 0.1, 0.8), (0.5, 0.0, 0.5))
    )
    a, b, c = (mask_of(run, outline) for outline in (first, second, third))
    b_whole, c_whole = b / 0.8, c / 0.5

    def change(outline: RotoShape, **fields: object) -> RotoShape:
        return RotoShape(**{**{name: getattr(outline, name) for name in ROTO_SHAPES.kinds[0].fields}, **fields})

    subtracted = mask_of(run, first, change(second, mode="subtract"), third)
    np.testing.assert_allclose(subtracted, a * (1 - b) + c * (1 - a * (1 - b)), atol=1e-5)
    kept = mask_of(run, first, change(second, mode="intersect"))
    np.testing.assert_allclose(kept, a * (1 - 0.8 * (1 - b_whole)), atol=1e-5)
    inverted = mask_of(run, first, change(third, mode="subtract", invert=True))
    np.testing.assert_allclose(inverted, a * (1 - 0.5 * (1 - c_whole)), atol=1e-5)


def test_shapes_change_the_mask_that_is_linked(run):
    matte = np.linspace(0.0, 1.0, WIDTH * HEIGHT, dtype=np.float32).reshape(HEIGHT, WIDTH)
    node = Roto(shapes=name_roto_shapes(a=RotoShape(mode="subtract")))
    mask = run(node, {"matte": matte}, output="mask")[..., 0]
    np.testing.assert_allclose(mask, matte * (1.0 - mask_of(run, RotoShape())), atol=1e-5)
    picture = run(node.with_values(color=(0.2, 0.4, 0.6, 0.8)), {"matte": matte})
    np.testing.assert_allclose(picture, mask[..., None] * (0.2, 0.4, 0.6, 0.8), atol=1e-6)


def test_no_shapes_are_no_mask(run):
    assert not mask_of(run).any() and not mask_of(run, RotoShape(on=False)).any()
    assert not mask_of(run, RotoShape(points=(0.5,) * 2 + (0.0,) * 5)).any()


def test_a_proxy_is_the_picture_at_its_size(run):
    outline = RotoShape(points=wave(40, 5), feather=0.05)
    np.testing.assert_array_equal(
        mask_of(run, outline, size=(128, 96), scale=0.5), mask_of(run, outline, size=(64, 48))
    )


def test_a_shape_lasts_from_its_first_to_its_last_frame():
    outline = RotoShape(lifetime="range", first=3, last=5)
    assert [frame for frame in range(1, 8) if outline.is_active(frame)] == [3, 4, 5]


def test_a_file_has_a_line_for_each_point():
    node = Roto(shapes=name_roto_shapes(cut=RotoShape(points=join_points([*SQUARE, (0.1, 0.5, 0.0, -0.1, 0.0, 0.1)]))))
    graph = Graph().add("roto", node)
    port = Port("roto", "shapes.cut.points")
    moved = join_points([(x + 0.1, y) for x, y in SQUARE] + [(0.2, 0.5, 0.0, -0.1, 0.0, 0.1)])
    graph = graph.animate(port, Keys((Key(1, graph.value(port)), Key(3, moved))))
    text = dumps(graph)
    assert loads(text, sandbox=UNRESTRICTED) == graph
    lines = [line.strip(" ,") for line in text.splitlines()]
    assert lines.count("[0.25, 0.75]") == 2 and "[0.1, 0.5, 0.0, -0.1, 0.0, 0.1]" in lines
    points = split_points(evaluate_at_frame(graph, 2).value(port))
    np.testing.assert_allclose([point[0] for point in points], [0.3, 0.8, 0.8, 0.3, 0.15])


@pytest.mark.parametrize("rows", [[], [[0.5]], [[0.0] * 8], [["a", "b"]], [0.5, 0.5], [[0.1, 0.2], 3.0], "round"])
def test_what_is_no_spline_is_refused_with_a_sentence(rows):
    assert read_rows(rows) is None
    text = dumps(Graph().add("roto", Roto())).replace('"kind": "spline"', f'"kind": "spline", "points": {rows!r}')
    with pytest.raises(HalationError, match="points: expected a list of points, each a list of x, y"):
        loads(text.replace("'", '"'), sandbox=UNRESTRICTED)


def test_rows_leave_out_zeros_at_their_end():
    rows = ((0.1, 0.2), (0.3, 0.4, 0.0, 0.5), (0.5, 0.6, 0.0, 0.0, 0.0, 0.0, 0.7))
    numbers = join_points(rows)
    assert list_rows(numbers) == rows and read_rows(list(rows)) == numbers == read_rows(numbers)


@pytest.mark.parametrize("index", [0, 2, 3])
def test_a_point_is_inserted_without_a_change_of_the_outline(run, index):
    outline = RotoShape()
    points = insert_point(split_points(outline.points), index, 0.3)
    assert len(points) == 5
    np.testing.assert_allclose(mask_of(run, RotoShape(points=join_points(points))), mask_of(run, outline), atol=2e-3)


def test_a_control_can_turn_a_field_of_a_shape():
    graph = Graph().add("roto", Roto()).add_output("mask", Output(Kind.FIELD))
    graph = graph.connect(Port("roto", "mask"), Port("outputs", "mask"))
    graph = replace(graph, controls={"edge": Control(Port("roto", "shapes.shape_1.feather"))})
    assert not [problem for problem in problems(graph) if problem.rule is BAD_CONTROL]
    graph = replace(graph, controls={"edge": Control(Port("roto", "shapes.shape_2.feather"))})
    assert [problem.sentence for problem in problems(graph) if problem.rule is BAD_CONTROL]


def test_a_large_picture_is_the_same_in_tiles():
    shapes = name_roto_shapes(
        a=RotoShape(points=wave(40, 5), feather=0.1), b=RotoShape(points=join_points(SQUARE), mode="subtract")
    )
    graph = Graph().add("roto", Roto(shapes=shapes)).add_output("mask", Output(Kind.FIELD))
    graph = graph.connect(Port("roto", "mask"), Port("outputs", "mask"))
    masks = []
    for side in (16384, 150):
        device = open_device(form_to_test(), sandbox=UNRESTRICTED)
        engine = Renderer(device.with_target(change(device.target, max_size=side)), budget=0, sandbox=UNRESTRICTED)
        masks.append(engine.render(graph, RenderRequest({}, size=(301, 203), precision="float"))["mask"])
        engine.close()
    np.testing.assert_array_equal(*masks)


def pixels_of(corners: list[tuple[float, float]]) -> RotoShape:
    """A shape of straight sides, from its corners in pixels."""
    return RotoShape(points=join_points([(x / WIDTH, y / HEIGHT) for x, y in corners]))


def make_star(inner: float, count: int = 10) -> np.ndarray:
    turns = np.arange(count) * 2.0 * np.pi / count
    radii = np.where(np.arange(count) % 2, inner, 30.0)
    return np.column_stack([50.3 + radii * np.sin(turns), 37.6 - radii * np.cos(turns)])


def make_box(left: float, top: float, right: float, bottom: float) -> np.ndarray:
    return np.array([(left, top), (right, top), (right, bottom), (left, bottom)])


PENTAGRAM = make_star(30.0 * np.sin(np.pi / 10) / np.sin(3 * np.pi / 10))
"""All ten corners of the star that five lines make, each from a tip to the next but one."""

CROSSED = {
    "a star in one stroke": (PENTAGRAM[::2][[0, 2, 4, 1, 3]], [PENTAGRAM]),
    "backward": (PENTAGRAM[::2][[3, 1, 4, 2, 0]], [PENTAGRAM]),
    "an eight": (
        np.array([(10.2, 10.7), (60.2, 60.7), (60.2, 10.7), (10.2, 60.7)]),
        [np.array([(10.2, 10.7), (35.2, 35.7), (10.2, 60.7)]), np.array([(60.2, 60.7), (35.2, 35.7), (60.2, 10.7)])],
    ),
    "twice around": (
        np.array(
            [
                (10.5, 10.5),
                (50.5, 10.5),
                (50.5, 60.5),
                (30.5, 60.5),
                (30.5, 25.5),
                (70.5, 25.5),
                (70.5, 40.5),
                (10.5, 40.5),
            ]
        ),
        [make_box(10.5, 10.5, 30.5, 40.5), make_box(30.5, 10.5, 50.5, 60.5), make_box(50.5, 25.5, 70.5, 40.5)],
    ),
}
"""The corners of a line that crosses itself, and the simple polygons that it covers."""


@pytest.mark.parametrize("name", CROSSED)
def test_a_line_that_crosses_itself_is_solid(run, name):
    corners, solid = CROSSED[name]
    expected = sum(measure_coverage(polygon, SIZE) for polygon in solid)
    np.testing.assert_allclose(mask_of(run, pixels_of(corners.tolist())), expected, atol=2e-3)


def test_a_feather_knows_no_edges_inside_of_a_star(run):
    corners, (solid,) = CROSSED["a star in one stroke"]
    mask = mask_of(run, change(pixels_of(corners.tolist()), feather=12.0 / HEIGHT))
    expected = measure_soft_coverage(solid, np.full(len(solid), 12.0), SIZE)
    np.testing.assert_allclose(mask, expected, atol=2e-3)
