"""Points of a curve in its field: what is dragged lies under the pointer, and a click adds a point where it is.

The points are looked for on the screen, where they are drawn: nothing here knows how a field places them.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from drawn_shapes import Point
from halation.authoring.commands import ReplaceGraph
from halation.graph import Graph, Port
from still_editor import StillEditor, open_still_editor
from still_hand import Hand
from toy_nodes import Tint

FIELD = "field tint.curve"
CURVE = (0.0, 0.1, 0.4, 0.3, 0.7, 0.8, 1.0, 0.9)


@pytest.fixture(params=[1.0, 2.0], ids=["small", "large"])
def still(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[StillEditor]:
    scale = request.param
    with open_still_editor(tmp_path, size=(340.0 * scale, 900.0 * scale), scale=scale, screen=(3e3, 3e3)) as still:
        show_curve(still, CURVE)
        yield still


def show_curve(still: StillEditor, curve: tuple[float, ...]) -> None:
    still.editor.session.apply(ReplaceGraph("Start", Graph().add("tint", Tint(curve=curve))))
    still.select("tint")
    still.show("Inspector")


def read_curve(still: StillEditor) -> tuple[float, ...]:
    curve = still.editor.session.graph.value(Port("tint", "curve"))
    assert isinstance(curve, tuple)
    return tuple(float(number) for number in curve)


def find_plot(still: StillEditor) -> tuple[float, float, float, float]:
    """The plot of the curve, without what is below it."""
    widgets = [shape for shape in still.pane.widgets if shape.kind == "invisible_button"]
    left, top, right, bottom = still.places[FIELD]
    boxes = [(*shape.points[0], *shape.points[1]) for shape in widgets]
    (plot,) = [box for box in boxes if left <= box[0] and box[2] <= right and top <= box[1] and box[3] <= bottom]
    return plot


def find_disks(still: StillEditor) -> list[Point]:
    """Where the points of the curve are drawn, from left to right."""
    left, top, right, bottom = still.places[FIELD]
    disks = [shape.points[0] for shape in still.show("Inspector", 1) if shape.kind == "disk"]
    return sorted((x, y) for x, y in disks if left <= x <= right and top <= y <= bottom)


def is_near(one: Point, other: Point) -> bool:
    return max(abs(one[0] - other[0]), abs(one[1] - other[1])) <= 1.0


def test_a_dragged_point_lies_under_the_pointer_in_one_step(still: StillEditor) -> None:
    steps, disks = len(still.editor.session.history.steps), find_disks(still)
    assert len(disks) == 4
    for index, by in ((1, (11.0, 13.0)), (2, (-15.0, 21.0)), (1, (-9.0, -4.0))):
        start = find_disks(still)[index]
        end = start[0] + by[0], start[1] + by[1]
        Hand(still).drag(start, (start[0] + 4.0 * by[0], start[1]), end)
        now = find_disks(still)
        assert is_near(now[index], end)
        assert len(now) == 4 and is_near(now[0], disks[0]) and is_near(now[3], disks[3])
        still.calm("Inspector")
        steps += 1
        assert len(still.editor.session.history.steps) == steps


def test_a_tremor_moves_nothing(still: StillEditor) -> None:
    """The pointer has to leave by two pixels, four on an interface of twice the size."""
    scale, (x, y) = still.editor.store.current.ui_scale, find_disks(still)[1]
    Hand(still).drag((x, y), (x + 1.2 * scale, y))
    assert read_curve(still) == pytest.approx(CURVE)
    still.calm("Inspector")
    Hand(still).drag((x, y), (x + 3.0 * scale, y))
    assert is_near(find_disks(still)[1], (x + 3.0 * scale, y))


def test_a_click_adds_a_point_where_it_is(still: StillEditor) -> None:
    """Nearer than nine pixels to a point it takes that one."""
    scale, disks = still.editor.store.current.ui_scale, find_disks(still)
    there = (disks[1][0] + disks[2][0]) / 2.0 + 3.0, disks[2][1] + 5.0
    Hand(still).drag(there)
    assert len(now := find_disks(still)) == 5 and is_near(now[2], there)
    still.calm("Inspector")
    for reach, count in ((8.0, 5), (10.5, 6)):
        Hand(still).drag((disks[1][0] + reach * scale, disks[1][1]))
        assert len(find_disks(still)) == count
        still.calm("Inspector")


def test_points_leave_by_the_right_button_or_far_out_but_two_remain(still: StillEditor) -> None:
    scale, hand = still.editor.store.current.ui_scale, Hand(still)
    _, top, _, bottom = find_plot(still)
    x, y = find_disks(still)[1]
    hand.drag((x, y), (x, bottom + 35.0 * scale))
    assert len(find_disks(still)) == 4, "not far enough"
    still.calm("Inspector")
    still.editor.session.undo()
    for out in (top - 45.0 * scale, bottom + 45.0 * scale):
        start = find_disks(still)[1]
        hand.drag(start, (start[0], out))
        assert len(find_disks(still)) == 3
        still.calm("Inspector")
        still.editor.session.undo()
    ends = find_disks(still)[0], find_disks(still)[3]
    for end in ends:
        hand.drag(end, (end[0], bottom + 45.0 * scale))
        assert len(find_disks(still)) == 4, "the first and last point stay"
        still.calm("Inspector")
        still.editor.session.undo()
    for count in (3, 2, 2):
        hand.move(find_disks(still)[1])
        hand.press(1)
        hand.let_go(1)
        assert len(find_disks(still)) == count
        still.calm("Inspector")


def test_the_numbers_of_a_point_stay_in_the_plot(still: StillEditor) -> None:
    """A point that is pulled past its neighbor stops there; one that is pulled out stops at the border."""
    disks = find_disks(still)
    left, top, right, _ = still.places[FIELD]
    Hand(still).drag(disks[1], (right, top - 10.0))
    curve = read_curve(still)
    assert 0.69 < curve[2] < 0.7 and curve[3] == pytest.approx(1.0)
    assert curve[:2] + curve[4:] == pytest.approx(CURVE[:2] + CURVE[4:])
    assert left < find_disks(still)[0][0]


def test_the_grid_divides_the_plot_into_quarters(still: StillEditor) -> None:
    """From the first point's side to the last one's, and from 0 to 1: a curve's ends lie on its border."""
    show_curve(still, (0.0, 0.0, 1.0, 1.0))
    (left, bottom), (right, top) = find_disks(still)
    x0, y0, x1, y1 = still.places[FIELD]
    lines = [shape.points for shape in still.show("Inspector", 1) if shape.kind == "line"]
    inside = [(a, b) for a, b in lines if min(a[0], b[0]) >= x0 and max(a[0], b[0]) <= x1 and y0 <= a[1] <= y1]
    across = sorted(a[0] for a, b in inside if a[0] == b[0] and {a[1], b[1]} == {bottom, top})
    along = sorted(a[1] for a, b in inside if a[1] == b[1] and {a[0], b[0]} == {left, right})
    assert across == pytest.approx([left + (right - left) * part / 4 for part in range(5)], abs=0.5)
    assert along == pytest.approx([top + (bottom - top) * part / 4 for part in range(5)], abs=0.5)
