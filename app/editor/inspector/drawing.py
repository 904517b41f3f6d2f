"""How fields look."""

from __future__ import annotations

from imgui_bundle import imgui

from ..theme.palette import RGB, Palette
from ..theme.style import mix, u32

Rect = tuple[float, float, float, float]
"""Left, top, right, bottom in screen pixels."""


def place(width: float, height: float = 0.0) -> Rect:
    """The rectangle at the cursor; a field is as high as any framed widget."""
    start = imgui.get_cursor_screen_pos()
    return start.x, start.y, start.x + max(width, 1.0), start.y + (height or imgui.get_frame_height())


def item_rect() -> Rect:
    """Where the last widget is."""
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    return low.x, low.y, high.x, high.y


def background(
    palette: Palette, rect: Rect, *, hovered: bool = False, active: bool = False, fault: bool = False
) -> None:
    """The box of a field."""
    color = mix(palette.field, palette.hover, 0.6 if active else 0.35 if hovered else 0.0)
    lines, rounding = imgui.get_window_draw_list(), imgui.get_style().frame_rounding
    lines.add_rect_filled(rect[:2], rect[2:], u32(color), rounding)
    if fault:
        lines.add_rect(rect[:2], rect[2:], u32(palette.error), rounding)


def fitted(text: str, width: float) -> str:
    """The text, or as much of its beginning as fits, with an ellipsis."""
    if imgui.calc_text_size(text).x <= width:
        return text
    while text and imgui.calc_text_size(text + "…").x > width:
        text = text[:-1]
    return text + "…" if text else ""


def write(rect: Rect, text: str, color: RGB, align: float = 0.0, alpha: float = 1.0) -> float:
    """One line of text in a box, cut to fit; `align` 0 is left, 1 right. Returns its width."""
    text = fitted(text, rect[2] - rect[0])
    size = imgui.calc_text_size(text)
    x = rect[0] + (rect[2] - rect[0] - size.x) * align
    y = rect[1] + (rect[3] - rect[1] - size.y) * 0.5
    imgui.get_window_draw_list().add_text((x, round(y)), u32(color, alpha), text)
    return size.x


def note_below(palette: Palette, rect: Rect, text: str, color: RGB) -> None:
    """A line of text in a box of its own below a field, over everything else."""
    pad = imgui.get_style().frame_padding
    limit = imgui.get_main_viewport()
    wrap = min(imgui.get_font_size() * 20, limit.size.x)
    size = imgui.calc_text_size(text, wrap_width=wrap)
    x = max(min(rect[0], limit.pos.x + limit.size.x - size.x - 2 * pad.x), limit.pos.x)
    y = rect[3] + pad.y
    lines = imgui.get_foreground_draw_list()
    corner = (x + size.x + 2 * pad.x, y + size.y + 2 * pad.y)
    lines.add_rect_filled((x, y), corner, u32(palette.window), imgui.get_style().frame_rounding)
    lines.add_rect((x, y), corner, u32(color), imgui.get_style().frame_rounding)
    lines.add_text(imgui.get_font(), imgui.get_font_size(), (x + pad.x, y + pad.y), u32(color), text, wrap_width=wrap)
