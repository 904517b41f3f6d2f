"""Single points of a spline as values, with keys of their own."""

from __future__ import annotations

import json

import numpy as np
import pytest
from halation import document
from halation.document import dumps, loads
from halation.errors import DocumentError, GraphError
from halation.graph import Expression, Graph, Key, Keys, Port, evaluate_at_frame, problems, value_at
from halation.graph.scalars import scalar_fault
from halation.nodes import RotoShape, catalogue, join_points, name_roto_shapes, split_points
from halation.resources.sandbox import UNRESTRICTED
from scipy.interpolate import PchipInterpolator

POINTS = Port("roto", "shapes.box.points")
BOX = ((0.3, 0.3), (0.7, 0.3), (0.7, 0.7), (0.3, 0.7))
FRAMES = (1, 5, 12, 20)
PLACES = np.array([[0.3, 0.7], [0.2, 0.6], [0.1, 0.9], [0.35, 0.8]])


def full(*parts: float) -> tuple[float, ...]:
    return (*parts, *(0.0,) * (7 - len(parts)))


@pytest.fixture
def graph() -> Graph:
    """A square; all points move from frame 1 to 11, the last one by keys of its own."""
    graph = Graph().add("roto", catalogue()["roto"](shapes=name_roto_shapes(box=RotoShape(points=join_points(BOX)))))
    moved = join_points([(x + 0.1, y) for x, y in BOX])
    graph = graph.animate(POINTS, Keys((Key(1, join_points(BOX), "linear"), Key(11, moved))))
    own = Keys(tuple(Key(frame, full(*place)) for frame, place in zip(FRAMES, PLACES.tolist(), strict=True)))
    return graph.animate(Port("roto", "shapes.box.points.3"), own)


def places(graph: Graph, frame: float) -> np.ndarray:
    return np.array(split_points(value_at(graph, POINTS, frame)))[:, :2]


@pytest.mark.parametrize("frame", [1, 3, 5, 7.25, 11, 15, 20, 30])
def test_points_move_by_their_own_keys_and_the_others_together(graph: Graph, frame: float) -> None:
    along = np.clip((frame - 1) / 10, 0.0, 1.0)
    own = PchipInterpolator(FRAMES, PLACES)(min(frame, 20))
    if FRAMES[0] < frame < FRAMES[1] or FRAMES[-2] < frame < FRAMES[-1]:
        own = _hold_ends(frame)
    expected = [*np.array(BOX[:3]) + np.array((0.1 * along, 0.0)), own]
    np.testing.assert_allclose(places(graph, frame), expected, atol=1e-12)
    evaluated = evaluate_at_frame(graph, frame)
    np.testing.assert_allclose(np.array(split_points(evaluated.value(POINTS)))[:, :2], expected, atol=1e-12)


def _hold_ends(frame: float) -> np.ndarray:
    """A segment at the end: its slope is 0 at the outer key, at the inner one that of Fritsch and Butland."""
    first = 0 if frame < FRAMES[1] else 2
    inner = PchipInterpolator(FRAMES, PLACES).derivative()(FRAMES[1 if first == 0 else 2])
    width = FRAMES[first + 1] - FRAMES[first]
    u = (frame - FRAMES[first]) / width
    a, b = PLACES[first], PLACES[first + 1]
    rise, fall = (0.0 * inner, inner) if first == 0 else (inner, 0.0 * inner)
    cubic = [2 * u**3 - 3 * u**2 + 1, u**3 - 2 * u**2 + u, -2 * u**3 + 3 * u**2, u**3 - u**2]
    return cubic[0] * a + cubic[1] * width * rise + cubic[2] * b + cubic[3] * width * fall


def test_a_point_moves_where_the_others_have_no_keys(graph: Graph) -> None:
    graph = graph.animate(POINTS, None)
    np.testing.assert_allclose(places(graph, 5), [*BOX[:3], PLACES[1]])
    assert value_at(graph, Port("roto", "shapes.box.points.0"), 5) == full(*BOX[0])


def test_a_point_without_keys_of_its_own_is_read_where_those_of_all_put_it(graph: Graph) -> None:
    assert value_at(graph, Port("roto", "shapes.box.points.1"), 6)[:2] == pytest.approx((0.75, 0.3))


def test_a_file_has_a_line_for_each_key_of_a_point_and_loads_the_same(graph: Graph) -> None:
    text = dumps(graph)
    assert '{"frame": 5, "value": [0.2, 0.6]}' in text
    entry = json.loads(text)["animation"]["roto.shapes.box.points.3"]
    assert [key["value"] for key in entry["keys"]] == PLACES.tolist()
    loaded = loads(text, sandbox=UNRESTRICTED)
    assert loaded == graph and dumps(loaded) == text


def test_a_point_is_set_by_its_number(graph: Graph) -> None:
    still = graph.animate(POINTS, None)
    for path in ("roto.shapes.box.points.1", "roto.box.points.1"):
        moved = still.override(path, [0.8, 0.2])
        np.testing.assert_allclose(places(moved, 1), [BOX[0], (0.8, 0.2), BOX[2], PLACES[0]])
    fixed = graph.override("roto.box.points.3", [0.9, 0.9])
    assert POINTS in fixed.animation and not fixed.keyed_points


def test_setting_all_points_ends_the_keys_of_each(graph: Graph) -> None:
    assert graph.set(POINTS, join_points(BOX)).animation == {}


def test_a_point_that_does_not_exist_is_refused(graph: Graph) -> None:
    with pytest.raises(GraphError, match=r"'roto.shapes.box.points' has 4 points, counted from 0: there is no point 4"):
        graph.override("roto.box.points.4", [0.9, 0.9])
    with pytest.raises(GraphError, match=r"takes a list of x, y, then up to five numbers"):
        graph.override("roto.box.points.0", 0.5)
    with pytest.raises(GraphError, match="a point cannot follow an expression; set keys"):
        graph.animate(Port("roto", "shapes.box.points.0"), Expression("frame"))
    broken = dumps(graph).replace("points.3", "points.9")
    (problem, *_) = problems(loads(broken, sandbox=UNRESTRICTED))
    assert "has 4 points, counted from 0: there is no point 9" in problem.sentence


def test_a_handle_that_does_not_fit_a_point_is_refused(graph: Graph) -> None:
    text = dumps(graph).replace('{"frame": 5, "value": [0.2, 0.6]}', '{"frame": 5, "left": [1], "value": [0.2, 0.6]}')
    with pytest.raises(DocumentError, match="expected a list of 8 numbers, got 1"):
        loads(text, sandbox=UNRESTRICTED)


def test_keys_of_points_follow_a_renamed_node(graph: Graph) -> None:
    renamed = graph.rename("roto", "mask")
    assert set(renamed.keyed_points[Port("mask", "shapes.box.points")]) == {3}
    assert document.dumps(renamed.rename("mask", "roto")) == dumps(graph)


@pytest.mark.parametrize("points", [2, 3, 40])
@pytest.mark.parametrize("place", [0, 3, -1])
def test_many_numbers_are_judged_as_few(points: int, place: int) -> None:
    """As large as floats of 32 bits can be, and no larger."""
    value, most = catalogue()["shape"].values["spline"], float(np.finfo(np.float32).max)
    for number, fault in (
        (most, None),
        (-most, None),
        (1.0001 * most, "too large for 32 bits"),
        (-1.0001 * most, "too large for 32 bits"),
        (float("inf"), "is not a finite number"),
        (float("nan"), "is not a finite number"),
    ):
        numbers = [0.0] * 7 * points
        numbers[place] = number
        found = scalar_fault(value, tuple(numbers))
        assert found is None if fault is None else fault in (found or "")
