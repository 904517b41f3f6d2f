"""Values on nodes while the mouse is not over them: drawn like the fields of the inspector, at any zoom."""

from __future__ import annotations

from imgui_bundle import imgui

from ..fields.colors import swatch
from ..theme.style import u32
from .brush import TEXT
from .geometry import Rect
from .layout import FieldText, NodeRow
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
            _number(sketch, rect, row.label, row.shown[0], color)
        case "bool":
            _switch(sketch, rect, row.label, bool(row.plain))
        case "color":
            _swatch(sketch, rect, row)
        case "vector" if len(row.shown) <= MOST_PARTS:
            paint_label(sketch, rect, row.label, len(row.shown))
            for one, part in zip(split(rect, len(row.shown))[1], row.shown, strict=True):
                _number(sketch, one, "", part, color)
        case _:
            _words(sketch, rect, row, color)


MOST_PARTS = 3
"""Numbers of a vector that fit on a node."""


def split(rect: Rect, count: int) -> tuple[float, list[Rect]]:
    """Where the fields of the numbers of a vector begin, and the fields: the label has what is left of them."""
    room = (rect[2] - rect[0]) * (0.64 if count < 3 else 0.74)
    left, each = rect[2] - room, (room - GAP * (count - 1)) / count
    return left, [(left + (each + GAP) * at, rect[1], left + (each + GAP) * at + each, rect[3]) for at in range(count)]


def paint_label(sketch: Sketch, rect: Rect, label: str, count: int) -> None:
    """The name of a vector beside its fields."""
    room = split(rect, count)[0] - rect[0] - GAP * 2
    sketch.text(rect[0] + 4.0, (rect[1] + rect[3]) / 2, sketch.ink.dim, sketch.short(label, room))


def _number(sketch: Sketch, rect: Rect, label: str, shown: FieldText, color: int) -> None:
    sketch.fill(rect, sketch.ink.field, ROUND)
    if shown.part and shown.part[1] > shown.part[0]:
        across = rect[2] - rect[0]
        left, right = rect[0] + across * shown.part[0], rect[0] + across * shown.part[1]
        flags = (_LEFT if shown.part[0] <= 0.0 else 0) | (_RIGHT if right > rect[2] - ROUND else 0)
        sketch.fill((left, rect[1], max(right, left + 1.0), rect[3]), sketch.ink.fill, ROUND, flags=flags or _NONE)
    y, pad = (rect[1] + rect[3]) / 2, PAD if label else 3.0
    text = sketch.short(shown.text, rect[2] - rect[0] - pad, TEXT)
    width = sketch.width(text)
    if not label:
        sketch.text((rect[0] + rect[2] - width) / 2, y, color, text)
        return
    sketch.text(rect[2] - width - pad, y, color, text)
    sketch.text(rect[0] + PAD, y, sketch.ink.dim, sketch.short(label, rect[2] - rect[0] - width - PAD * 3))


def _words(sketch: Sketch, rect: Rect, row: NodeRow, color: int) -> None:
    """A name and a word: choices with an arrow, files, and what only the inspector can edit."""
    sketch.fill(rect, sketch.ink.field, ROUND)
    y, right = (rect[1] + rect[3]) / 2, rect[2] - PAD
    kind = row.value.type if row.value else ""
    if kind == "choice":
        x, size = right - 4.0, 2.9
        sketch.triangle((x - 4, y - size / 2), (x + 4, y - size / 2), (x, y + size), sketch.ink.dim)
        right -= 14.0
    text = row.shown[0].text
    if not text or kind in ("vector", "matrix", "curve", "ramp"):
        text, color = {"path": "no file", "text": ""}.get(kind, "in the inspector"), sketch.ink.faint
    room = right - rect[0] - PAD
    label = sketch.short(row.label, room * 0.5)
    width = sketch.width(label)
    sketch.text(rect[0] + PAD, y, sketch.ink.dim, label)
    sketch.right(right, y, color, sketch.short(text, room - width - PAD))


def _switch(sketch: Sketch, rect: Rect, label: str, on: bool) -> None:
    height = (rect[3] - rect[1]) * 0.62
    long, y = height * 1.8, (rect[1] + rect[3]) / 2
    track = (rect[2] - long, y - height / 2, rect[2], y + height / 2)
    sketch.text(rect[0], y, sketch.ink.dim, sketch.short(label, rect[2] - rect[0] - long - PAD))
    sketch.fill(track, sketch.ink.switch_on if on else sketch.ink.switch, height / 2)
    knob = track[0] + (long - height / 2 if on else height / 2)
    sketch.circle(knob, y, height * 0.36, sketch.ink.on_accent if on else sketch.ink.text)


def _swatch(sketch: Sketch, rect: Rect, row: NodeRow) -> None:
    """The color, with its name where that can be read best."""
    if not isinstance(row.plain, tuple):
        return
    red, green, blue = swatch((row.plain[0], row.plain[1], row.plain[2]))
    left = rect[2] - (rect[2] - rect[0]) * 0.5
    sketch.text(rect[0] + 4.0, (rect[1] + rect[3]) / 2, sketch.ink.dim, sketch.short(row.label, left - rect[0] - 8.0))
    sketch.fill((left, *rect[1:]), u32((red, green, blue)), ROUND)
    sketch.frame((left, *rect[1:]), sketch.ink.outline, ROUND)
