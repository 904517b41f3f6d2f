"""A drag becomes a stroke of the active node: which points it keeps, how it is named, and what one step of undo is."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.authoring.commands import ReplaceGraph
from halation.authoring.session import Session
from halation.editor.viewer import painting
from halation.editor.viewer.brush import LEAST_SIZE, MOST_SIZE, PaintBrush
from halation.editor.viewer.geometry import Sight
from halation.graph import Graph, Port
from halation.nodes import PAINT_STROKES, ItemSet, PaintTool, catalogue
from halation.resources.sandbox import UNRESTRICTED

PORT = Port("paint", "strokes")
SIGHT = Sight((100.0, 50.0), (800, 600), (400, 200), zoom=2.0)
"""A pixel of the picture is two of the screen: half a one of the screen is 1/1600 of the width, 1/800 of the height."""


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> Any:
    session = Session(catalogue(), sandbox=UNRESTRICTED)
    session.apply(ReplaceGraph("Start", Graph().add("paint", catalogue()["paint"]())))
    monkeypatch.setattr(painting, "find_item_list", lambda context, kind: PORT)
    return SimpleNamespace(
        viewer=SimpleNamespace(brush=PaintBrush()), session=session, items={},
        log=SimpleNamespace(attempt=lambda act: act()), interface=SimpleNamespace(dragging=False),
    )  # fmt: skip


def draw(context: Any, *places: tuple[float, float]) -> None:
    painting.begin_stroke(context, places[0])
    for place in places[1:]:
        painting.extend_stroke(context, SIGHT, place)


def read(context: Any) -> dict[str, list[tuple[float, ...]]]:
    """The points of each stroke."""
    strokes = context.session.graph.value(PORT)
    numbers = {name: PAINT_STROKES.settings(item)["points"] for name, item in strokes.items()}
    return {name: [tuple(row[at : at + 3]) for at in range(0, len(row), 3)] for name, row in numbers.items()}


def test_points_are_half_a_pixel_of_the_screen_apart(context: Any) -> None:
    near, far = 0.49 / 800, 0.51 / 800
    draw(
        context,
        (0.5, 0.5),
        (0.5 + near, 0.5),
        (0.5 + far, 0.5),
        (0.5 + far, 0.5 + 0.24 / 200),
        (0.5 + far, 0.5 + 0.26 / 200),
    )
    assert [row[:2] for row in context.viewer.brush.rows] == [
        pytest.approx(at, abs=1e-6) for at in ((0.5, 0.5), (0.5 + far, 0.5), (0.5 + far, 0.5 + 0.26 / 200))
    ]
    assert context.interface.dragging


@pytest.mark.parametrize(("off", "count"), [(0.24, 2), (0.26, 3), (-0.24, 2), (-0.26, 3)])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_finished_stroke_keeps_what_is_seen(context: Any, axis: int, off: float, count: int) -> None:
    """A point that is a quarter of a pixel of the picture, half a one of the screen, off a straight line is needed."""
    bend = off / (400, 200)[axis]
    places = ((0.25, 0.5), (0.5, 0.5 + bend), (0.75, 0.5)) if axis else ((0.5, 0.25), (0.5 + bend, 0.5), (0.5, 0.75))
    draw(context, *places)
    painting.finish_stroke(context, SIGHT)
    (rows,) = read(context).values()
    assert len(rows) == count and rows[0] == (*places[0], 1.0) and rows[-1] == (*places[2], 1.0)


def test_a_stroke_is_one_step_and_ends(context: Any) -> None:
    steps = len(context.session.history.steps)
    draw(context, (0.1, 0.1), (0.2, 0.3), (0.4, 0.1))
    assert context.viewer.brush.stroke == "stroke_1" == context.items[str(PORT)]
    painting.finish_stroke(context, SIGHT)
    assert len(context.session.history.steps) == steps + 1 and context.viewer.brush.stroke == ""
    assert context.viewer.brush.rows == []
    painting.finish_stroke(context, SIGHT)
    painting.extend_stroke(context, SIGHT, (0.9, 0.9))
    assert len(read(context)["stroke_1"]) == 3, "no stroke is drawn"
    draw(context, (0.5, 0.5), (0.6, 0.5))
    painting.finish_stroke(context, SIGHT)
    assert [*read(context)] == ["stroke_1", "stroke_2"] and len(context.session.history.steps) == steps + 2
    painting.cancel_stroke(context)
    assert (context.viewer.brush.stroke, context.viewer.brush.rows) == ("", [])


def test_new_strokes_come_after_all_others(context: Any) -> None:
    for old, new in (("stroke_9", "stroke_10"), ("zebra", "zebra_1")):
        draw(context, (0.5, 0.5))
        painting.finish_stroke(context, SIGHT)
        strokes = context.session.graph.value(PORT)
        (item,) = (strokes[name] for name in [*strokes][-1:])
        context.session.apply(
            ReplaceGraph("Named", Graph().add("paint", catalogue()["paint"](strokes=ItemSet({old: item}))))  # pyright: ignore
        )
        draw(context, (0.25, 0.5))
        painting.finish_stroke(context, SIGHT)
        assert [*read(context)] == [old, new]


def test_a_clone_needs_a_place_first(context: Any) -> None:
    brush = context.viewer.brush
    brush.tool = PaintTool.CLONE
    painting.begin_stroke(context, (0.5, 0.5))
    assert not brush.stroke and not read(context)
    brush.copy_from((0.25, 0.5))
    painting.begin_stroke(context, (0.5, 0.5))
    assert brush.stroke and read(context)


@pytest.mark.parametrize(("zoom", "density"), [(2.0, 1.0), (0.5, 1.0), (2.0, 2.0)])
def test_the_radius_is_half_the_size_in_heights_of_the_picture(context: Any, zoom: float, density: float) -> None:
    context.viewer.brush.size = 0.25
    sight = Sight((0.0, 0.0), (800, 600), (400, 200), zoom=zoom, density=density)
    assert painting.measure_brush(context, sight) == pytest.approx(25.0 * zoom / density)


def test_the_brush_is_scaled_within_its_range_and_switched(context: Any) -> None:
    painting.scale_brush(context, 2.0)
    assert context.viewer.brush.size == pytest.approx(0.12)
    for factor, most in ((1e9, MOST_SIZE), (1e-9, LEAST_SIZE)):
        painting.scale_brush(context, factor)
        assert context.viewer.brush.size == most
    assert painting.can_paint(context) and painting.paints(context)
    painting.toggle_brush(context)
    assert not painting.paints(context)
    painting.toggle_brush(context)
    assert painting.paints(context)
