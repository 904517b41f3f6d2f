"""The field for text: one line, or several if the text is long."""

from __future__ import annotations

from halation.nodes import Plain, Value
from imgui_bundle import imgui

from ..toolkit.fields import background
from ..toolkit.places import place
from ..toolkit.words import write
from .fields import Edit, Fields
from .number_field import NO_VALUE
from .text_entry import text_entry

MOST_LINES = 6
LEAST_LINES = 3
"""The lines of a field for a text of several lines, so that there is room to type the next one."""


def lines_of(text: str) -> int:
    """The number of lines that the field of a text shows."""
    return min(max(text.count("\n") + 1, -(-len(text) // 48)), MOST_LINES)


def text_field(
    fields: Fields,
    id: str,
    value: Plain,
    declaration: Value,
    width: float,
    *,
    label: str = "",
    mixed: bool = False,
    hint: str = "",
    fault: bool = False,
    lines: int = 0,
    elide_left: bool = False,
) -> Edit | None:
    """Draw a text field. `hint` is shown while it is empty; `elide_left` keeps the end of the text visible."""
    assert isinstance(value, str)
    count = lines or max(lines_of(value), LEAST_LINES if declaration.has_lines else 1)
    fields.order.append(id)
    if fields.next_field == id:
        fields.type_in(id, value, value)
    if fields.typing and fields.typing.id == id:
        return text_entry(fields, width, lines=count, hint=hint)
    pad = imgui.get_style().frame_padding
    rect = place(width, imgui.get_text_line_height() * count + 2 * pad.y if count > 1 else 0.0)
    if imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1])):
        fields.type_in(id, value, value)
    if imgui.is_item_hovered():
        imgui.set_mouse_cursor(imgui.MouseCursor_.text_input)
    background(fields.palette, rect, hovered=imgui.is_item_hovered(), fault=fault)
    color = fields.palette.error if fault else fields.palette.text if value and not mixed else fields.palette.dim
    text = NO_VALUE if mixed else value or hint or label
    if count > 1:
        lines_drawn = imgui.get_window_draw_list()
        lines_drawn.push_clip_rect(rect[:2], rect[2:], True)
        lines_drawn.add_text(
            imgui.get_font(),
            imgui.get_font_size(),
            (rect[0] + pad.x, rect[1] + pad.y),
            imgui.get_color_u32((*color, 1.0)),
            text,
            wrap_width=rect[2] - rect[0] - 2 * pad.x,
        )
        lines_drawn.pop_clip_rect()
        return None
    room = rect[2] - rect[0] - 2 * pad.x
    if elide_left and value:
        text = _end_of(text, room)
    write((rect[0] + pad.x, rect[1], rect[2] - pad.x, rect[3]), text, color)
    return None


def _end_of(text: str, room: float) -> str:
    if imgui.calc_text_size(text).x <= room:
        return text
    while text and imgui.calc_text_size("…" + text).x > room:
        text = text[1:]
    return "…" + text
