"""The field for a curve: drag points, click to add one, right click or drag it out to remove it."""

from __future__ import annotations

import math

from halation.nodes import Plain, Value
from imgui_bundle import imgui
from msgspec import structs
from msgspec.structs import replace

from ...language.translation import translate
from ..theme.style import mix, u32, ui_scale
from ..toolkit.fields import background
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import Rect, place
from .fields import Edit, Fields
from .number_field import row_of_numbers
from .points import (
    CURVES,
    curve_line,
    find_nearest,
    insert_point,
    invert,
    move_point,
    remove_point,
    scale_curve,
    split_points,
)

HEIGHT = 8.0
"""The height of the plot, in heights of a text line."""

_REACH, _OUT = 9.0, 40.0
"""Pixels: how close a click must be to a point, and how far outside of the plot a point is removed."""


def curve_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """Draw a plot of the curve; below it the numbers of the selected point, and presets."""
    assert isinstance(value, tuple)
    rect = place(width, imgui.get_font_size() * HEIGHT)
    imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1]))
    active, hovered = imgui.is_item_active(), imgui.is_item_hovered()
    low, high = _range(value, declaration)
    area = _Area(rect, low, high)
    edit = _press(fields, id, value, area, hovered) or _drag(fields, id, value, declaration, area, active)
    numbers = edit.value if edit and isinstance(edit.value, tuple) else value
    _draw(fields, id, numbers, area, hovered)
    return _draw_below(fields, id, numbers, declaration, width) or edit


class _Area:
    """The area of the plot on the screen: x from 0 to 1, y from low to high."""

    def __init__(self, rect: Rect, low: float, high: float) -> None:
        pad = 6.0 * ui_scale()
        self.rect, self.low, self.high = rect, low, high
        self.left, self.top, self.right, self.bottom = rect[0] + pad, rect[1] + pad, rect[2] - pad, rect[3] - pad

    def at(self, x: float, y: float) -> tuple[float, float]:
        part = (y - self.low) / (self.high - self.low)
        return self.left + x * (self.right - self.left), self.bottom - part * (self.bottom - self.top)

    def mouse(self) -> tuple[float, float]:
        mouse = imgui.get_mouse_pos()
        x = (mouse.x - self.left) / (self.right - self.left)
        return x, self.low + (self.bottom - mouse.y) / (self.bottom - self.top) * (self.high - self.low)

    def reach(self) -> tuple[float, float]:
        reach = _REACH * ui_scale()
        return reach / (self.right - self.left), reach / (self.bottom - self.top) * (self.high - self.low)

    def outside(self) -> bool:
        mouse, out = imgui.get_mouse_pos(), _OUT * ui_scale()
        return mouse.y < self.rect[1] - out or mouse.y > self.rect[3] + out


def _range(value: tuple[float, ...], declaration: Value) -> tuple[float, float]:
    """The visible range of y: the soft range, extended by points beyond it."""
    low, high = (declaration.low, declaration.high) if math.isfinite(declaration.low) else (0.0, 1.0)
    heights = value[1::2]
    return min(low, *heights), max(high, *heights)


def _press(fields: Fields, id: str, value: tuple[float, ...], area: _Area, hovered: bool) -> Edit | None:
    if not hovered:
        return None
    x, y = area.mouse()
    if imgui.is_mouse_clicked(imgui.MouseButton_.right):
        index = find_nearest(value, 2, x, y, area.reach())
        return Edit(remove_point(value, 2, index)) if index >= 0 and len(value) > 4 else None
    if not imgui.is_item_activated():
        return None
    merge = fields.start_gesture()
    fields.drag_id, fields.before = id, value
    index = find_nearest(value, 2, x, y, area.reach())
    if index >= 0:
        fields.point = (id, index)
        return None
    numbers, index = insert_point(value, 2, (min(max(x, 0.0), 1.0), y))
    fields.point = (id, index)
    return Edit(numbers, merge) if numbers != value else None


def _drag(
    fields: Fields, id: str, value: tuple[float, ...], declaration: Value, area: _Area, active: bool
) -> Edit | None:
    if fields.drag_id != id:
        return None
    if not active:
        fields.drag_id = ""
        return Edit(fields.before, fields.merge) if imgui.is_key_pressed(imgui.Key.escape) else None
    index = fields.point[1]
    if not imgui.is_mouse_dragging(imgui.MouseButton_.left, 2.0 * ui_scale()) or not 0 <= index < len(value) // 2:
        return None
    if area.outside() and len(value) > 4 and 0 < index < len(value) // 2 - 1:
        fields.drag_id, fields.point = "", ("", -1)
        return Edit(remove_point(value, 2, index), fields.merge)
    x, y = area.mouse()
    y = min(max(y, area.low, declaration.minimum), area.high, declaration.maximum)
    numbers = move_point(value, 2, index, (x, y))
    return Edit(numbers, fields.merge) if numbers != value else None


def _draw(fields: Fields, id: str, value: tuple[float, ...], area: _Area, hovered: bool) -> None:
    palette, lines, scale = fields.palette, imgui.get_window_draw_list(), ui_scale()
    background(palette, area.rect, hovered=hovered)
    grid = u32(mix(palette.field, palette.dim, 0.3))
    for part in range(5):
        level = area.low + (area.high - area.low) * part / 4
        lines.add_line(area.at(part / 4, area.low), area.at(part / 4, area.high), grid)
        lines.add_line(area.at(0.0, level), area.at(1.0, level), grid)
    lines.push_clip_rect(area.rect[:2], area.rect[2:], True)
    line_points = [area.at(x, y) for x, y in curve_line(value, 64)]
    lines.add_polyline([imgui.ImVec2(*point) for point in line_points], u32(palette.accent), 2.0 * scale, 0)
    for index, point in enumerate(split_points(value, 2)):
        chosen = fields.point == (id, index)
        lines.add_circle_filled(area.at(*point), (5.0 if chosen else 4.0) * scale, u32(palette.text))
        if chosen:
            lines.add_circle(area.at(*point), 7.0 * scale, u32(palette.accent), thickness=1.5 * scale)
    lines.pop_clip_rect()


def _draw_below(fields: Fields, id: str, value: tuple[float, ...], declaration: Value, width: float) -> Edit | None:
    """Draw the numbers of the selected point and the presets."""
    curve_edit = None
    gap, side = imgui.get_style().item_inner_spacing.x, imgui.get_font_size() * 4.5
    index = fields.point[1] if fields.point[0] == id else -1
    if 0 <= index < len(value) // 2:
        point = value[2 * index : 2 * index + 2]
        part = structs.replace(declaration, low=min(0.0, declaration.low), high=max(1.0, declaration.high))

        def whole(edit: Edit) -> Edit | None:
            return (
                replace(edit, value=move_point(value, 2, index, edit.value)) if isinstance(edit.value, tuple) else None
            )

        fields.part(f"{id} point", id, whole)
        edit = row_of_numbers(fields, f"{id} point", point, part, width - side - gap, ("x", "y"))
        curve_edit = whole(edit) if edit else None
        imgui.same_line(0.0, gap)
    if imgui.button(make_label(translate("Presets"), f"{id}"), (side if 0 <= index < len(value) // 2 else width, 0.0)):
        imgui.open_popup(f"presets {id}")
    if imgui.begin_popup(f"presets {id}"):
        low, high = (declaration.low, declaration.high) if math.isfinite(declaration.low) else (0.0, 1.0)
        for name, preset in CURVES.items():
            if imgui.menu_item(translate_label(name), "", False)[0]:
                curve_edit = Edit(scale_curve(preset, low, high))
        imgui.separator()
        if imgui.menu_item(translate_label("Invert"), "", False)[0]:
            curve_edit = Edit(invert(value, 2, low, high))
        imgui.end_popup()
    return curve_edit
