"""Fields for numbers: drag sideways, click to type, Ctrl and wheel to step. Also rows and grids of them."""

from __future__ import annotations

from halation.nodes import Plain, Value
from imgui_bundle import imgui
from msgspec import structs
from msgspec.structs import replace

from ..theme.style import mix, u32, ui_scale
from ..toolkit.fields import background
from ..toolkit.places import Rect, place
from ..toolkit.words import write
from .fields import Edit, Fields
from .numbers import Drag, bar, clamp_number, drop_digit, edit_text, find_step, format_number, unit_suffix
from .text_entry import text_entry

THRESHOLD = 3.0
"""Pixels of mouse movement that turn a click into a drag."""

AXES = ("x", "y", "z", "w")
NO_VALUE = "—"


def number_field(
    fields: Fields,
    id: str,
    value: Plain,
    declaration: Value,
    width: float,
    *,
    label: str = "",
    mixed: bool = False,
    suffix: str | None = None,
    plain: bool = False,
) -> Edit | None:
    """Draw a number field. Shift drags finely, Ctrl in round steps; Escape restores the old number.

    `suffix` stands behind it instead of the declared unit. A `plain` one is not filled up to its value.
    """
    assert isinstance(value, int | float)
    fields.order.append(id)
    if fields.next_field == id:
        fields.type_in(id, edit_text(value), value, declaration)
    if fields.typing and fields.typing.id == id:
        return text_entry(fields, width)
    rect = place(width)
    clicked = imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1]))
    hovered, active = imgui.is_item_hovered(), imgui.is_item_active()
    if hovered or active:
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    edit = _drag(fields, id, value, declaration, rect[2] - rect[0], active)
    if edit is None and clicked and fields.pressed == id:
        fields.type_in(id, edit_text(value), value, declaration)
    if edit is None and hovered:
        edit = _turn_wheel(fields, id, value, declaration)
    if not active and fields.pressed == id:
        fields.pressed = ""
    current = edit.value if edit else value
    assert isinstance(current, int | float)
    unit = unit_suffix(declaration.unit) if suffix is None else suffix
    _draw(fields, rect, current, declaration, unit, label, mixed and edit is None, hovered, active, plain)
    return edit


def _drag(fields: Fields, id: str, value: float, declaration: Value, width: float, active: bool) -> Edit | None:
    """The number during a drag, or the old one if Escape cancels it."""
    if imgui.is_item_activated():
        fields.pressed = id
    if fields.drag_id == id and fields.drag and not active:
        start, fields.drag, fields.drag_id = fields.drag.start, None, ""
        return Edit(clamp_number(start, declaration), fields.merge) if imgui.is_key_pressed(imgui.Key.escape) else None
    if not active or (fields.pressed != id and fields.drag_id != id):
        return None
    io = imgui.get_io()
    if fields.drag_id != id:
        if not imgui.is_mouse_dragging(imgui.MouseButton_.left, THRESHOLD * ui_scale()):
            return None
        fields.drag, fields.drag_id, fields.pressed = Drag(value), id, ""
        fields.start_gesture()
    if fields.drag is None:
        return None
    fields.drag = fields.drag.move(io.mouse_delta.x, width, declaration, fine=io.key_shift)
    number = fields.drag.number(declaration, fine=io.key_shift, snap=io.key_ctrl)
    return Edit(number, fields.merge) if number != value else None


def _turn_wheel(fields: Fields, id: str, value: float, declaration: Value) -> Edit | None:
    io = imgui.get_io()
    if not io.key_ctrl or not io.mouse_wheel:
        return None
    size = find_step(declaration) * (0.1 if io.key_shift and declaration.type != "int" else 1.0)
    number = round((value + io.mouse_wheel * size) / size) * size
    low, high = min(declaration.low, value), max(declaration.high, value)
    return Edit(clamp_number(min(max(round(number, 9), low), high), declaration), f"wheel {id}")


def _draw(
    fields: Fields,
    rect: Rect,
    value: float,
    declaration: Value,
    unit: str,
    label: str,
    mixed: bool,
    hovered: bool,
    active: bool,
    plain: bool,
) -> None:
    """Draw the field while nobody types in it. Where room is short, the unit goes first, then digits after the point:
    the number itself must stay readable.
    """
    palette, pad = fields.palette, imgui.get_style().frame_padding.x * 0.75
    background(palette, rect, hovered=hovered, active=active)
    lines, rounding = imgui.get_window_draw_list(), imgui.get_style().frame_rounding
    filled = None if mixed or plain else bar(value, declaration)
    if filled and filled[1] > filled[0]:
        left, right = (rect[0] + (rect[2] - rect[0]) * part for part in filled)
        color = mix(palette.fill, palette.accent, 0.5 if active else 0.25 if hovered else 0.0)
        lines.push_clip_rect((left, rect[1]), (max(right, left + 1.0), rect[3]), True)
        lines.add_rect_filled(rect[:2], rect[2:], u32(color), rounding)
        lines.pop_clip_rect()
    inner = (rect[0] + pad, rect[1], rect[2] - pad, rect[3])
    text, suffix = NO_VALUE if mixed else format_number(value, declaration), "" if mixed else unit
    room = inner[2] - inner[0]
    unit_width = imgui.calc_text_size(" " + suffix).x if suffix else 0.0
    text_width = imgui.calc_text_size(text).x
    if text_width + unit_width > room:
        suffix, unit_width = "", 0.0
    while text_width > room and (shorter := drop_digit(text)) != text:
        text, text_width = shorter, imgui.calc_text_size(shorter).x
    if label:
        write((inner[0], rect[1], max(inner[2] - text_width - unit_width - pad, inner[0]), rect[3]), label, palette.dim)
        left = inner[2] - text_width - unit_width
    else:
        left = (inner[0] + inner[2] - text_width - unit_width) * 0.5
    left = max(left, inner[0])
    write((left, rect[1], inner[2], rect[3]), text, palette.text)
    if suffix:
        write((left + text_width, rect[1], inner[2] + pad, rect[3]), " " + suffix, palette.dim)


def vector_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """Draw two to four numbers in a row."""
    assert isinstance(value, tuple)
    return row_of_numbers(fields, id, value, declaration, width, AXES[: len(value)] if not label else ("",) * 4, mixed)


def row_of_numbers(
    fields: Fields,
    id: str,
    value: tuple[float, ...],
    declaration: Value,
    width: float,
    names: tuple[str, ...],
    mixed: bool = False,
    first: int = 0,
    keep_type: bool = False,
    plain: bool = False,
) -> Edit | None:
    """Draw numbers side by side, with names in them if there is room. Floats unless `keep_type`."""
    gap = imgui.get_style().item_inner_spacing.x * 0.5
    each = (width - gap * (len(names) - 1)) / len(names)
    part, row_edit = declaration if keep_type else structs.replace(declaration, type="float"), None
    for index, name in enumerate(names, first):
        if index > first:
            imgui.same_line(0.0, gap)
        named = name if each > imgui.get_font_size() * 4.2 else ""

        def whole(edit: Edit, at: int = index) -> Edit | None:
            if not isinstance(edit.value, int | float):
                return None
            return replace(edit, value=(*value[:at], edit.value, *value[at + 1 :]))

        fields.part(f"{id}#{index}", id, whole)
        edit = number_field(fields, f"{id}#{index}", value[index], part, each, label=named, mixed=mixed, plain=plain)
        row_edit = whole(edit) if edit else row_edit
    return row_edit


def matrix_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """Draw nine numbers in three rows."""
    assert isinstance(value, tuple)
    matrix_edit = None
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, imgui.get_style().item_inner_spacing.x * 0.5))
    for row in range(3):
        matrix_edit = row_of_numbers(fields, id, value, declaration, width, ("",) * 3, mixed, row * 3) or matrix_edit
    imgui.pop_style_var()
    return matrix_edit
