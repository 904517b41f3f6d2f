"""How links, frames, comments, the grid and notes are drawn on the canvas."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from drawn_links import sample_wire
from drawn_shapes import DrawnShapes
from halation.editor.canvas import paint_decor
from halation.editor.canvas.brush import DrawContext
from halation.editor.canvas.scene import ElementBox
from msgspec.structs import replace

BOX: Any = ElementBox("comment", "comment", 40.0, 80.0, 200.0, 120.0)  # pyright: ignore


def drawn(brush: DrawContext) -> DrawnShapes:
    shapes: Any = brush.draw
    return shapes


def test_links_are_drawn_where_they_are_hit(make_brush, scene) -> None:
    for wire in scene.wires:
        brush = make_brush()
        paint_decor.paint_wire(brush, wire, lit=False, faded=False)
        rim, line = drawn(brush).shapes
        x, y = wire.curves[0][0::2], wire.curves[0][1::2]
        assert rim.points == line.points == tuple(brush.to.to_screen(*at) for at in zip(x, y, strict=True))
        assert rim.lengths[0] - line.lengths[0] == 2.5 and line.color == brush.ink.kinds[wire.kind]


def test_dashes_lie_on_their_link_and_cover_three_fifths_of_it(make_brush, scene) -> None:
    for wire in scene.wires:
        brush = make_brush()
        paint_decor.paint_wire(brush, replace(wire, muted=True), lit=False, faded=False)
        dashes = [shape.points for shape in drawn(brush).list_kinds("line")]
        curve = sample_wire(wire) * brush.to.scale + (brush.to.x, brush.to.y)
        steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
        ends = np.array(dashes).reshape(-1, 2)
        away = np.abs(curve[None] - ends[:, None]).sum(axis=2).min(axis=1)
        assert away.max() <= 2.0 * steps.max() and dashes[0][0] == pytest.approx(tuple(curve[0]))
        covered = sum(math.dist(start, end) for start, end in dashes)
        assert covered == pytest.approx(0.6 * steps.sum(), rel=0.05)
        assert 9.0 < steps.sum() / len(dashes) < 31.0  # a dash and a hole; control points make links seem longer


@pytest.mark.parametrize(("zoom", "step"), [(1.0, 32.0), (0.7, 32.0), (0.5, 128.0), (0.2, 128.0), (0.1, 512.0)])
def test_a_grid_has_fine_lines_where_they_are_22_pixels_apart(make_brush, zoom: float, step: float) -> None:
    brush = make_brush(zoom)
    paint_decor.paint_grid(brush, (100.0, 50.0, 900.0, 650.0))
    shapes = drawn(brush).shapes
    assert shapes[0].points == ((100.0, 50.0), (900.0, 650.0)) and shapes[0].color == brush.ink.canvas
    for axis, low, high in ((0, 100.0, 900.0), (1, 50.0, 650.0)):
        lines = [shape for shape in shapes[1:] if shape.points[0][axis] == shape.points[1][axis]]
        start = (brush.to.x, brush.to.y)[axis]
        places = [(start + step * zoom * index, index) for index in range(-50, 100)]
        expected = [(round(at) + 0.5, index) for at, index in places if low <= at <= high]
        assert [shape.points[0][axis] for shape in lines] == [at for at, _ in expected]
        strong = [brush.ink.grid if index % 4 else brush.ink.grid_strong for _, index in expected]
        assert [shape.color for shape in lines] == strong
        ends = {(shape.points[0][1 - axis], shape.points[1][1 - axis]) for shape in lines}
        assert ends == {((50.0, 650.0), (100.0, 900.0))[axis]}


@pytest.mark.parametrize("zoom", [0.1, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("words", ["short", "words " * 30])
def test_a_comment_is_as_large_as_it_can_be_read_where_it_has_room(make_brush, zoom: float, words: str) -> None:
    brush = make_brush(zoom)
    paint_decor.paint_comment(brush, BOX, words, False)
    clip, (text,) = drawn(brush).list_kinds("clip")[0], drawn(brush).list_kinds("text")
    assert clip.points == brush.project_corners(BOX.rect)
    size, width = text.lengths
    assert width == pytest.approx((BOX.w - 20.0) * zoom)
    least, readable, room = 13.5 * zoom, 11.0, (BOX.h - 16.0) * zoom
    assert size >= least - 1e-9
    rows = -(-0.5 * size * len(words) // width)
    assert size in (pytest.approx(least), pytest.approx(readable)) or rows * size <= room
    if -(-0.5 * readable * len(words) // width) * readable <= room:
        assert size == pytest.approx(max(least, readable))
    if size > least + 1.0 and size < readable - 1.0:
        assert -(-0.5 * (size + 1.0) * len(words) // width) * (size + 1.0) > room  # one more has no room
    assert text.points == (brush.to.to_screen(BOX.x + 12.0, BOX.y + 8.0),)


def test_an_empty_comment_says_how_it_is_written(make_brush) -> None:
    brush = make_brush()
    paint_decor.paint_comment(brush, BOX, "", False)
    (text,) = drawn(brush).list_kinds("text")
    assert text.text and text.color == brush.ink.faint and not drawn(brush).list_kinds("rect")


def test_a_dot_is_round_with_its_color_inside(make_brush) -> None:
    brush = make_brush(2.0)
    paint_decor.paint_dot(brush, replace(BOX, w=10.0, h=10.0), 7, True)
    chosen, rim, inside = drawn(brush).shapes
    middle = brush.to.to_screen(45.0, 85.0)
    assert [shape.points for shape in (chosen, rim, inside)] == [(middle,)] * 3
    assert (rim.lengths, inside.lengths, inside.color) == ((10.0,), (7.5,), 7)
    assert chosen.lengths == (10.0 + 2.5 * brush.line,) and chosen.color == brush.ink.accent


def test_a_note_lies_beside_the_pointer_with_its_words_inside(make_brush) -> None:
    brush = make_brush(2.0, 1.5)
    paint_decor.paint_note(brush, 300.0, 200.0, "It does not fit", 7)
    filled, edge, text = drawn(brush).shapes
    assert filled.points == edge.points and filled.points[0] == (324.0, 221.0)  # 16 and 14 at scale 1.5
    (x, y), (right, bottom) = text.points[0], filled.points[1]
    assert text.lengths == (13.5 * 1.5, 340.0 * 1.5)
    assert x - filled.points[0][0] == right - (x + 0.5 * 13.5 * 15) == pytest.approx(10.5)
    assert y - filled.points[0][1] == pytest.approx(bottom - (y + 13.5))


def test_a_hint_is_centered_near_the_top(make_brush) -> None:
    brush = make_brush()
    paint_decor.paint_hint(brush, (100.0, 50.0, 900.0, 650.0), ("Nothing here", "Press Tab"))
    title, line = drawn(brush).shapes
    for shape in (title, line):
        assert shape.points[0][0] + 0.25 * shape.lengths[0] * len(shape.text) == pytest.approx(500.0)
    assert (title.lengths[0], line.lengths[0]) == (18.0, 13.5)
    assert title.points[0][1] == pytest.approx(50.0 + 84.0) and line.points[0][1] == pytest.approx(134.0 + 18.0 * 1.7)


def test_only_what_is_seen_of_links_is_drawn(make_brush, scene) -> None:
    wire = scene.wires[0]
    xs, ys = wire.curves[0][0::2], wire.curves[0][1::2]
    left, top, right, bottom = min(xs), min(ys), max(xs), max(ys)
    for visible, count in (
        ((left - 9, top - 9, left, bottom), 2),
        ((left - 9, top - 9, left - 1, bottom), 0),
        ((right, top, right + 9, top), 2),
        ((right + 1, top, right + 9, bottom), 0),
        ((left, top - 9, right, top - 1), 0),
        ((left, bottom + 1, right, bottom + 9), 0),
    ):
        brush = make_brush()
        brush.visible = visible
        paint_decor.paint_wire(brush, wire, lit=False, faded=False)
        assert len(drawn(brush).shapes) == count


@pytest.mark.parametrize("zoom", [0.2, 0.5, 0.6, 1.0])
def test_a_frame_has_its_title_in_a_strip_at_its_top(make_brush, zoom: float) -> None:
    """Far away the title is as large as can be read, and lies lower, so that it is not cut off."""
    brush = make_brush(zoom)
    box = replace(BOX, sort="frame", w=600.0, h=400.0)
    paint_decor.paint_frame(brush, box, {"title": "Sky", "color": [0.5, 0.25, 0.125]}, False, False)
    area, strip = drawn(brush).list_kinds("filled rect")
    assert area.points == drawn(brush).list_kinds("rect")[0].points == brush.project_corners(box.rect)
    assert strip.points == brush.project_corners((40.0, 80.0, 640.0, 112.0)) and strip.color & 0xFFFFFF == 0x204080
    (text,) = drawn(brush).list_kinds("text")
    size = text.lengths[0] / zoom
    assert size == pytest.approx(min(max(15.0, 11.0 / zoom), 40.0)) and text.text == "Sky"
    middle = 96.0 if zoom >= 0.6 else max(96.0, 80.0 + 0.8 * size)
    assert text.points[0] == pytest.approx(brush.to.to_screen(52.0, middle - size / 2))


def test_a_low_frame_has_a_strip_as_high_as_itself_and_a_name(make_brush) -> None:
    brush = make_brush()
    paint_decor.paint_frame(brush, replace(BOX, sort="frame", h=20.0), {"color": "red"}, True, False)
    area, strip = drawn(brush).list_kinds("filled rect")
    assert strip.points == area.points and drawn(brush).list_kinds("text")[0].text == "frame"
    (edge,) = drawn(brush).list_kinds("rect")
    assert edge.color == brush.ink.accent and edge.lengths[1] == 2.0
