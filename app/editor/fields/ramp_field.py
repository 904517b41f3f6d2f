"""The field for a color ramp: drag stops, click to add one, right click or drag it down to remove it."""

from __future__ import annotations

from itertools import pairwise

from halation.nodes import Plain, Value
from imgui_bundle import imgui
from msgspec.structs import replace

from ...language.translation import translate
from ..theme.style import u32, ui_scale
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import Rect, place
from .color_field import color_field
from .colors import swatch
from .fields import Edit, Fields
from .number_field import number_field
from .points import RAMPS, find_nearest, insert_point, invert, move_point, ramp_color, remove_point, split_points

BAND, HANDLES = 1.6, 0.9
"""The heights of the colors and of the handles below them, in text lines."""

_OUT, _REACH, _PIECES = 40.0, 8.0, 64
_PLACE = Value("t", "float", 0.0, low=0.0, high=1.0, minimum=0.0, maximum=1.0)


def ramp_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """Draw the ramp with a handle for each stop; below it the selected stop and presets."""
    assert isinstance(value, tuple)
    line = imgui.get_font_size()
    rect = place(width, line * (BAND + HANDLES))
    imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1]))
    active, hovered = imgui.is_item_active(), imgui.is_item_hovered()
    edit = _press(fields, id, value, rect, hovered) or _drag(fields, id, value, rect, active)
    numbers = edit.value if edit and isinstance(edit.value, tuple) else value
    _draw(fields, id, numbers, rect)
    return _draw_below(fields, id, numbers, declaration, width) or edit


def _sides(rect: Rect) -> tuple[float, float]:
    pad = 6.0 * ui_scale()
    return rect[0] + pad, rect[2] - pad


def _mouse(rect: Rect) -> float:
    left, right = _sides(rect)
    return min(max((imgui.get_mouse_pos().x - left) / (right - left), 0.0), 1.0)


def _press(fields: Fields, id: str, value: tuple[float, ...], rect: Rect, hovered: bool) -> Edit | None:
    if not hovered:
        return None
    t, (left, right) = _mouse(rect), _sides(rect)
    near = find_nearest(value, 5, t, None, (_REACH * ui_scale() / (right - left), 1.0))
    if imgui.is_mouse_clicked(imgui.MouseButton_.right):
        return Edit(remove_point(value, 5, near)) if near >= 0 and len(value) > 10 else None
    if not imgui.is_item_activated():
        return None
    merge = fields.start_gesture()
    fields.drag_id, fields.before = id, value
    if near >= 0:
        fields.point = (id, near)
        return None
    numbers, index = insert_point(value, 5, (t, *ramp_color(value, t)))
    fields.point = (id, index)
    return Edit(numbers, merge) if numbers != value else None


def _drag(fields: Fields, id: str, value: tuple[float, ...], rect: Rect, active: bool) -> Edit | None:
    if fields.drag_id != id:
        return None
    if not active:
        fields.drag_id = ""
        return Edit(fields.before, fields.merge) if imgui.is_key_pressed(imgui.Key.escape) else None
    index, mouse = fields.point[1], imgui.get_mouse_pos()
    if not imgui.is_mouse_dragging(imgui.MouseButton_.left, 2.0 * ui_scale()) or not 0 <= index < len(value) // 5:
        return None
    out = _OUT * ui_scale()
    if len(value) > 10 and not rect[1] - out < mouse.y < rect[3] + out:
        fields.drag_id, fields.point = "", ("", -1)
        return Edit(remove_point(value, 5, index), fields.merge)
    numbers = move_point(value, 5, index, (_mouse(rect), *value[index * 5 + 1 : index * 5 + 5]))
    return Edit(numbers, fields.merge) if numbers != value else None


def _draw(fields: Fields, id: str, value: tuple[float, ...], rect: Rect) -> None:
    palette, lines, scale = fields.palette, imgui.get_window_draw_list(), ui_scale()
    left, right = _sides(rect)
    bottom = rect[1] + imgui.get_font_size() * BAND
    places = sorted({*(index / _PIECES for index in range(_PIECES + 1)), *value[0::5]})
    for start, end in pairwise(places):
        colors = [u32(swatch(ramp_color(value, t))) for t in (start, end - 1e-9)]
        low, high = (left + t * (right - left) for t in (start, end))
        lines.add_rect_filled_multi_color((low, rect[1]), (high, bottom), colors[0], colors[1], colors[1], colors[0])
    lines.add_rect((left, rect[1]), (right, bottom), u32(palette.border))
    size = imgui.get_font_size() * 0.34
    for index, stop in enumerate(split_points(value, 5)):
        x, chosen = left + stop[0] * (right - left), fields.point == (id, index)
        edge = u32(palette.accent if chosen else palette.dim)
        lines.add_triangle_filled((x, bottom - 2 * scale), (x - size, bottom + size), (x + size, bottom + size), edge)
        box = (x - size, bottom + size), (x + size, bottom + 2.4 * size)
        lines.add_rect_filled(*box, u32(swatch((stop[1], stop[2], stop[3]))))
        lines.add_rect(*box, edge, 0.0, (2.0 if chosen else 1.0) * scale)


def _draw_below(fields: Fields, id: str, value: tuple[float, ...], declaration: Value, width: float) -> Edit | None:
    ramp_edit = None
    gap = imgui.get_style().item_inner_spacing.x
    side = imgui.get_font_size() * 4.5
    index = fields.point[1] if fields.point[0] == id else -1
    chosen = 0 <= index < len(value) // 5
    stop = value[index * 5 : index * 5 + 5]

    def with_place(edit: Edit) -> Edit | None:
        place = edit.value
        return (
            replace(edit, value=move_point(value, 5, index, (float(place), *stop[1:])))
            if isinstance(place, int | float)
            else None
        )

    def with_color(edit: Edit) -> Edit | None:
        color = edit.value
        return replace(edit, value=move_point(value, 5, index, (stop[0], *color))) if isinstance(color, tuple) else None

    if chosen:
        fields.part(f"{id} place", id, with_place)
        fields.part(f"{id} color", id, with_color)
        edit = number_field(fields, f"{id} place", stop[0], _PLACE, width - side - gap, label="at")
        ramp_edit = with_place(edit) if edit else None
        imgui.same_line(0.0, gap)
    if imgui.button(make_label(translate("Presets"), f"{id}"), (side if chosen else width, 0.0)):
        imgui.open_popup(f"presets {id}")
    if chosen:
        edit = color_field(fields, f"{id} color", stop[1:], _PLACE, width, eyedropper=False)
        ramp_edit = with_color(edit) if edit else ramp_edit
    if imgui.begin_popup(f"presets {id}"):
        for name, preset in RAMPS.items():
            if imgui.menu_item(translate_label(name), "", False)[0]:
                ramp_edit = Edit(preset)
        imgui.separator()
        if imgui.menu_item(translate_label("Reverse"), "", False)[0]:
            ramp_edit = Edit(invert(value, 5))
        imgui.end_popup()
    return ramp_edit
