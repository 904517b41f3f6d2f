"""Lines and words over scopes."""

from __future__ import annotations

import math

from imgui_bundle import imgui

from ..theme.palette import RGB, Palette
from ..theme.style import u32, ui_scale
from . import scopes

Box = tuple[float, float, float, float]
_LEVELS = (0.0, 0.25, 0.5, 0.75, 1.0)


def level_lines(lines: imgui.ImDrawList, palette: Palette, box: Box, low: float, high: float) -> None:
    """Horizontal lines at 0 to 1 of a waveform that shows low..high."""
    left, top, right, bottom = box
    for level in _LEVELS:
        y = bottom - (level - low) / (high - low) * (bottom - top)
        strong = level in (0.0, 1.0)
        lines.add_line((left, y), (right, y), u32(palette.text, 0.35 if strong else 0.12))
        if strong or bottom - top > 120 * ui_scale():
            _word(lines, palette, (left + 3, y + (1 if level == 1.0 else -imgui.get_font_size())), f"{level:g}")


def chroma_lines(lines: imgui.ImDrawList, palette: Palette, box: Box) -> None:
    """The vectorscope's axes, the boxes of 75 % bars, and the line of skin."""
    left, top, right, bottom = box
    width, height = right - left, bottom - top
    x, y = (left + right) / 2, (top + bottom) / 2
    faint = u32(palette.text, 0.16)
    lines.add_line((left, y), (right, y), faint)
    lines.add_line((x, top), (x, bottom), faint)
    radius = width * 0.5 / (2 * scopes.CHROMA)
    for part in (0.5, 1.0):
        lines.add_circle((x, y), radius * part, faint, 64)
    turn = math.radians(scopes.SKIN_ANGLE)
    lines.add_line((x, y), (x + radius * math.cos(turn), y - radius * math.sin(turn)), u32(palette.warning, 0.55))
    size = max(width * 0.02, 3.0)
    for name, color in scopes.TARGETS:
        across, down = scopes.chroma_place(color)
        at = left + across * width, top + down * height
        shade = tuple(0.25 + part * 0.9 for part in color)
        lines.add_rect((at[0] - size, at[1] - size), (at[0] + size, at[1] + size), u32((shade[0], shade[1], shade[2])))
        if width > 140 * ui_scale():
            _word(lines, palette, (at[0] + size + 2, at[1] - size - imgui.get_font_size() * 0.7), name)


def range_lines(lines: imgui.ImDrawList, palette: Palette, box: Box, low: float, high: float) -> None:
    """Vertical lines of a histogram that shows low..high."""
    left, top, right, bottom = box
    for level in _LEVELS:
        x = left + (level - low) / (high - low) * (right - left)
        strong = level in (0.0, 1.0)
        lines.add_line((x, top), (x, bottom), u32(palette.text, 0.35 if strong else 0.12))


def hint(lines: imgui.ImDrawList, color: RGB, box: Box, text: str) -> None:
    """A few words in the upper right corner of a scope."""
    size = imgui.get_font_size() * 0.8
    width = imgui.calc_text_size(text).x * 0.8
    if width < (box[2] - box[0]) * 0.6:
        lines.add_text(imgui.get_font(), size, (box[2] - width - 4, box[1] + 2), u32(color), text)


def _word(lines: imgui.ImDrawList, palette: Palette, at: tuple[float, float], text: str) -> None:
    size = imgui.get_font_size() * 0.75
    lines.add_text(imgui.get_font(), size, at, u32(palette.text, 0.6), text)
