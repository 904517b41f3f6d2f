"""Paints nodes, and the inputs and outputs of the graph."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal

from halation.nodes import Kind
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import Struct

from ...language.translation import translate
from ..shared.declared_words import name_value
from ..shared.entries import spell_out
from .brush import DETAILS_FROM, SMALL, TITLE, DrawContext
from .geometry import Rect
from .layout import HEADER, ROW, WIDTH, NodeLayout, NodeRow, Pin
from .paint_field import paint_field
from .scene import ElementBox
from .sketch import Sketch

ROUND = 6.0
PIN = 5.0
_TOP = int(imgui.ImDrawFlags_.round_top)
_ALL = int(imgui.ImDrawFlags_.round_all)
_INSET = 12.0

PinShape = Literal["circle", "diamond", "square", "triangle"]


class NodeLook(Struct):
    """The state of a node in one frame. `lit` are the pins that a dragged link fits; None if no link is dragged."""

    selected: bool = False
    active: bool = False
    muted: bool = False
    fault: str = ""
    warning: str = ""
    badges: str = ""
    viewed: str = ""
    """`A`, `B` or both, where the viewer shows it."""
    hot: bool = False
    lit: frozenset[tuple[bool, str]] | None = None
    picture: imgui.ImTextureRef | None = None
    picture_size: tuple[int, int] = (1, 1)
    fresh: bool = True
    live: frozenset[str] = frozenset()
    """Values whose fields are widgets in this frame: they draw themselves."""
    overlay: str = ""
    overlay_color: int = 0


def paint_node(brush: DrawContext, box: ElementBox, layout: NodeLayout, look: NodeLook) -> None:
    """Paint a node, or an input or output of the graph."""
    ink, rect = brush.ink, box.rect
    is_end = box.sort == "end"
    rounding = HEADER / 2 if is_end and not layout.picture else ROUND
    if brush.zoom >= DETAILS_FROM:
        for grow, color in ink.shadow:
            brush.fill_rect((rect[0], rect[1] + 2.0, rect[2], rect[3] + 2.0), color, rounding, grow)
    if look.selected:
        brush.draw_outline(rect, ink.accent, rounding, 2.0, 1.5)
    brush.fill_rect(rect, ink.node_muted if look.muted else ink.node, rounding)
    top = brush.header
    whole = layout.collapsed or (is_end and not layout.picture)
    if whole and top > box.h:  # only a title: it grows to both sides
        rect = rect[0], rect[1] - (top - box.h) / 2, rect[2], rect[3] + (top - box.h) / 2
        rounding = max(rounding, top / 2) if is_end else rounding
    header = (rect[0], rect[1], rect[2], min(rect[1] + top, rect[3]))
    brush.fill_rect(header, ink.find_header_color(layout.category, look.muted), rounding, flags=_ALL if whole else _TOP)
    if layout.sort == "unknown":
        brush.draw_outline(rect, ink.warning, rounding, 1.5)
    brush.draw_outline(rect, ink.error if look.fault else ink.outline, rounding, 1.5 if look.fault else 1.0)
    if layout.sort == "group":
        brush.draw_outline(rect, ink.error if look.fault else ink.find_header_color("group"), rounding, 1.5, 3.0)
    _paint_title(brush, box, layout, look, (header[1] + header[3]) / 2)
    if look.picture and layout.picture:
        place = layout.picture if brush.zoom >= DETAILS_FROM else (layout.picture[0], top, *layout.picture[2:])
        _paint_picture(brush, box, place, look.picture, look)
    if brush.zoom >= DETAILS_FROM:
        _paint_rows(brush, box, layout, look)
        if layout.more:
            _paint_more(brush, box, layout, look.hot)
    if look.muted:
        _paint_bypass(brush, box, layout)
    for output, pins in ((False, layout.ins), (True, layout.outs)):
        for pin in pins.values():
            _paint_node_pin(brush, box, pin, output, look)
    if look.overlay:
        size = max(SMALL, brush.title * 0.9)
        time, _, _ = look.overlay.partition("   ")
        text = look.overlay if brush.measure(look.overlay, size) <= box.w else brush.shorten(time, box.w, size)
        brush.draw_text(rect[0] + 2.0, rect[1] - size * 0.75, look.overlay_color, text, size)


def paint_pin(
    brush: DrawContext, x: float, y: float, kind: Kind | None, color: int, grow: float = 0.0, core: int = 0
) -> None:
    """Paint a socket: shape and color show its kind. `core` fills the hole of a ring or of an optional pin."""
    s = brush.to.scale
    cx, cy = brush.to.to_screen(x, y)
    r, rim, draw = (PIN + grow) * s, brush.ink.canvas, brush.draw
    shape = find_pin_shape(kind)
    if shape == "diamond":
        for size, ink in ((r * 1.45, rim), (r * 1.15, color), (r * 0.5, core)):
            if ink:
                draw.add_quad_filled((cx - size, cy), (cx, cy - size), (cx + size, cy), (cx, cy + size), ink)
        return
    if shape == "triangle":
        for size, ink in ((r * 1.5, rim), (r * 1.15, color), (r * 0.5, core)):
            if ink:
                draw.add_triangle_filled((cx - size, cy - size), (cx + size, cy), (cx - size, cy + size), ink)
        return
    if shape == "square":
        for size, ink in ((r * 1.05, rim), (r * 0.82, color), (r * 0.4, core)):
            if ink:
                draw.add_rect_filled(
                    (cx - size, cy - size), (cx + size, cy + size), ink, size * (0.75 if kind is Kind.COLOR else 0.15)
                )
        return
    if kind is Kind.FIELD:
        core = core or brush.ink.node
        r *= 0.95
    draw.add_circle_filled((cx, cy), r * 1.25, rim)
    draw.add_circle_filled((cx, cy), r, color)
    if core:
        draw.add_circle_filled((cx, cy), r * 0.45, core)


@lru_cache
def find_pin_shape(kind: Kind | None) -> PinShape:
    """The shape of a socket; asked for each socket in each frame, so it is found once."""
    if kind is Kind.VECTOR:
        return "diamond"
    if kind is not None and kind.is_planned:
        return "triangle"
    return "square" if kind is not None and kind.is_single else "circle"


def _paint_node_pin(brush: DrawContext, box: ElementBox, pin: Pin, output: bool, look: NodeLook) -> None:
    if pin.value and not (look.hot or look.lit is not None or _is_linked(box, pin)):
        return
    ink, grow = brush.ink, 0.0
    color = ink.kinds[pin.kind]
    if look.lit is not None:
        if (output, pin.name) in look.lit:
            grow = 1.5
        else:
            color = ink.kinds_dim[pin.kind]
    hollow = pin.optional and not _is_linked(box, pin) and box.sort == "node"
    paint_pin(brush, box.x + pin.x, box.y + pin.y, pin.kind, color, grow, ink.node if hollow else 0)


def _is_linked(box: ElementBox, pin: Pin) -> bool:
    return box.layout is not None and (box.layout.collapsed or pin.name in box.layout.linked)


def _paint_title(brush: DrawContext, box: ElementBox, layout: NodeLayout, look: NodeLook, y: float) -> None:
    ink, size = brush.ink, brush.title
    color = ink.dim if look.muted else ink.text
    left, right = box.x + _INSET, box.x + box.w - 8.0
    if brush.zoom < DETAILS_FROM:
        room = box.w - _INSET * 2
        title = brush.shorten(layout.title, room, size)
        if len(title) > 2 or title == layout.title:
            brush.draw_text(left, y, color, title, size)
        return
    if look.fault or look.warning:
        icon = icons.ICON_FA_TRIANGLE_EXCLAMATION
        brush.draw_text(right - TITLE, y, ink.error if look.fault else ink.warning, icon, TITLE)
        right -= TITLE + 6.0
    for word, fore, back in ((look.viewed, ink.node, ink.accent), (look.badges, ink.text, ink.outline)):
        if word:
            width = brush.measure(word, SMALL, True) + 10.0
            brush.fill_rect((right - width, y - 8.0, right, y + 8.0), back, 8.0)
            brush.draw_text(right - width + 5.0, y, fore, word, SMALL, True)
            right -= width + 4.0
    if layout.sort in ("group", "unknown"):
        icon = icons.ICON_FA_LAYER_GROUP if layout.sort == "group" else icons.ICON_FA_CIRCLE_QUESTION
        brush.draw_text(left, y, color, icon, SMALL)
        left += 20.0
    if box.sort == "end":
        is_input = layout.sort == "input"
        icon = icons.ICON_FA_RIGHT_TO_BRACKET if is_input else icons.ICON_FA_RIGHT_FROM_BRACKET
        brush.draw_text(left, y, ink.dim, icon, SMALL)
        left += 20.0
    title = brush.shorten(layout.title, right - left, size, True)
    brush.draw_text(left, y, color, title, size, True)
    left += brush.measure(title, size, True) + 7.0
    if layout.subtitle and right - left > 24.0:
        name = spell_out(layout.subtitle)
        brush.draw_text(left, y + 0.5, ink.over, brush.shorten(name, right - left, SMALL), SMALL)


def _paint_rows(brush: DrawContext, box: ElementBox, layout: NodeLayout, look: NodeLook) -> None:
    inputs = layout, look.muted, look.live, brush.ink
    cached = brush.texts.sketches.get(box.key)
    if cached is None or cached[0][0] is not layout or cached[0][1:] != inputs[1:]:
        sketch = Sketch(brush)
        for row in layout.rows:
            _paint_row(sketch, row, look)
        cached = brush.texts.sketches[box.key] = inputs, sketch
    cached[1].draw(brush, box.x, box.y)


def _paint_row(brush: Sketch, row: NodeRow, look: NodeLook) -> None:
    ink, y = brush.ink, row.y + ROW / 2
    if row.value is not None:
        if row.linked:
            brush.draw_text(_INSET, y, ink.dim, brush.shorten(row.label, WIDTH - _INSET * 2))
        elif row.value.name not in look.live:
            paint_field(brush, row, look.muted)
        return
    color = ink.dim if look.muted else ink.text
    room = WIDTH - _INSET * 2 if not (row.left and row.right) else WIDTH / 2 - _INSET - 2.0
    if row.left:
        name = brush.shorten(name_value(row.left.name), room)
        brush.draw_text(_INSET, y, ink.dim if row.left.optional and not row.linked else color, name)
        if row.hint:
            brush.draw_right(WIDTH - _INSET, y, ink.faint, row.hint, SMALL)
    if row.right:
        brush.draw_right(WIDTH - _INSET, y, color, brush.shorten(name_value(row.right.name), room))


def _paint_more(brush: DrawContext, box: ElementBox, layout: NodeLayout, hot: bool) -> None:
    _, top, _, bottom = layout.more or (0.0, 0.0, 0.0, 0.0)
    y, x = box.y + (top + bottom) / 2 - 1.0, box.x + box.w / 2
    color = brush.ink.dim if hot else brush.ink.faint
    more = translate("{count} more", count=layout.hidden)
    text = icons.ICON_FA_CHEVRON_UP if layout.open else f"{icons.ICON_FA_CHEVRON_DOWN} {more}"
    brush.draw_text(x - brush.measure(text, 10.0) / 2, y, color, text, 10.0)


def _paint_picture(
    brush: DrawContext, box: ElementBox, place: Rect, picture: imgui.ImTextureRef, look: NodeLook
) -> None:
    area = box.x + place[0], box.y + place[1] + 2.0, box.x + place[2], box.y + place[3]
    if brush.zoom >= DETAILS_FROM:
        brush.fill_rect(area, brush.ink.picture, 3.0)
    across, down = area[2] - area[0], area[3] - area[1]
    width, height = look.picture_size
    ratio = min(across / width, down / height)
    x, y = (area[0] + area[2]) / 2, (area[1] + area[3]) / 2
    half = width * ratio / 2, height * ratio / 2
    low, high = brush.project_corners((x - half[0], y - half[1], x + half[0], y + half[1]))
    veil = 0xFFFFFFFF if look.fresh else 0x90FFFFFF
    brush.draw.add_image_rounded(picture, low, high, (0, 0), (1, 1), veil, 3.0 * brush.to.scale)


def _paint_bypass(brush: DrawContext, box: ElementBox, layout: NodeLayout) -> None:
    """Paint the line through a muted node, from its first input to its first output."""
    if not layout.ins or not layout.outs:
        return
    start, end = next(iter(layout.ins.values())), next(iter(layout.outs.values()))
    low = brush.to.to_screen(box.x + start.x, box.y + start.y)
    high = brush.to.to_screen(box.x + end.x, box.y + end.y)
    brush.draw.add_line(low, high, brush.ink.kinds[start.kind], 2.0 * brush.line)
