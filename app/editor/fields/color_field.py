"""Fields for scene-linear colors: a swatch, its numbers, and a picker for display colors."""

from __future__ import annotations

from halation.nodes import Plain, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec.structs import replace

from ...errors import UsageError
from ...language.translation import translate
from ..theme.palette import RGB
from ..toolkit.buttons import quiet_button
from ..toolkit.fields import background
from ..toolkit.places import Rect, place
from ..toolkit.words import draw_dim, tip, write
from .balance import COOLEST, HOTTEST, find_temperature, set_temperature
from .colors import RGBA, brighten, from_display, from_hexadecimal, hexadecimal, intensity, swatch, to_display
from .fields import Edit, Fields
from .number_field import NO_VALUE, number_field, row_of_numbers
from .swatches import draw_swatch, draw_swatches, luma
from .text_field import text_field

_LIGHT = Value("light", "color", (0.0,) * 4, 4, low=0.0, high=1.0)
_STOPS = Value("stops", "float", 0.0, low=0.0, high=8.0, minimum=0.0, maximum=16.0, unit="EV")
_KELVIN = Value("kelvin", "float", 6504.0, low=2000.0, high=12000.0, minimum=COOLEST, maximum=HOTTEST, unit="K")
_TEXT = Value("hex", "text", "")
_NAMES = ("R", "G", "B", "A")

WIDTH = 17.0
"""The width of the picker, in heights of a text line."""


def color_field(
    fields: Fields,
    id: str,
    value: Plain,
    declaration: Value,
    width: float,
    *,
    label: str = "",
    mixed: bool = False,
    eyedropper: bool = True,
    alpha: bool = True,
) -> Edit | None:
    """Draw a swatch that opens the picker, and its scene-linear numbers if there is room.

    Without `alpha`, the alpha is not shown and does not change.
    """
    color = rgba(value)
    alpha = alpha and has_alpha(value)
    numbers = not label and width > imgui.get_font_size() * 12.0
    side = imgui.get_frame_height() * 1.2
    rect = place(side if numbers else width)
    pressed = imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1]))
    hovered = imgui.is_item_hovered()
    if label or numbers:
        draw_swatch(fields, rect, color, hovered)
    else:
        _draw_short(fields, rect, side, color if alpha else color[:3], mixed, hovered)
    if label:
        _draw_name(fields, rect, color, label)
    if pressed:
        fields.stops = intensity(color)
        imgui.open_popup(f"picker {id}")
    color_edit = None
    if numbers:
        gap = imgui.get_style().item_inner_spacing.x
        imgui.same_line(0.0, gap)
        color_edit = row_of_numbers(
            fields, id, color, _LIGHT, width - side - gap, _NAMES if alpha else _NAMES[:3], mixed
        )
    imgui.set_next_window_pos((rect[0], rect[3]), imgui.Cond_.appearing)
    if imgui.begin_popup(f"picker {id}"):
        color_edit = color_picker(fields, f"{id} picker", color, eyedropper, alpha) or color_edit
        imgui.end_popup()
    return color_edit


def color_picker(fields: Fields, id: str, color: RGBA, eyedropper: bool = True, alpha: bool = True) -> Edit | None:
    """Draw the picker: wheel, intensity, numbers, temperature, hexadecimal digits, eyedropper and swatches."""
    width, side = imgui.get_font_size() * WIDTH, imgui.get_font_size() * 5.5
    owner, stops = id.removesuffix(" picker"), fields.stops

    def from_stops(edit: Edit) -> Edit | None:
        number = edit.value
        return replace(edit, value=brighten(color, number - stops)) if isinstance(number, int | float) else None

    def from_kelvin(edit: Edit) -> Edit | None:
        number = edit.value
        return replace(edit, value=set_temperature(color, number)) if isinstance(number, int | float) else None

    def from_hex(edit: Edit) -> Edit | None:
        return _read_color(str(edit.value), color)

    fields.part(f"{id} stops", owner, from_stops)
    fields.part(f"{id} light", owner, lambda edit: edit)
    fields.part(f"{id} hex", owner, from_hex)
    color_edit = _draw_wheel(fields, id, color, width, alpha)
    _draw_label(fields, translate("Intensity"), side)
    if edit := number_field(fields, f"{id} stops", stops, _STOPS, width - side):
        color_edit = from_stops(edit)
        fields.stops = float(edit.value) if isinstance(edit.value, int | float) else stops
    numbers = row_of_numbers(fields, f"{id} light", color, _LIGHT, width, _NAMES if alpha else _NAMES[:3])
    _draw_label(fields, translate("Temperature"), side)
    tip(
        translate(
            "The color of light by its temperature: candle 1850 K, bulb 2850, noon 5500, shade 8000. "
            "It stays as bright."
        )
    )
    fields.part(f"{id} kelvin", owner, from_kelvin)
    warmth = number_field(fields, f"{id} kelvin", find_temperature(color), _KELVIN, width - side, plain=True)
    _draw_label(fields, translate("sRGB hex"), side)
    room = width - side - (3 if eyedropper else 2) * (imgui.get_frame_height() + imgui.get_style().item_inner_spacing.x)
    text = text_field(fields, f"{id} hex", hexadecimal(color), _TEXT, room)
    fresh = numbers or (from_kelvin(warmth) if warmth else None) or (from_hex(text) if text else None)
    fresh = (
        fresh or _draw_buttons(fields, id, color, eyedropper, alpha) or draw_swatches(fields, id, color, width, alpha)
    )
    if fresh:
        fields.stops = intensity(rgba(fresh.value))
    return fresh or color_edit


def _draw_wheel(fields: Fields, id: str, color: RGBA, width: float, alpha: bool) -> Edit | None:
    flag = imgui.ColorEditFlags_
    flags = sum(
        int(part)
        for part in (
            flag.picker_hue_wheel,
            flag.no_inputs,
            flag.no_side_preview,
            flag.no_label,
            flag.no_options,
            flag.float,
            flag.no_tooltip,
            flag.alpha_bar if alpha else flag.no_alpha,
        )
    )
    display_color = to_display(color, fields.stops)
    imgui.set_next_item_width(width)
    changed, picked = imgui.color_picker4(f"##{id} wheel", [*display_color, min(max(color[3], 0.0), 1.0)], flags)
    if imgui.is_item_activated():
        fields.start_gesture()
    if not changed:
        return None
    return Edit(from_display((picked[0], picked[1], picked[2]), fields.stops, picked[3]), fields.merge)


def _draw_buttons(fields: Fields, id: str, color: RGBA, eyedropper: bool, alpha: bool) -> Edit | None:
    pasted = None
    gap = imgui.get_style().item_inner_spacing.x
    imgui.same_line(0.0, gap)
    if quiet_button(fields, icons.ICON_FA_COPY, f"button copy {id}", translate("Copy the linear numbers")):
        imgui.set_clipboard_text(" ".join(f"{part:g}" for part in (color if alpha else color[:3])))
    imgui.same_line(0.0, gap)
    if quiet_button(
        fields, icons.ICON_FA_PASTE, f"button paste {id}", translate("Paste linear numbers, or hexadecimal digits")
    ):
        pasted = _read_color(imgui.get_clipboard_text(), color)
    if eyedropper:
        imgui.same_line(0.0, gap)
        if quiet_button(
            fields, icons.ICON_FA_EYE_DROPPER, f"button pick {id}", translate("Pick the color from the viewer")
        ):
            fields.eyedropper = id.removesuffix(" picker")
            imgui.close_current_popup()
    return pasted


def _read_color(text: str, color: RGBA) -> Edit | None:
    """The color in a pasted or typed text; the old color if it is invalid."""
    parts = text.replace(",", " ").split()
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        numbers = []
    if len(numbers) in (3, 4):
        numbers_read = (numbers[0], numbers[1], numbers[2], numbers[3] if len(numbers) == 4 else color[3])
    else:
        try:
            numbers_read = from_hexadecimal(text, color[3])
        except UsageError:
            return None
    return Edit(numbers_read)


def _draw_label(fields: Fields, text: str, side: float) -> None:
    left = imgui.get_cursor_pos_x()
    imgui.align_text_to_frame_padding()
    draw_dim(fields, text)
    imgui.same_line(left + side)


def _draw_short(fields: Fields, rect: Rect, side: float, color: RGBA | RGB, mixed: bool, hovered: bool) -> None:
    """Draw a swatch and short numbers, for narrow fields."""
    background(fields.palette, rect, hovered=hovered)
    draw_swatch(fields, (rect[0], rect[1], rect[0] + side, rect[3]), rgba(color), hovered)
    text = NO_VALUE if mixed else " ".join(f"{part:.2g}" for part in color)
    pad = imgui.get_style().frame_padding.x * 0.75
    write((rect[0] + side + pad, rect[1], rect[2] - pad, rect[3]), text, fields.palette.text)


def _draw_name(fields: Fields, rect: Rect, color: RGBA, label: str) -> None:
    pad = imgui.get_style().frame_padding.x
    below, palette = luma(swatch(color)), fields.palette
    ink = max((palette.text, palette.panel), key=lambda ink: abs(luma(ink) - below))
    write((rect[0] + pad, rect[1], rect[2] - pad, rect[3]), label, ink)


def rgba(value: Plain) -> RGBA:
    """A color with an alpha, which is 1 if it had none."""
    assert isinstance(value, tuple)
    red, green, blue, alpha = (*value, 1.0)[:4]
    return red, green, blue, alpha


def has_alpha(value: Plain) -> bool:
    """True for a color of four numbers."""
    return isinstance(value, tuple) and len(value) == 4
