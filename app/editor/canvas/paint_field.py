"""Paints the values on nodes that are not under the mouse, like the fields of the inspector."""

from __future__ import annotations

from imgui_bundle import imgui

from ...language.translation import translate
from ..fields.colors import swatch
from ..theme.style import u32
from .brush import TEXT
from .geometry import Rect
from .layout import MOST_PARTS, FieldText, NodeRow
from .sketch import Sketch

ROUND = 4.0
PAD = 6.0
GAP = 3.0
_LEFT, _RIGHT, _NONE = (
    int(flag) for flag in (imgui.ImDrawFlags_.round_left, imgui.ImDrawFlags_.round_right, imgui.ImDrawFlags_.round_none)
)


def paint_field(sketch: Sketch, row: NodeRow, muted: bool) -> None:
    """Draw the field of a value of a node."""
    value, rect = row.value, row.field
    if value is None or rect is None:
        return
    color = sketch.ink.dim if muted else sketch.ink.text
    match value.type:
        case "float" | "int":
            _paint_number(sketch, rect, row.label, row.texts[0], color)
        case "bool":
            _paint_switch(sketch, rect, row.label, bool(row.plain))
        case "color":
            _paint_swatch(sketch, rect, row)
        case "vector" if len(row.texts) <= MOST_PARTS:
            paint_label(sketch, rect, row.label, len(row.texts))
            for number_rect, part in zip(split_vector(rect, len(row.texts))[1], row.texts, strict=True):
                _paint_number(sketch, number_rect, "", part, color)
        case _:
            _paint_words(sketch, rect, row, color)


def split_vector(rect: Rect, count: int) -> tuple[float, list[Rect]]:
    """The left edge of the fields of a vector, and the rectangles of the fields; the label lies left of them."""
    room = (rect[2] - rect[0]) * (0.64 if count < 3 else 0.74)
    left, each = rect[2] - room, (room - GAP * (count - 1)) / count
    return left, [(left + (each + GAP) * at, rect[1], left + (each + GAP) * at + each, rect[3]) for at in range(count)]


def paint_label(sketch: Sketch, rect: Rect, label: str, count: int) -> None:
    """Paint the name of a vector beside its fields."""
    room = split_vector(rect, count)[0] - rect[0] - GAP * 2
    sketch.draw_text(rect[0] + 4.0, (rect[1] + rect[3]) / 2, sketch.ink.dim, sketch.shorten(label, room))


def _paint_number(sketch: Sketch, rect: Rect, label: str, field_text: FieldText, color: int) -> None:
    sketch.fill_rect(rect, sketch.ink.field, ROUND)
    if field_text.part and field_text.part[1] > field_text.part[0]:
        across = rect[2] - rect[0]
        left, right = rect[0] + across * field_text.part[0], rect[0] + across * field_text.part[1]
        flags = (_LEFT if field_text.part[0] <= 0.0 else 0) | (_RIGHT if right > rect[2] - ROUND else 0)
        sketch.fill_rect((left, rect[1], max(right, left + 1.0), rect[3]), sketch.ink.fill, ROUND, flags=flags or _NONE)
    y, pad = (rect[1] + rect[3]) / 2, PAD if label else 3.0
    text = sketch.shorten(field_text.text, rect[2] - rect[0] - pad, TEXT)
    width = sketch.measure(text)
    if not label:
        sketch.draw_text((rect[0] + rect[2] - width) / 2, y, color, text)
        return
    sketch.draw_text(rect[2] - width - pad, y, color, text)
    sketch.draw_text(rect[0] + PAD, y, sketch.ink.dim, sketch.shorten(label, rect[2] - rect[0] - width - PAD * 3))


def _paint_words(sketch: Sketch, rect: Rect, row: NodeRow, color: int) -> None:
    """Paint a name and a word: choices with an arrow, files, and values that only the inspector can edit."""
    sketch.fill_rect(rect, sketch.ink.field, ROUND)
    y, right = (rect[1] + rect[3]) / 2, rect[2] - PAD
    kind = row.value.type if row.value else ""
    if kind == "choice":
        x, size = right - 4.0, 2.9
        sketch.draw_triangle((x - 4, y - size / 2), (x + 4, y - size / 2), (x, y + size), sketch.ink.dim)
        right -= 14.0
    text = row.texts[0].text
    if not text or kind in ("vector", "matrix", "curve", "ramp", "spline", "stroke", "point"):
        text = {"path": translate("no file"), "text": "", "choice": ""}.get(kind, translate("in the inspector"))
        color = sketch.ink.faint
    room = right - rect[0] - PAD
    label = sketch.shorten(row.label, room * 0.5)
    width = sketch.measure(label)
    sketch.draw_text(rect[0] + PAD, y, sketch.ink.dim, label)
    sketch.draw_right(right, y, color, sketch.shorten(text, room - width - PAD))


def _paint_switch(sketch: Sketch, rect: Rect, label: str, on: bool) -> None:
    height = (rect[3] - rect[1]) * 0.62
    long, y = height * 1.8, (rect[1] + rect[3]) / 2
    track = (rect[2] - long, y - height / 2, rect[2], y + height / 2)
    sketch.draw_text(rect[0], y, sketch.ink.dim, sketch.shorten(label, rect[2] - rect[0] - long - PAD))
    sketch.fill_rect(track, sketch.ink.switch_on if on else sketch.ink.switch, height / 2)
    knob = track[0] + (long - height / 2 if on else height / 2)
    sketch.draw_circle(knob, y, height * 0.36, sketch.ink.on_accent if on else sketch.ink.text)


def _paint_swatch(sketch: Sketch, rect: Rect, row: NodeRow) -> None:
    """Paint a color swatch with its name."""
    if not isinstance(row.plain, tuple):
        return
    red, green, blue = swatch((row.plain[0], row.plain[1], row.plain[2]))
    left = rect[2] - (rect[2] - rect[0]) * 0.5
    sketch.draw_text(
        rect[0] + 4.0, (rect[1] + rect[3]) / 2, sketch.ink.dim, sketch.shorten(row.label, left - rect[0] - 8.0)
    )
    sketch.fill_rect((left, *rect[1:]), u32((red, green, blue)), ROUND)
    sketch.draw_outline((left, *rect[1:]), sketch.ink.outline, ROUND)
