"""A color wheel: hue and strength of a balance on a disk, and its level below."""

from __future__ import annotations

import colorsys
import math

from halation.nodes import Value
from imgui_bundle import imgui
from msgspec.structs import replace

from ...language.translation import mark, translate
from ..shared.declared_words import name_value
from ..theme.style import mix, u32, ui_scale
from ..toolkit.places import Rect, item_rect, place
from ..toolkit.words import tip, write
from .balance import join_balance, split_balance
from .colors import RGBA
from .fields import Edit, Fields
from .number_field import number_field

_SEGMENTS = 36
"""Pieces of the rim: at 10 degrees each, the steps between their hues cannot be seen on a rim of 5 pixels."""

_PACE, _FINE = 0.5, 0.1
"""How far the point moves for a move of the mouse, and with Shift: a balance is a matter of small amounts."""

_HINT = mark("Drag: balance, with Shift finely. Double click: back to gray. Escape cancels.")


def wheel_field(fields: Fields, owner: str, color: RGBA, declaration: Value, width: float) -> Edit | None:
    """Draw the wheel of a color with its name, and a number for the level of its gray; returns the edit.

    The disk keeps the level and moves the color away from gray; the number keeps the color and moves the level.
    `owner` is the field of the color itself.
    """
    id = f"wheel {owner}"
    line = imgui.get_text_line_height()
    level, x, y = split_balance(color)
    imgui.begin_group()
    title = place(width, line)
    write(title, name_value(declaration.label or declaration.name), fields.palette.dim, align=0.5)
    imgui.dummy((width, line))
    rect = place(width, width)
    imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)  # arrows have nothing to press; the numbers are in reach
    imgui.invisible_button(f"##{id}", (width, width))
    imgui.pop_item_flag()
    hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
    edit = _drag(fields, id, color, declaration.wheel, width, hovered, active)
    shown = split_balance(edit.value)[1:] if edit and isinstance(edit.value, tuple) else (x, y)  # type: ignore[arg-type]
    _draw(fields, rect, (shown[0] / declaration.wheel, shown[1] / declaration.wheel), active or hovered)
    fields.places[id] = rect
    if not active:
        tip(f"{translate(declaration.doc)}\n{translate(_HINT)}")

    def from_level(typed: Edit) -> Edit | None:
        number = typed.value
        return replace(typed, value=join_balance(number, x, y, color[3])) if isinstance(number, int | float) else None

    fields.part(f"{id} level", owner, from_level)
    gray = declaration.default[0] if isinstance(declaration.default, tuple) else 0.0
    span = 2.0 * declaration.wheel
    ruler = Value("level", "float", gray, low=float(gray) - span, high=float(gray) + span, unit="ratio")
    typed = number_field(fields, f"{id} level", level, ruler, width, plain=True)
    fields.places[f"{id} level"] = item_rect()
    imgui.end_group()
    return edit or (from_level(typed) if typed else None)


def _drag(fields: Fields, id: str, color: RGBA, reach: float, width: float, hovered: bool, active: bool) -> Edit | None:
    """The color during a drag of its point, or the old one if Escape cancels the drag."""
    level, x, y = split_balance(color)
    if hovered and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        return Edit(join_balance(level, 0.0, 0.0, color[3]), fields.start_gesture())
    if imgui.is_item_activated():
        fields.start_gesture()
        fields.drag_id, fields.before = id, color
    if fields.drag_id != id:
        return None
    if not active:
        fields.drag_id = ""
        return Edit(fields.before, fields.merge) if imgui.is_key_pressed(imgui.Key.escape) else None
    io = imgui.get_io()
    if io.mouse_delta.x == io.mouse_delta.y == 0.0:
        return None
    step = (_FINE if io.key_shift else _PACE) * reach / (width / 2.0)
    point = x + io.mouse_delta.x * step, y + io.mouse_delta.y * step
    far = max(math.hypot(*point) / max(reach, math.hypot(x, y)), 1.0)  # what is beyond the rim may stay there
    return Edit(join_balance(level, point[0] / far, point[1] / far, color[3]), fields.merge)


def _draw(fields: Fields, rect: Rect, at: tuple[float, float], lit: bool) -> None:
    """Draw the disk and its point; `at` is in parts of the radius."""
    lines, palette, scale = imgui.get_window_draw_list(), fields.palette, ui_scale()
    middle = (rect[0] + rect[2]) / 2.0, (rect[1] + rect[3]) / 2.0
    rim = 5.0 * scale
    radius = (rect[2] - rect[0]) / 2.0 - rim
    lines.add_circle_filled(middle, radius + rim / 2.0, u32(mix(palette.field, palette.hover, 0.35 if lit else 0.0)))
    step = 2.0 * math.pi / _SEGMENTS
    for index in range(_SEGMENTS):
        hue = colorsys.hsv_to_rgb(index / _SEGMENTS, 0.75, 0.9)
        lines.path_arc_to(middle, radius + rim / 2.0, (index - 0.5) * step, (index + 0.55) * step, 4)
        lines.path_stroke(u32(hue, 1.0 if lit else 0.8), rim, 0)
    faint = u32(palette.dim, 0.4)
    lines.add_line((middle[0] - radius, middle[1]), (middle[0] + radius, middle[1]), faint, scale)
    lines.add_line((middle[0], middle[1] - radius), (middle[0], middle[1] + radius), faint, scale)
    away = max(math.hypot(*at), 1.0)
    dot = middle[0] + at[0] / away * radius, middle[1] + at[1] / away * radius
    lines.add_circle_filled(dot, 5.0 * scale, u32(palette.text))
    lines.add_circle(dot, 5.5 * scale, u32(palette.window), 0, 1.5 * scale)
