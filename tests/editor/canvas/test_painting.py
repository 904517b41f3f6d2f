"""How nodes and all else are drawn on the canvas: it moves with the canvas, grows with the interface, and fits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from drawn_shapes import DrawnShapes, Shape
from halation.editor.canvas import paint_decor, paint_node
from halation.editor.canvas.brush import DrawContext, make_canvas_colors
from halation.editor.canvas.layout import HEADER
from halation.editor.canvas.scene import ElementBox
from halation.nodes import Kind
from msgspec.structs import replace

BOX: Any = ElementBox("comment", "comment", 40.0, 80.0, 200.0, 120.0)  # pyright: ignore
PICTURE: Any = object()


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


@pytest.mark.parametrize("subtitle", ["", "Temporal anti-aliasing of a very long name"])
def test_words_lie_in_their_node_and_not_on_each_other(make_brush, scene, subtitle: str) -> None:
    for box in scene.boxes.values():
        if box.layout is None:
            continue
        box = replace(box, layout=replace(box.layout, subtitle=subtitle or box.layout.subtitle))
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
    assert 3.0 < extents[1] < 9.0 and 1.2 < extents[0] / extents[1] < 1.35
    assert not hole or 0.4 < extents[2] / extents[1] < 0.5


CORNERS: dict[Kind | None, str] = {
    None: "circle", Kind.IMAGE: "circle", Kind.FIELD: "circle", Kind.VECTOR: "diamond", Kind.NUMBER: "square",
    Kind.COLOR: "square", Kind.CAMERA: "triangle",
}  # fmt: skip
"""The shape of the sockets of each kind."""


@pytest.mark.parametrize("kind", [*Kind, None])
def test_kinds_differ_by_the_shape_of_their_sockets(make_brush, kind: Kind | None) -> None:
    """Not by their color alone: a round shape has a middle only, a diamond has its corners beside and above it."""
    brush = make_brush()
    paint_node.paint_pin(brush, 10.0, 20.0, kind, 5)
    points = np.subtract(drawn(brush).shapes[0].points, (26.0, 28.0))
    corners = {(int(np.sign(round(x, 3))), int(np.sign(round(y, 3)))) for x, y in points}
    assert (
        corners
        == {
            "circle": {(0, 0)},
            "diamond": {(-1, 0), (1, 0), (0, -1), (0, 1)},
            "square": {(-1, -1), (1, 1)},
            "triangle": {(-1, -1), (-1, 1), (1, 0)},
        }[CORNERS[kind]]
    )


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


def test_what_is_cut_off_ends_with_an_ellipsis_and_fits(make_brush) -> None:
    brush = make_brush()
    assert brush.shorten("exposure", 54.0) == "exposure"  # eight letters of 6.75
    cut = brush.shorten("exposure", 53.0)
    assert cut == "exposu…" and brush.measure(cut) <= 53.0
    assert brush.shorten("exposure", 1.0) == "e…"
    assert brush.measure("ab", 20.0) == 20.0


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_nodes_stand_out_from_the_canvas_in_each_theme(theme: str) -> None:
    """The outline is no lighter than the border in a light theme; shadows are faint, and pictures darker than nodes."""
    ink = make_canvas_colors(theme)
    assert len({ink.node, ink.canvas, ink.outline, ink.picture, ink.text, ink.error, ink.warning}) == 7
    alphas = {color >> 24 for _, color in ink.shadow}
    assert [grow for grow, _ in ink.shadow] == [1.0, 3.0, 6.0] and alphas == {26 if theme == "dark" else 14}
    assert sum(ink.picture.to_bytes(4, "little")[:3]) < sum(ink.node.to_bytes(4, "little")[:3])
    assert ink.faint >> 24 == 153 and ink.accent_soft >> 24 == 31


@pytest.mark.parametrize("zoom", [0.3, 1.0])
def test_a_header_is_as_wide_as_its_node(make_brush, scene, zoom: float) -> None:
    for box in scene.boxes.values():
        if box.layout is None or box.sort != "node" or box.layout.collapsed:
            continue
        brush = make_brush(zoom)
        paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook())
        low, high = brush.project_corners((box.x, box.y, box.x + box.w, min(box.y + brush.header, box.y + box.h)))
        ink = brush.ink.find_header_color(box.layout.category)
        strips = [shape for shape in drawn(brush).list_kinds("filled rect") if shape.points == (low, high)]
        assert strips and strips[-1].color == ink
        (title,) = [shape for shape in drawn(brush).list_kinds("text") if shape.color == brush.ink.text][:1]
        assert title.points[0][1] + title.lengths[0] / 2 == pytest.approx((low[1] + high[1]) / 2)


def find_node(scene: Any) -> ElementBox:
    return next(box for box in scene.boxes.values() if box.sort == "node" and box.layout and not box.layout.collapsed)


@pytest.mark.parametrize("look", [{}, {"fault": "no"}, {"warning": "hm"}, {"fault": "no", "warning": "hm"}])
def test_a_sign_at_the_right_tells_of_faults_and_warnings(make_brush, scene, look: dict[str, str]) -> None:
    box, brush = find_node(scene), make_brush()
    assert box.layout is not None
    paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook(**look))
    signs = [shape for shape in drawn(brush).list_kinds("text") if len(shape.text) == 1 and ord(shape.text) > 0xE000]
    colors = {brush.ink.error, brush.ink.warning}
    assert [shape.color for shape in signs if shape.color in colors] == (
        [brush.ink.error if "fault" in look else brush.ink.warning] if look else []
    )
    for sign in signs:
        if sign.color in colors:
            assert sign.points[0][0] == pytest.approx(brush.to.to_screen(box.x + box.w - 8.0 - 14.0, 0.0)[0])
    edges = [shape for shape in drawn(brush).list_kinds("rect") if shape.color == brush.ink.error]
    assert len(edges) == ("fault" in look) and all(edge.lengths[1] == 1.5 for edge in edges)


@pytest.mark.parametrize("words", [{}, {"viewed": "A"}, {"badges": "12"}, {"viewed": "AB", "badges": "12"}])
def test_what_is_said_of_a_node_stands_on_plates_beside_each_other(make_brush, scene, words: dict[str, str]) -> None:
    box, brush = find_node(scene), make_brush()
    assert box.layout is not None
    paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook(**words))
    plates = [shape for shape in drawn(brush).list_kinds("filled rect") if shape.lengths == (8.0,)]
    texts = [shape for shape in drawn(brush).list_kinds("text") if shape.text in words.values()]
    assert [shape.text for shape in texts] == [*words.values()] and len(plates) == len(words)
    edge = brush.to.to_screen(box.x + box.w - 8.0, 0.0)[0]
    for plate, text in zip(plates, texts, strict=True):
        (left, top), (right, bottom) = plate.points
        (x, y), size = text.points[0], text.lengths[0]
        assert (
            right == pytest.approx(edge) and x - left == pytest.approx(right - (x + 0.5 * size * len(text.text))) == 5.0
        )
        assert bottom - top == 16.0 and y + size / 2 == pytest.approx((top + bottom) / 2) and plate.color != text.color
        edge = left - 4.0


def test_optional_sockets_without_a_link_are_hollow(make_brush, scene) -> None:
    holes = 0
    boxes = [box for box in scene.boxes.values() if box.layout is not None and not box.layout.collapsed]
    boxes += [replace(box, layout=replace(box.layout, linked=frozenset())) for box in boxes if box.sort == "node"]
    for box in boxes:
        for pin in box.layout.ins.values():
            brush = make_brush()
            paint_node._paint_node_pin(brush, box, pin, False, paint_node.NodeLook(hot=True))  # pyright: ignore
            is_hollow = len(drawn(brush).shapes) == 3
            assert is_hollow is (pin.kind is Kind.FIELD or (pin.optional and pin.name not in box.layout.linked))
            holes += is_hollow
    assert holes


def test_values_have_sockets_while_the_mouse_is_there_or_a_link_is_dragged(make_brush, scene) -> None:
    box = next(box for box in scene.boxes.values() if box.layout and any(pin.value for pin in box.layout.ins.values()))
    pin = next(pin for pin in box.layout.ins.values() if pin.value)
    fits = frozenset({(False, pin.name)})
    for look, count in (
        ({}, 0), ({"hot": True}, 2), ({"lit": frozenset()}, 2), ({"lit": fits}, 2),
        ({"lit": frozenset({(True, pin.name)})}, 2),
    ):  # fmt: skip
        brush = make_brush()
        layout = replace(box.layout, linked=frozenset())
        paint_node._paint_node_pin(brush, replace(box, layout=layout), pin, False, paint_node.NodeLook(**look))  # pyright: ignore
        shapes = drawn(brush).shapes
        assert len(shapes) >= count and bool(shapes) is bool(count)
        if shapes and "lit" in look:
            assert shapes[1].color == (brush.ink.kinds if look["lit"] == fits else brush.ink.kinds_dim)[pin.kind]


def test_rows_have_their_names_and_a_strip_tells_how_many_are_hidden(make_brush, scene) -> None:
    for box in scene.boxes.values():
        if box.layout is None or box.sort != "node" or box.layout.collapsed:
            continue
        brush = make_brush()
        paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook())
        texts = {shape.text: shape.points[0] for shape in drawn(brush).list_kinds("text")}
        for row in box.layout.rows:
            words = [text for text in (row.label, row.left and row.left.name, row.right and row.right.name) if text]
            assert any(text.casefold()[:5] == word.casefold()[:5] for word in words for text in texts), row
        if box.layout.more:
            (more,) = [text for text in texts if text.endswith(f"{box.layout.hidden} more")]
            middle = brush.to.to_screen(box.x + box.w / 2, 0.0)[0]
            assert texts[more][0] == pytest.approx(middle - 0.25 * 10.0 * len(more))


def test_an_old_thumbnail_is_paler(make_brush, scene) -> None:
    box = next(box for box in scene.boxes.values() if box.layout is not None and box.layout.picture)
    colors = []
    for is_fresh in (True, False):
        brush = make_brush()
        paint_node.paint_node(brush, box, box.layout, paint_node.NodeLook(picture=PICTURE, fresh=is_fresh))
        colors += [shape.color for shape in drawn(brush).list_kinds("picture")]
    assert colors == [0xFFFFFFFF, 0x90FFFFFF]
