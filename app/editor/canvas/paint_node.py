"""Nodes and ends as they look."""

from __future__ import annotations

from dataclasses import dataclass

from halation.nodes import Kind
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

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


@dataclass(slots=True)
class NodeLook:
    """How a node stands in the moment. `lit` are the pins that a dragged link could take; None: none is dragged."""

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
    """Draw an element with pins."""
    ink, rect = brush.ink, box.rect
    is_end = box.sort == "end"
    rounding = HEADER / 2 if is_end and not layout.picture else ROUND
    if brush.zoom >= DETAILS_FROM:
        for grow, color in ink.shadow:
            brush.fill((rect[0], rect[1] + 2.0, rect[2], rect[3] + 2.0), color, rounding, grow)
    if look.selected:
        brush.frame(rect, ink.accent, rounding, 2.0, 1.5)
    brush.fill(rect, ink.node_muted if look.muted else ink.node, rounding)
    top = brush.header
    whole = layout.collapsed or (is_end and not layout.picture)
    if whole and top > box.h:  # nothing but a title: it grows to both sides
        rect = rect[0], rect[1] - (top - box.h) / 2, rect[2], rect[3] + (top - box.h) / 2
        rounding = max(rounding, top / 2) if is_end else rounding
    header = (rect[0], rect[1], rect[2], min(rect[1] + top, rect[3]))
    brush.fill(header, ink.category(layout.category, look.muted), rounding, flags=_ALL if whole else _TOP)
    if layout.what == "unknown":
        brush.frame(rect, ink.warning, rounding, 1.5)
    brush.frame(rect, ink.error if look.fault else ink.outline, rounding, 1.5 if look.fault else 1.0)
    if layout.what == "group":
        brush.frame(rect, ink.error if look.fault else ink.category("group"), rounding, 1.5, 3.0)
    _title(brush, box, layout, look, (header[1] + header[3]) / 2)
    if look.picture and layout.picture:
        place = layout.picture if brush.zoom >= DETAILS_FROM else (layout.picture[0], top, *layout.picture[2:])
        _picture(brush, box, place, look.picture, look)
    if brush.zoom >= DETAILS_FROM:
        _rows(brush, box, layout, look)
        if layout.more:
            _more(brush, box, layout, look.hot)
    if look.muted:
        _bypass(brush, box, layout)
    for output, pins in ((False, layout.ins), (True, layout.outs)):
        for pin in pins.values():
            _pin_of(brush, box, pin, output, look)
    if look.overlay:
        size = max(SMALL, brush.title * 0.9)
        time, _, _ = look.overlay.partition("   ")
        text = look.overlay if brush.width(look.overlay, size) <= box.w else brush.short(time, box.w, size)
        brush.text(rect[0] + 2.0, rect[1] - size * 0.75, look.overlay_color, text, size)


def paint_pin(
    brush: DrawContext, x: float, y: float, kind: Kind | None, color: int, grow: float = 0.0, core: int = 0
) -> None:
    """A socket: its shape tells its kind as its color does. `core` fills the hole of a ring or of an optional pin."""
    s = brush.to.scale
    cx, cy = brush.to.to_screen(x, y)
    r, rim, draw = (PIN + grow) * s, brush.ink.canvas, brush.draw
    if kind is Kind.VECTOR:
        for size, ink in ((r * 1.45, rim), (r * 1.15, color), (r * 0.5, core)):
            if ink:
                draw.add_quad_filled((cx - size, cy), (cx, cy - size), (cx + size, cy), (cx, cy + size), ink)
        return
    if kind is Kind.NUMBER or kind is Kind.COLOR:
        for size, ink in ((r * 1.05, rim), (r * 0.82, color), (r * 0.4, core)):
            if ink:
                draw.add_rect_filled(
                    (cx - size, cy - size), (cx + size, cy + size), ink, size * (0.75 if kind is Kind.COLOR else 0.15)
                )
        return
    if kind is not None and kind.is_planned:
        for size, ink in ((r * 1.5, rim), (r * 1.15, color), (r * 0.5, core)):
            if ink:
                draw.add_triangle_filled((cx - size, cy - size), (cx + size, cy), (cx - size, cy + size), ink)
        return
    if kind is Kind.FIELD:
        core = core or brush.ink.node
        r *= 0.95
    draw.add_circle_filled((cx, cy), r * 1.25, rim)
    draw.add_circle_filled((cx, cy), r, color)
    if core:
        draw.add_circle_filled((cx, cy), r * 0.45, core)


def _pin_of(brush: DrawContext, box: ElementBox, pin: Pin, output: bool, look: NodeLook) -> None:
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
    rows = box.layout.rows if box.layout else ()
    return any(row.linked for row in rows if row.left is pin) or bool(box.layout and box.layout.collapsed)


def _title(brush: DrawContext, box: ElementBox, layout: NodeLayout, look: NodeLook, y: float) -> None:
    ink, size = brush.ink, brush.title
    color = ink.dim if look.muted else ink.text
    left, right = box.x + _INSET, box.x + box.w - 8.0
    if brush.zoom < DETAILS_FROM:
        room = box.w - _INSET * 2
        title = brush.short(layout.title, room, size)
        if len(title) > 2 or title == layout.title:
            brush.text(left, y, color, title, size)
        return
    if look.fault or look.warning:
        icon = icons.ICON_FA_TRIANGLE_EXCLAMATION
        brush.text(right - TITLE, y, ink.error if look.fault else ink.warning, icon, TITLE)
        right -= TITLE + 6.0
    for word, fore, back in ((look.viewed, ink.node, ink.accent), (look.badges, ink.text, ink.outline)):
        if word:
            width = brush.width(word, SMALL, True) + 10.0
            brush.fill((right - width, y - 8.0, right, y + 8.0), back, 8.0)
            brush.text(right - width + 5.0, y, fore, word, SMALL, True)
            right -= width + 4.0
    if layout.what in ("group", "unknown"):
        icon = icons.ICON_FA_LAYER_GROUP if layout.what == "group" else icons.ICON_FA_CIRCLE_QUESTION
        brush.text(left, y, color, icon, SMALL)
        left += 20.0
    if box.sort == "end":
        is_input = layout.what == "input"
        icon = icons.ICON_FA_RIGHT_TO_BRACKET if is_input else icons.ICON_FA_RIGHT_FROM_BRACKET
        brush.text(left, y, ink.dim, icon, SMALL)
        left += 20.0
    title = brush.short(layout.title, right - left, size, True)
    brush.text(left, y, color, title, size, True)
    left += brush.width(title, size, True) + 7.0
    if layout.subtitle and right - left > 24.0:
        name = spell_out(layout.subtitle)
        brush.text(left, y + 0.5, ink.over, brush.short(name, right - left, SMALL), SMALL)


def _rows(brush: DrawContext, box: ElementBox, layout: NodeLayout, look: NodeLook) -> None:
    of = layout, look.muted, look.live, brush.ink
    known = brush.texts.sketches.get(box.key)
    if known is None or known[0][0] is not layout or known[0][1:] != of[1:]:
        sketch = Sketch(brush)
        for row in layout.rows:
            _row(sketch, row, look)
        known = brush.texts.sketches[box.key] = of, sketch
    known[1].draw(brush, box.x, box.y)


def _row(brush: Sketch, row: NodeRow, look: NodeLook) -> None:
    ink, y = brush.ink, row.y + ROW / 2
    if row.value is not None:
        if row.linked:
            brush.text(_INSET, y, ink.dim, brush.short(row.label, WIDTH - _INSET * 2))
        elif row.value.name not in look.live:
            paint_field(brush, row, look.muted)
        return
    color = ink.dim if look.muted else ink.text
    room = WIDTH - _INSET * 2 if not (row.left and row.right) else WIDTH / 2 - _INSET - 2.0
    if row.left:
        name = brush.short(spell_out(row.left.name), room)
        brush.text(_INSET, y, ink.dim if row.left.optional and not row.linked else color, name)
        if row.hint:
            brush.right(WIDTH - _INSET, y, ink.faint, row.hint, SMALL)
    if row.right:
        brush.right(WIDTH - _INSET, y, color, brush.short(spell_out(row.right.name), room))


def _more(brush: DrawContext, box: ElementBox, layout: NodeLayout, hot: bool) -> None:
    _, top, _, bottom = layout.more or (0.0, 0.0, 0.0, 0.0)
    y, x = box.y + (top + bottom) / 2 - 1.0, box.x + box.w / 2
    color = brush.ink.dim if hot else brush.ink.faint
    text = icons.ICON_FA_CHEVRON_UP if layout.open else f"{icons.ICON_FA_CHEVRON_DOWN} {layout.hidden} more"
    brush.text(x - brush.width(text, 10.0) / 2, y, color, text, 10.0)


def _picture(brush: DrawContext, box: ElementBox, place: Rect, picture: imgui.ImTextureRef, look: NodeLook) -> None:
    area = box.x + place[0], box.y + place[1] + 2.0, box.x + place[2], box.y + place[3]
    if brush.zoom >= DETAILS_FROM:
        brush.fill(area, brush.ink.picture, 3.0)
    across, down = area[2] - area[0], area[3] - area[1]
    width, height = look.picture_size
    ratio = min(across / width, down / height)
    x, y = (area[0] + area[2]) / 2, (area[1] + area[3]) / 2
    half = width * ratio / 2, height * ratio / 2
    low, high = brush.corners((x - half[0], y - half[1], x + half[0], y + half[1]))
    veil = 0xFFFFFFFF if look.fresh else 0x90FFFFFF
    brush.draw.add_image_rounded(picture, low, high, (0, 0), (1, 1), veil, 3.0 * brush.to.scale)


def _bypass(brush: DrawContext, box: ElementBox, layout: NodeLayout) -> None:
    """The line through a muted node that shows what passes."""
    if not layout.ins or not layout.outs:
        return
    start, end = next(iter(layout.ins.values())), next(iter(layout.outs.values()))
    low = brush.to.to_screen(box.x + start.x, box.y + start.y)
    high = brush.to.to_screen(box.x + end.x, box.y + end.y)
    brush.draw.add_line(low, high, brush.ink.kinds[start.kind], 2.0 * brush.line)
