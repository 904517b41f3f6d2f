"""What is drawn on the canvas: where it is, that it moves with the canvas, grows with the interface and fits."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_links import build_scene, sample_wire
from drawn_shapes import DrawnShapes, Shape
from halation import document, presets
from halation.editor.canvas import brush as brushes
from halation.editor.canvas import paint_decor, paint_node
from halation.editor.canvas.brush import DrawContext, TextCache, make_canvas_colors
from halation.editor.canvas.geometry import CanvasTransform
from halation.editor.canvas.layout import HEADER
from halation.editor.canvas.scene import ElementBox
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle.imgui import ImDrawFlags_
from msgspec.structs import replace

BOX: Any = ElementBox("comment", "comment", 40.0, 80.0, 200.0, 120.0)  # pyright: ignore
WORDS: Any = SimpleNamespace(text=None, bold=None)
PICTURE: Any = object()


@pytest.fixture(scope="module")
def scene():
    path = next(path for path in presets.paths() if path.stem == "film_halation")
    return build_scene(document.load(path, sandbox=UNRESTRICTED))


@pytest.fixture
def make_brush(monkeypatch: pytest.MonkeyPatch) -> Callable[..., DrawContext]:
    """`make_brush(zoom, scale, shift)`: a canvas whose letters are half as wide as high."""

    def make(zoom: float = 1.0, scale: float = 1.0, shift: tuple[float, float] = (0.0, 0.0)) -> DrawContext:
        shapes: Any = DrawnShapes(48.0)
        imgui = SimpleNamespace(
            push_font=lambda font, size: setattr(shapes, "em", size),
            pop_font=lambda: None,
            calc_text_size=shapes.measure,
            get_font_size=lambda: shapes.em,
            get_foreground_draw_list=lambda: shapes,
            ImDrawFlags_=ImDrawFlags_,
        )
        for module in (brushes, paint_decor):
            monkeypatch.setattr(module, "imgui", imgui)
        to = CanvasTransform(16.0 * scale + shift[0], 8.0 * scale + shift[1], zoom * scale)
        return DrawContext(shapes, to, zoom, make_canvas_colors("dark"), WORDS, TextCache(), (-1e4, -1e4, 1e4, 1e4))

    return make


def drawn(brush: DrawContext) -> DrawnShapes:
    shapes: Any = brush.draw
    return shapes


def paint_all(brush: DrawContext, scene: Any, **look: Any) -> None:
    """Everything that a canvas shows."""
    for box in scene.boxes.values():
        if box.layout is not None:
            chosen = paint_node.NodeLook(selected=True, viewed="A", badges="2", overlay="3 ms   4 %", **look)
            paint_node.paint_node(brush, box, box.layout, chosen)
    for number, wire in enumerate(scene.wires):
        paint_decor.paint_wire(brush, replace(wire, muted=number % 2 == 0), lit=True, faded=False)
    facts = {"title": "A frame", "color": [0.5, 0.25, 0.125]}
    paint_decor.paint_frame(brush, replace(BOX, sort="frame"), facts, True, True)
    paint_decor.paint_comment(brush, BOX, "Here", True)
    paint_decor.paint_dot(brush, replace(BOX, w=8.0, h=8.0), 7, True)
    paint_decor.paint_band(brush, BOX.rect)
    paint_decor.paint_cut(brush, (0.0, 0.0), (50.0, 70.0), 7)


@pytest.mark.parametrize("zoom", [0.25, 1.0])
def test_what_is_drawn_moves_with_the_canvas(make_brush, scene, zoom: float) -> None:
    here, there = make_brush(zoom), make_brush(zoom, shift=(64.0, -32.0))
    paint_all(there, scene)
    paint_all(here, scene)
    compare([shape.change(1.0, (64.0, -32.0)) for shape in drawn(here).shapes], drawn(there).shapes)


@pytest.mark.parametrize("zoom", [0.25, 1.0])
def test_what_is_drawn_grows_with_the_interface(make_brush, scene, zoom: float) -> None:
    small = make_brush(zoom)
    paint_all(small, scene)
    large = make_brush(zoom, scale=2.0)
    paint_all(large, scene)
    compare([shape.change(2.0, (0.0, 0.0)) for shape in drawn(small).shapes], drawn(large).shapes)


def compare(ours: list[Shape], theirs: list[Shape]) -> None:
    assert [(shape.kind, shape.color, shape.text) for shape in ours] == [
        (shape.kind, shape.color, shape.text) for shape in theirs
    ]
    for mine, other in zip(ours, theirs, strict=True):
        assert mine.lengths == pytest.approx(other.lengths)
        np.testing.assert_allclose(mine.points, other.points, atol=1e-6)


def test_words_lie_in_their_node_and_not_on_each_other(make_brush, scene) -> None:
    for box in scene.boxes.values():
        if box.layout is None:
            continue
        brush = make_brush()
        paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook(viewed="A", badges="2", fault="no"))
        (left, top), (right, bottom) = brush.project_corners(box.rect)
        rows: list[tuple[float, float, float]] = []
        for shape in drawn(brush).list_kinds("text"):
            (x, y), size = shape.points[0], shape.lengths[0]
            end = x + 0.5 * size * len(shape.text)
            assert left < x and end < right and top < y and y + size < bottom, (box.key, shape.text)
            rows.append((y + size / 2, x, end))
        for middle, x, end in rows:
            others = [(a, b) for at, a, b in rows if abs(at - middle) < 6.0 and (a, b) != (x, end)]
            assert all(end <= a + 0.01 or b <= x + 0.01 for a, b in others), (box.key, middle)


def test_sockets_are_where_links_end(make_brush, scene) -> None:
    for wire in scene.wires:
        assert len(wire.curves) == 1
    for box in scene.boxes.values():
        if box.layout is None or box.layout.collapsed:
            continue
        brush = make_brush()
        paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook(hot=True))
        centers = {middle_of(shape) for shape in drawn(brush).list_kinds("disk", "quad", "triangle", "filled rect")}
        for pin in (*box.layout.ins.values(), *box.layout.outs.values()):
            x, y = brush.to.to_screen(box.x + pin.x, box.y + pin.y)
            assert any(math.dist(at, (x, y)) < 1e-6 for at in centers), (box.key, pin.name)


def middle_of(shape: Shape) -> tuple[float, float]:
    xs, ys = zip(*shape.points, strict=True)
    return (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2


@pytest.mark.parametrize("kind", [*Kind, None])
@pytest.mark.parametrize("core", [0, 9])
def test_a_socket_is_colored_within_a_dark_rim_around_its_core(make_brush, kind: Kind | None, core: int) -> None:
    brush = make_brush()
    paint_node.paint_pin(brush, 10.0, 20.0, kind, 5, core=core)
    shapes = drawn(brush).shapes
    extents = [max(math.dist(at, (26.0, 28.0)) for at in shape.points) or shape.lengths[0] for shape in shapes]
    assert extents == sorted(extents, reverse=True) and len({*extents}) == len(extents)
    assert [shape.color for shape in shapes[:2]] == [brush.ink.canvas, 5]
    hole = core or (brush.ink.node if kind is Kind.FIELD else 0)
    assert [shape.color for shape in shapes[2:]] == ([hole] if hole else [])
    assert all(middle_of(shape) == pytest.approx((26.0, 28.0)) for shape in shapes)
    assert 3.0 < extents[1] < 9.0


@pytest.mark.parametrize(("size", "expected"), [((200, 100), 2.0), ((100, 200), 0.5), ((64, 64), 1.0)])
def test_a_thumbnail_keeps_its_shape_in_the_middle_of_its_place(make_brush, scene, size, expected) -> None:
    box = next(box for box in scene.boxes.values() if box.layout is not None and box.layout.picture)
    brush, place = make_brush(), box.layout.picture
    paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook(picture=PICTURE, picture_size=size))
    (picture,) = drawn(brush).list_kinds("picture")
    (left, top), (right, bottom) = picture.points
    assert (right - left) / (bottom - top) == pytest.approx(expected) and picture.text == "(0, 0) (1, 1)"
    low, high = brush.project_corners((box.x + place[0], box.y + place[1] + 2.0, box.x + place[2], box.y + place[3]))
    assert (left + right, top + bottom) == pytest.approx((low[0] + high[0], low[1] + high[1]))
    assert min(high[0] - low[0] - (right - left), high[1] - low[1] - (bottom - top)) == pytest.approx(0.0)


def test_a_muted_node_has_a_line_from_its_first_input_to_its_first_output(make_brush, scene) -> None:
    box = next(box for box in scene.boxes.values() if box.layout is not None and box.layout.ins and box.layout.outs)
    brush = make_brush()
    paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook(muted=True))
    (line,) = drawn(brush).list_kinds("line")
    pins = next(iter(box.layout.ins.values())), next(iter(box.layout.outs.values()))
    assert line.points == tuple(brush.to.to_screen(box.x + pin.x, box.y + pin.y) for pin in pins)
    assert line.lengths == (2.0,)


def test_titles_stay_readable_and_headers_hold_them(make_brush) -> None:
    for zoom in (0.1, 0.5, 1.0, 2.0):
        brush = make_brush(zoom)
        assert brush.title * zoom >= 11.0 - 1e-9 and brush.title >= 14.0
        assert brush.header >= max(HEADER, brush.title * 1.4)
    assert make_brush(1.0).title == 14.0 and make_brush(1.0).header == HEADER
    assert [make_brush(zoom, 2.0).line for zoom in (0.5, 1.0, 4.0)] == [1.5, 2.0, 8.0]


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


def test_what_is_cut_off_ends_with_an_ellipsis_and_fits(make_brush) -> None:
    brush = make_brush()
    assert brush.shorten("exposure", 54.0) == "exposure"  # eight letters of 6.75
    cut = brush.shorten("exposure", 53.0)
    assert cut == "exposu…" and brush.measure(cut) <= 53.0
    assert brush.shorten("exposure", 1.0) == "e…"
    assert brush.measure("ab", 20.0) == 20.0


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


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_nodes_stand_out_from_the_canvas_in_each_theme(theme: str) -> None:
    """The outline is no lighter than the border in a light theme; shadows are faint, and pictures darker than nodes."""
    ink = make_canvas_colors(theme)
    assert len({ink.node, ink.canvas, ink.outline, ink.picture, ink.text, ink.error, ink.warning}) == 7
    alphas = {color >> 24 for _, color in ink.shadow}
    assert [grow for grow, _ in ink.shadow] == [1.0, 3.0, 6.0] and alphas == {26 if theme == "dark" else 14}
    assert sum(ink.picture.to_bytes(4, "little")[:3]) < sum(ink.node.to_bytes(4, "little")[:3])
    assert ink.faint >> 24 == 153 and ink.accent_soft >> 24 == 31
