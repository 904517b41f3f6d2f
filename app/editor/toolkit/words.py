"""Draws text: in fonts and weights, cut to fit, as tooltips, and in empty panels."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Literal

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.log import Level
from ..theme.palette import RGB, Palette
from ..theme.style import EM, mix, u32, ui_scale, vec4
from .places import Rect, TextSurface, WidgetSurface

SMALL, TITLE = EM * 0.86, EM * 1.125
"""Font sizes besides `EM`: of notes and section headings, and of dialog titles."""

ICONS: dict[Level, str] = {
    "info": icons.ICON_FA_CIRCLE_INFO,
    "warning": icons.ICON_FA_TRIANGLE_EXCLAMATION,
    "error": icons.ICON_FA_CIRCLE_XMARK,
}


def level_color(palette: Palette, level: Level) -> RGB:
    """The color of a message's icon."""
    return {"info": palette.dim, "warning": palette.warning, "error": palette.error}[level]


@contextmanager
def font(surface: TextSurface, name: Literal["text", "bold", "mono"], size: float = EM) -> Iterator[None]:
    """Draw in another font; `size` in pixels at scale 1."""
    imgui.push_font(getattr(surface.fonts, name, None), size)
    try:
        yield
    finally:
        imgui.pop_font()


def draw_dim(surface: WidgetSurface, text: str) -> None:
    """Draw text in the dim color."""
    imgui.text_colored(vec4(surface.palette.dim), text)


def draw_wrapped(color: RGB, text: str) -> None:
    """Draw wrapped text in a color."""
    imgui.push_style_color(imgui.Col_.text, vec4(color))
    imgui.text_wrapped(text)
    imgui.pop_style_color()


def tip(text: str) -> None:
    """Draw a wrapped tooltip for the last widget, while the mouse is over it."""
    if text and imgui.is_item_hovered(int(imgui.HoveredFlags_.for_tooltip)):
        show_tip(text)


def show_tip(text: str) -> None:
    """Draw a tooltip at the pointer."""
    # After a key the library would put it beside what the keyboard chose last, wherever that is.
    imgui.get_current_context().nav_highlight_item_under_nav = False
    if imgui.begin_tooltip():
        imgui.push_text_wrap_pos(imgui.get_font_size() * 24)
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.end_tooltip()


def cut_end(text: str, width: float) -> str:
    """`text`, or as much of its beginning as fits in `width` pixels, with an ellipsis."""
    return _cut(text, width, lambda length: text[:length] + "…")


def cut_middle(text: str, width: float) -> str:
    """`text`, or its two ends if it is wider than `width` pixels: for paths."""
    return _cut(text, width, lambda length: text[: length // 2] + "…" + text[len(text) - (length - length // 2) :])


def _cut(text: str, width: float, shorter: Callable[[int], str]) -> str:
    if imgui.calc_text_size(text).x <= width:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if imgui.calc_text_size(shorter(middle)).x <= width else (low, middle - 1)
    return shorter(low) if low else ""


def write(rect: Rect, text: str, color: RGB, align: float = 0.0, alpha: float = 1.0) -> float:
    """Draw one line of text in a box, cut to fit; `align` 0 is left, 1 right. Returns its width."""
    text = cut_end(text, rect[2] - rect[0])
    size = imgui.calc_text_size(text)
    x = rect[0] + (rect[2] - rect[0] - size.x) * align
    y = rect[1] + (rect[3] - rect[1] - size.y) * 0.5
    imgui.get_window_draw_list().add_text((x, round(y)), u32(color, alpha), text)
    return size.x


def note_below(palette: Palette, rect: Rect, text: str, color: RGB) -> None:
    """Draw a line of text in a box below a field, over everything else."""
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


def draw_empty_panel(surface: TextSurface, icon: str, title: str, sentence: str) -> None:
    """Draw the message of an empty panel, in its middle."""
    room, scale = imgui.get_content_region_avail(), ui_scale()
    width = max(min(room.x, 320 * scale), 1.0)
    size = imgui.calc_text_size(sentence, wrap_width=width)
    height = size.y + 56 * scale
    left, top = imgui.get_cursor_pos_x(), imgui.get_cursor_pos_y() + max((room.y - height) * 0.4, 0.0)
    imgui.set_cursor_pos_y(top)
    for text, base, color in (
        (icon, 22.0, mix(surface.palette.dim, surface.palette.panel, 0.35)),
        (title, EM, surface.palette.text),
    ):
        with font(surface, "bold", base):
            imgui.set_cursor_pos_x(left + max((room.x - imgui.calc_text_size(text).x) / 2, 0.0))
            imgui.text_colored(vec4(color), text)
    imgui.set_cursor_pos_x(left + max((room.x - min(size.x, width)) / 2, 0.0))
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + min(size.x, width) + scale)
    draw_dim(surface, sentence)
    imgui.pop_text_wrap_pos()
