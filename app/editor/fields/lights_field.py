"""The field for a list of lights: one row for each, and buttons to add, duplicate, move and remove."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from halation.nodes import MAX_LIGHTS, Light, LightKind, Plain, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import structs

from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.buttons import dropdown, quiet_button
from ..toolkit.places import Rect, item_rect, place
from ..toolkit.words import tip, write
from .colors import swatch
from .fields import Edit, Fields
from .lights import (
    KINDS,
    Numbers,
    count_lights,
    describe_count,
    describe_intensity,
    insert_light,
    light_at,
    light_title,
    make_light,
    move_light,
    remove_light,
    replace_light,
)
from .number_field import NO_VALUE

ICONS = (icons.ICON_FA_LIGHTBULB, icons.ICON_FA_BULLSEYE, icons.ICON_FA_SUN, icons.ICON_FA_CIRCLE)
"""The icons of the kinds of light, by their number."""

ROWS = 8
"""The most visible rows; longer lists scroll."""

_MENU = "light menu"
_EITHER = int(imgui.ButtonFlags_.mouse_button_left) | int(imgui.ButtonFlags_.mouse_button_right)


def lights_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """Draw the list and its buttons. The properties of the selected light have their own rows."""
    assert isinstance(value, tuple)
    imgui.push_style_color(imgui.Col_.child_bg, vec4(fields.palette.field))
    imgui.begin_child(f"##{id} lights", (width, _list_height(value)), 0, int(imgui.WindowFlags_.no_nav))
    imgui.pop_style_color()
    edit = _draw_list(fields, id, value)
    edit = _draw_menu(fields, id, value) or edit
    imgui.end_child()
    return _draw_buttons(fields, id, value, width, NO_VALUE if mixed else describe_count(value)) or edit


def find_selected(fields: Fields, id: str, value: Numbers) -> int:
    """The index of the selected light; -1 if there is none."""
    return min(max(fields.lights.get(id, 0), 0), count_lights(value) - 1)


def _row_height() -> float:
    return imgui.get_text_line_height() + 6.0 * ui_scale()


def _list_height(value: Numbers) -> float:
    return _row_height() * min(max(count_lights(value), 1), ROWS)


# --- the list --------------------------------------------------------------------------------------------------------


def _draw_list(fields: Fields, id: str, value: Numbers) -> Edit | None:
    """Draw the visible rows only, since a list may have a thousand lights."""
    count, height, edit = count_lights(value), _row_height(), None
    chosen = find_selected(fields, id, value)
    if not count:
        imgui.dummy((1.0, height))
        pad = imgui.get_style().frame_padding.x
        left, top, _, bottom = item_rect()
        write((left + pad, top, left + imgui.get_content_region_avail().x, bottom), "no lights", fields.palette.dim)
        return None
    if fields.lights_shown.get(id, 0) != chosen:
        fields.lights_shown[id] = chosen
        top = min(max(imgui.get_scroll_y(), (chosen + 1) * height - imgui.get_window_height()), chosen * height)
        imgui.set_scroll_y(top)
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, 0.0))
    clipper = imgui.ListClipper()
    clipper.begin(count, height)
    while clipper.step():
        for index in range(clipper.display_start, clipper.display_end):
            edit = _draw_row(fields, id, value, index, index == chosen) or edit
    clipper.end()
    imgui.pop_style_var()
    return edit


def _draw_row(fields: Fields, id: str, value: Numbers, index: int, chosen: bool) -> Edit | None:
    light, palette, scale = light_at(value, index), fields.palette, ui_scale()
    start = imgui.get_cursor_pos()
    rect = place(imgui.get_content_region_avail().x, _row_height())
    eye = rect[2] - rect[3] + rect[1] - 2.0 * scale
    imgui.invisible_button(f"##{index}", (eye - rect[0], rect[3] - rect[1]), _EITHER)
    fields.places[f"light {id} {index}"] = item_rect()
    hovered = imgui.is_item_hovered()
    if imgui.is_item_activated():
        fields.lights[id] = index
    if hovered and imgui.is_mouse_released(imgui.MouseButton_.right):
        fields.lights[id] = index
        imgui.open_popup(_MENU)
    imgui.same_line(0.0, 0.0)
    switched = imgui.invisible_button(f"##eye {index}", (rect[2] - eye, rect[3] - rect[1]))
    fields.places[f"eye {id} {index}"] = item_rect()
    over_eye = imgui.is_item_hovered()
    tip("On. Click to switch it off" if light.on else "Off. Click to switch it on")
    lines = imgui.get_window_draw_list()
    if chosen or hovered or over_eye:
        color = mix(palette.field, palette.accent, 0.3) if chosen else mix(palette.field, palette.hover, 0.35)
        lines.add_rect_filled(rect[:2], rect[2:], u32(color), imgui.get_style().frame_rounding)
    _draw_face(fields, light, index, (rect[0], rect[1], eye, rect[3]))
    ink = palette.text if over_eye else palette.dim
    _draw_icon((eye, rect[1], rect[2], rect[3]), icons.ICON_FA_EYE if light.on else icons.ICON_FA_EYE_SLASH, ink)
    imgui.set_cursor_pos((start.x, start.y + _row_height()))
    return Edit(replace_light(value, index, structs.replace(light, on=not light.on))) if switched else None


def _draw_face(fields: Fields, light: Light, index: int, rect: Rect) -> None:
    """Draw a row: color (with a bar if the light is negative), icon, title and intensity."""
    palette, lines, scale = fields.palette, imgui.get_window_draw_list(), ui_scale()
    left, top, right, bottom = rect
    pad = 4.0 * scale
    chip = left + pad, top + pad, left + bottom - top, bottom - pad
    lines.add_rect_filled(chip[:2], chip[2:], u32(swatch(light.color), 1.0 if light.on else 0.4), 3.0 * scale)
    if light.intensity < 0.0:
        lines.add_line((chip[0], chip[3]), (chip[2], chip[1]), u32(palette.field), 4.0 * scale)
        lines.add_line((chip[0], chip[3]), (chip[2], chip[1]), u32(palette.text), 1.5 * scale)
    lines.add_rect(chip[:2], chip[2:], u32(palette.border), 3.0 * scale)
    ink = palette.text if light.on else palette.dim
    icon = chip[2] + pad, top, chip[2] + bottom - top + pad, bottom
    _draw_icon(icon, ICONS[light.kind], mix(palette.dim, ink, 0.5))
    number = describe_intensity(light)
    room = imgui.calc_text_size(number).x
    used = write((icon[2] + pad, top, right, bottom), light_title(light, index), ink)
    if icon[2] + 4.0 * pad + used + room <= right:
        write((icon[2], top, right, bottom), number, palette.dim, align=1.0)


def _draw_icon(rect: Rect, icon: str, color: tuple[float, float, float]) -> None:
    size = imgui.calc_text_size(icon)
    x, y = (rect[0] + rect[2] - size.x) * 0.5, (rect[1] + rect[3] - size.y) * 0.5
    imgui.get_window_draw_list().add_text((round(x), round(y)), u32(color), icon)


# --- what is done to it ----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _LightAction:
    """An action on the selected light: the list after it, and the index selected then."""

    icon: str
    label: str
    do: Callable[[], tuple[Numbers, int]]
    enabled: bool


def _list_actions(value: Numbers, index: int) -> tuple[_LightAction, ...]:
    count = count_lights(value)
    return (
        _LightAction(
            icons.ICON_FA_CLONE,
            "Duplicate",
            lambda: insert_light(value, index, light_at(value, index)),
            index >= 0 and count < MAX_LIGHTS,
        ),
        _LightAction(icons.ICON_FA_ARROW_UP, "Move Up", lambda: move_light(value, index, -1), index > 0),
        _LightAction(
            icons.ICON_FA_ARROW_DOWN, "Move Down", lambda: move_light(value, index, 1), 0 <= index < count - 1
        ),
        _LightAction(icons.ICON_FA_TRASH, "Remove", lambda: remove_light(value, index), index >= 0),
    )


def _select_and_edit(fields: Fields, id: str, lights_and_index: tuple[Numbers, int]) -> Edit:
    value, fields.lights[id] = lights_and_index
    return Edit(value)


def _draw_menu(fields: Fields, id: str, value: Numbers) -> Edit | None:
    """The menu of a row."""
    if not imgui.begin_popup(_MENU):
        return None
    edit = None
    for act in _list_actions(value, find_selected(fields, id, value)):
        if imgui.menu_item(f"{act.icon}  {act.label}", "", False, act.enabled)[0]:
            edit = _select_and_edit(fields, id, act.do())
        fields.places[f"menu {act.label}"] = item_rect()
    imgui.end_popup()
    return edit


def _draw_buttons(fields: Fields, id: str, value: Numbers, width: float, words: str) -> Edit | None:
    index, full, edit = find_selected(fields, id, value), count_lights(value) >= MAX_LIGHTS, None
    rect = place(width)

    def draw_kinds() -> None:
        nonlocal edit
        for kind in LightKind:
            if imgui.menu_item(f"{ICONS[kind]}  {KINDS[kind]}", "", False, not full)[0]:
                edit = _select_and_edit(fields, id, insert_light(value, index, make_light(kind)))
            fields.places[f"menu {KINDS[kind]}"] = item_rect()

    dropdown(fields, icons.ICON_FA_PLUS, f"button add {id}", "Add a light after the selected one", draw_kinds)
    for act in _list_actions(value, index):
        imgui.same_line(0.0, 0.0)
        doc = f"{act.label}: the selected light"
        if quiet_button(fields, act.icon, f"button {act.label.lower()} {id}", doc, enabled=act.enabled):
            edit = _select_and_edit(fields, id, act.do())
    left = item_rect()[2] + imgui.get_style().item_inner_spacing.x
    write((left, rect[1], rect[2], rect[3]), words, fields.palette.dim, align=1.0)
    return edit
