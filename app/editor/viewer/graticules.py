"""Graticules: lines and labels over scopes."""

from __future__ import annotations

import math

from imgui_bundle import imgui

from ..theme.palette import RGB, Palette
from ..theme.style import u32, ui_scale
from . import scopes

Box = tuple[float, float, float, float]
_LEVELS = (0.0, 0.25, 0.5, 0.75, 1.0)
_SMALL = 0.78
"""The size of labels, as a fraction of other text."""


def back(palette: Palette) -> RGB:
    """Draw the background of a scope: traces glow on black, or are ink on white."""
    return min(palette.border, palette.window) if palette.is_dark else palette.field


def level_lines(lines: imgui.ImDrawList, palette: Palette, box: Box, low: float, high: float) -> None:
    """Horizontal lines at 0 to 1 of a waveform that shows low..high."""
    left, top, right, bottom = box
    for level in _LEVELS:
        y = bottom - (level - low) / (high - low) * (bottom - top)
        strong = level in (0.0, 1.0)
        lines.add_line((left, y), (right, y), u32(palette.text, 0.35 if strong else 0.12))
        if strong or bottom - top > 120 * ui_scale():
            below = y + 2 * ui_scale() if level == 1.0 else y - imgui.get_font_size() * 0.95
            _word(lines, palette, (left + 4 * ui_scale(), below), f"{level:g}")


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
    angle = math.radians(scopes.SKIN_ANGLE)
    lines.add_line((x, y), (x + radius * math.cos(angle), y - radius * math.sin(angle)), u32(palette.warning, 0.55))
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


def hint(lines: imgui.ImDrawList, palette: Palette, box: Box, text: str) -> None:
    """Draw a hint in the upper right corner of a scope, if it fits."""
    width = imgui.calc_text_size(text).x * _SMALL
    if width < (box[2] - box[0]) * 0.7:
        _word(lines, palette, (box[2] - width - 5 * ui_scale(), box[1] + 3 * ui_scale()), text)


def _word(lines: imgui.ImDrawList, palette: Palette, at: tuple[float, float], text: str) -> None:
    """Draw small text on an opaque plate, so that traces do not cross it."""
    size, pad = imgui.get_font_size() * _SMALL, 2 * ui_scale()
    width = imgui.calc_text_size(text).x * _SMALL
    plate = (at[0] - pad, at[1]), (at[0] + width + pad, at[1] + size)
    lines.add_rect_filled(*plate, u32(back(palette), 0.75), pad)
    lines.add_text(imgui.get_font(), size, (round(at[0]), round(at[1])), u32(palette.dim), text)
