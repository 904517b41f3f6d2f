"""Values on nodes as they look while nobody touches them: like the fields of the inspector, at any zoom."""

from __future__ import annotations

from ..inspector.colors import swatch
from ..theme.style import u32
from .brush import TEXT, Brush
from .geometry import Rect
from .layout import Row, Shown
from .scene import Box

ROUND = 4.0
PAD = 6.0
GAP = 3.0


def paint_field(brush: Brush, box: Box, row: Row, muted: bool) -> None:
    """Draw the field of a value of a node."""
    value, place = row.value, row.field
    if value is None or place is None:
        return
    rect = box.x + place[0], box.y + place[1], box.x + place[2], box.y + place[3]
    color = brush.ink.dim if muted else brush.ink.text
    match value.type:
        case "float" | "int":
            _number(brush, rect, row.label, row.shown[0], color)
        case "bool":
            _switch(brush, rect, row.label, bool(row.plain))
        case "color":
            _swatch(brush, rect, row)
        case "vector" if len(row.shown) <= MOST_PARTS:
            paint_label(brush, rect, row.label, len(row.shown))
            for one, part in zip(split(rect, len(row.shown))[1], row.shown, strict=True):
                _number(brush, one, "", part, color)
        case _:
            _words(brush, rect, row, color)


MOST_PARTS = 3
"""Numbers of a vector that fit on a node."""


def split(rect: Rect, count: int) -> tuple[float, list[Rect]]:
    """Where the fields of the numbers of a vector begin, and the fields: the label has what is left of them."""
    room = (rect[2] - rect[0]) * (0.64 if count < 3 else 0.74)
    left, each = rect[2] - room, (room - GAP * (count - 1)) / count
    return left, [
        (left + (each + GAP) * at, rect[1], left + (each + GAP) * at + each, rect[3]) for at in range(count)
    ]


def paint_label(brush: Brush, rect: Rect, label: str, count: int) -> None:
    """The name of a vector beside its fields."""
    room = split(rect, count)[0] - rect[0] - GAP * 2
    brush.text(rect[0] + 4.0, (rect[1] + rect[3]) / 2, brush.ink.dim, brush.short(label, room))


def _number(brush: Brush, rect: Rect, label: str, shown: Shown, color: int) -> None:
    brush.fill(rect, brush.ink.field, ROUND)
    if shown.part and shown.part[1] > shown.part[0]:
        across = rect[2] - rect[0]
        left, right = rect[0] + across * shown.part[0], rect[0] + across * shown.part[1]
        low, high = brush.corners((left, rect[1], max(right, left + 1.0), rect[3]))
        brush.draw.push_clip_rect(low, high, True)
        brush.fill(rect, brush.ink.fill, ROUND)
        brush.draw.pop_clip_rect()
    y, pad = (rect[1] + rect[3]) / 2, PAD if label else 3.0
    text = brush.short(shown.text, rect[2] - rect[0] - pad, TEXT)
    width = brush.width(text)
    if not label:
        brush.text((rect[0] + rect[2] - width) / 2, y, color, text)
        return
    brush.text(rect[2] - width - pad, y, color, text)
    brush.text(rect[0] + PAD, y, brush.ink.dim, brush.short(label, rect[2] - rect[0] - width - PAD * 3))


def _words(brush: Brush, rect: Rect, row: Row, color: int) -> None:
    """A name and a word: choices with an arrow, files, and what only the inspector can edit."""
    brush.fill(rect, brush.ink.field, ROUND)
    y, right = (rect[1] + rect[3]) / 2, rect[2] - PAD
    kind = row.value.type if row.value else ""
    if kind == "choice":
        x, size = right - 4.0, 2.9
        to = brush.to.to_screen
        brush.draw.add_triangle_filled(
            to(x - 4, y - size / 2), to(x + 4, y - size / 2), to(x, y + size), brush.ink.dim
        )
        right -= 14.0
    text = row.shown[0].text
    if not text or kind in ("vector", "matrix", "curve", "ramp"):
        text, color = {"path": "no file", "text": ""}.get(kind, "in the inspector"), brush.ink.faint
    room = right - rect[0] - PAD
    label = brush.short(row.label, room * 0.5)
    width = brush.width(label)
    brush.text(rect[0] + PAD, y, brush.ink.dim, label)
    brush.right(right, y, color, brush.short(text, room - width - PAD))


def _switch(brush: Brush, rect: Rect, label: str, on: bool) -> None:
    height = (rect[3] - rect[1]) * 0.62
    long, y = height * 1.8, (rect[1] + rect[3]) / 2
    track = (rect[2] - long, y - height / 2, rect[2], y + height / 2)
    brush.text(rect[0], y, brush.ink.dim, brush.short(label, rect[2] - rect[0] - long - PAD))
    brush.fill(track, brush.ink.switch_on if on else brush.ink.switch, height / 2)
    knob = track[0] + (long - height / 2 if on else height / 2)
    center = brush.to.to_screen(knob, y)
    brush.draw.add_circle_filled(center, height * 0.36 * brush.to.scale, brush.ink.on_accent if on else brush.ink.text)


def _swatch(brush: Brush, rect: Rect, row: Row) -> None:
    """The color, with its name where that can be read best."""
    if not isinstance(row.plain, tuple):
        return
    red, green, blue = swatch((row.plain[0], row.plain[1], row.plain[2]))
    left = rect[2] - (rect[2] - rect[0]) * 0.5
    brush.text(rect[0] + 4.0, (rect[1] + rect[3]) / 2, brush.ink.dim, brush.short(row.label, left - rect[0] - 8.0))
    brush.fill((left, *rect[1:]), u32((red, green, blue)), ROUND)
    brush.frame((left, *rect[1:]), brush.ink.outline, ROUND)
