"""Fields for choices and switches."""

from __future__ import annotations

from collections.abc import Sequence

from halation.nodes import Plain, Value
from imgui_bundle import imgui

from ...language.translation import translate
from ..shared.declared_words import name_choice, name_choices
from ..theme.style import mix, u32
from ..toolkit.fields import background, draw_arrow
from ..toolkit.keys import is_enter_pressed
from ..toolkit.places import place
from ..toolkit.words import write
from .fields import Edit, Fields
from .number_field import NO_VALUE

FILTERED = 8
"""The number of choices from which on the list has a search field: more do not fit at one glance."""


def choice_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """Draw a choice field: a list in which typing searches; Ctrl and the wheel step through it."""
    assert isinstance(value, str)
    index = choose(fields, id, name_choice(value), name_choices(declaration.choices), width, label=label, mixed=mixed)
    return None if index is None else Edit(declaration.choices[index])


def choose(
    fields: Fields, id: str, current: str, choices: Sequence[str], width: float, *, label: str = "", mixed: bool = False
) -> int | None:
    """Draw a list of texts; returns the chosen index, None if nothing was chosen."""
    rect, palette = place(width), fields.palette
    pressed = imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1]))
    hovered = imgui.is_item_hovered()
    wheel = _choose_by_wheel(current, choices) if hovered else None
    background(palette, rect, hovered=hovered, active=imgui.is_item_active())
    pad, arrow = imgui.get_style().frame_padding.x, imgui.get_font_size() * 0.8
    inner = (rect[0] + pad, rect[1], rect[2] - pad - arrow, rect[3])
    text = NO_VALUE if mixed else current
    if label:
        used = write((inner[0], inner[1], inner[0] + (inner[2] - inner[0]) * 0.45, inner[3]), label, palette.dim)
        write((inner[0] + used + pad, inner[1], inner[2], inner[3]), text, palette.text, align=1.0)
    else:
        write(inner, text, palette.text if mixed or current in choices else palette.error)
    draw_arrow(palette, rect)
    if pressed:
        fields.filter = ""
        imgui.open_popup(f"choices {id}")
    return _draw_popup(fields, id, current, choices, rect) if wheel is None else wheel


def _choose_by_wheel(current: str, choices: Sequence[str]) -> int | None:
    io = imgui.get_io()
    if not io.key_ctrl or not io.mouse_wheel or current not in choices:
        return None
    index = choices.index(current) - (1 if io.mouse_wheel > 0 else -1)
    return index if 0 <= index < len(choices) else None


def _draw_popup(
    fields: Fields, id: str, current: str, choices: Sequence[str], rect: tuple[float, float, float, float]
) -> int | None:
    """Draw the open list; the index of the chosen entry, if any.

    A long list has a field that filters it. A short one takes typed letters itself, and is searched by them. If nothing
    matches, all entries stay: an empty list would not say why.
    """
    line = imgui.get_text_line_height_with_spacing()
    imgui.set_next_window_pos((rect[0], rect[3]), imgui.Cond_.appearing)
    imgui.set_next_window_size_constraints((rect[2] - rect[0], 0.0), (line * 40, line * 18))
    if not imgui.begin_popup(f"choices {id}"):
        return None
    chosen_index, word = None, ""
    appearing = imgui.is_window_appearing()
    if len(choices) >= FILTERED:
        if appearing:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(max(rect[2] - rect[0] - 2 * imgui.get_style().window_padding.x, line * 6))
        _, fields.filter = imgui.input_text_with_hint("##find", translate("Type to find"), fields.filter)
        word = fields.filter.strip().casefold()
    else:
        fields.filter = _extend_filter(fields.filter)
        word = fields.filter.casefold()
    matches = [index for index, choice in enumerate(choices) if word in choice.casefold()] or list(range(len(choices)))
    entered = is_enter_pressed()
    for index in matches:
        chosen = choices[index] == current
        if imgui.selectable(f"{choices[index] or ' '}##{index}", chosen or (bool(word) and index == matches[0]))[0]:
            chosen_index = index
        if chosen and appearing:
            imgui.set_scroll_here_y()
            if len(choices) < FILTERED:
                imgui.set_item_default_focus()
    if entered and word and chosen_index is None:
        chosen_index = matches[0]
    if chosen_index is not None or imgui.is_key_pressed(imgui.Key.escape):
        imgui.close_current_popup()
    imgui.end_popup()
    return chosen_index


def _extend_filter(word: str) -> str:
    """The search text that was typed while a short list is open."""
    if imgui.is_key_pressed(imgui.Key.backspace):
        return word[:-1]
    letters = "abcdefghijklmnopqrstuvwxyz"
    pressed = [letter for letter in letters if imgui.is_key_pressed(getattr(imgui.Key, letter), False)]
    return word + "".join(pressed) if not imgui.get_io().key_ctrl else word


def toggle_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """Draw a switch."""
    rect, palette = place(width), fields.palette
    pressed = imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1]))
    hovered, on = imgui.is_item_hovered(), bool(value) and not mixed
    height = (rect[3] - rect[1]) * 0.62
    long, middle = height * 1.8, (rect[1] + rect[3]) * 0.5
    lines = imgui.get_window_draw_list()
    left = rect[2] - long if label else rect[0]
    track = (
        mix(palette.accent, palette.text, 0.15)
        if on and hovered
        else palette.accent
        if on
        else (palette.hover if hovered else palette.raised)
    )
    lines.add_rect_filled((left, middle - height / 2), (left + long, middle + height / 2), u32(track), height / 2)
    knob = left + (0.5 if mixed else 1.0 - height / 2 / long if on else height / 2 / long) * long
    lines.add_circle_filled((knob, middle), height * 0.36, u32(palette.on_accent if on else palette.dim))
    if label:
        write((rect[0], rect[1], left, rect[3]), label, palette.dim)
    else:
        text = NO_VALUE if mixed else translate("On") if value else translate("Off")
        write((left + long + imgui.get_style().item_inner_spacing.x, rect[1], rect[2], rect[3]), text, palette.dim)
    return Edit(not value) if pressed else None
