"""Text input in a field: Tab goes to the next field, arrow keys change digits."""

from __future__ import annotations

from imgui_bundle import imgui

from ..toolkit.keys import is_enter_pressed
from ..toolkit.places import item_rect
from ..toolkit.words import note_below
from .fields import Edit, Fields, Typing
from .numbers import format_number, step_digit

_SIGNS = set("+-*/^(%")


def text_entry(fields: Fields, width: float, *, lines: int = 1, hint: str = "") -> Edit | None:
    """Draw the field that is typed in; returns the edit when typing ends, or an arrow key changed a digit.

    Enter, Tab and a click elsewhere accept the text, Escape discards it; an invalid text stays in the field.
    """
    typing = fields.typing
    assert typing is not None
    typing.is_drawn = True
    if typing.starting:
        imgui.set_keyboard_focus_here()
    escaped, shift = imgui.is_key_pressed(imgui.Key.escape), imgui.get_io().key_shift
    if shift and not typing.starting and imgui.is_key_pressed(imgui.Key.tab):
        typing.tab = -1
    entered = _draw_input(typing, width, lines, hint)
    rect, active = item_rect(), imgui.is_item_active()
    if typing.starting:
        typing.starting = not active
        return None
    if escaped:
        fields.typing = None
        return Edit(typing.old, typing.merge) if typing.merge else None
    if active and not entered and not typing.tab:
        _draw_note(fields, typing, rect)
        return _take_step(fields, typing)
    return _finish(fields, typing, entered)


def _finish(fields: Fields, typing: Typing, entered: bool) -> Edit | None:
    if fault := typing.fault:
        if entered or typing.tab:
            typing.starting, typing.tab = True, 0
            return None
        typing.text = typing.before
    fields.typing = None
    if typing.tab:
        fields.next_field = fields.next_after(typing.id, typing.tab)
    return None if fault else typing.result()


def _take_step(fields: Fields, typing: Typing) -> Edit | None:
    """Apply an arrow key at once."""
    if not typing.has_stepped:
        return None
    typing.has_stepped = False
    typing.merge = typing.merge or fields.start_gesture()
    return None if typing.fault else typing.result()


def _draw_input(typing: Typing, width: float, lines: int, hint: str) -> bool:
    """Draw the input widget; True if Enter ended it.

    Tab and the arrow keys come through callbacks, as the widget would take them itself: Tab accepts the text, and the
    arrows step the digit at the caret.
    """
    flag = imgui.InputTextFlags_
    flags = int(flag.auto_select_all) | int(flag.callback_completion)
    if typing.number:
        flags |= int(flag.callback_history)

    def on_key(data: imgui.InputTextCallbackData) -> int:
        if data.event_flag == flag.callback_completion:
            typing.tab = 1
        elif data.event_flag == flag.callback_history:
            direction = 1 if data.event_key == imgui.Key.up_arrow else -1
            text, caret = step_digit(typing.text, data.cursor_pos, direction)
            data.delete_chars(0, data.buf_text_len)
            data.insert_chars(0, text)
            data.cursor_pos = caret
            data.clear_selection()
            typing.has_stepped = True
        return 0

    imgui.set_next_item_width(width)
    label = f"##{typing.id}"
    if lines > 1:
        height = imgui.get_text_line_height() * lines + 2 * imgui.get_style().frame_padding.y
        flags = int(flag.ctrl_enter_for_new_line) | int(flag.enter_returns_true) | int(flag.word_wrap)
        entered, typing.text = imgui.input_text_multiline(label, typing.text, (width, height), flags)
        return entered
    _, typing.text = imgui.input_text_with_hint(label, hint, typing.text, flags, on_key)
    return imgui.is_item_deactivated() and is_enter_pressed()


def _draw_note(fields: Fields, typing: Typing, rect: tuple[float, float, float, float]) -> None:
    """Draw why the number is invalid, or the result of the arithmetic."""
    if typing.number is None or typing.text == typing.before or typing.text.lstrip().startswith("="):
        return
    if fault := typing.fault:
        imgui.get_window_draw_list().add_rect(
            rect[:2], rect[2:], imgui.get_color_u32((*fields.palette.error, 1.0)), imgui.get_style().frame_rounding
        )
        note_below(fields.palette, rect, fault, fields.palette.error)
    elif _SIGNS & set(typing.text.strip()[1:]) or typing.text.strip()[:1] in _SIGNS - {"-"}:
        edit = typing.result()
        if edit and isinstance(edit.value, int | float):
            note_below(fields.palette, rect, f"= {format_number(edit.value, typing.number)}", fields.palette.dim)
