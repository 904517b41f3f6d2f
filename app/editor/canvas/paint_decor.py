"""Paints everything but nodes: the grid, frames, comments, dots, links and gestures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from imgui_bundle import imgui

from ...language.translation import translate
from ..theme.style import mix, u32
from .brush import READABLE, TEXT, CanvasColors, DrawContext
from .geometry import Curve, Point, Rect
from .scene import FRAME_TITLE, ElementBox, Wire

ROUND = 8.0
LINK = 2.25
DASH, HOLE = 9.0, 6.0


def paint_grid(brush: DrawContext, panel: Rect) -> None:
    """Paint grid lines every 32 units, stronger every 128; fine lines disappear when zoomed out."""
    to, draw = brush.to, brush.draw
    draw.add_rect_filled(panel[:2], panel[2:], brush.ink.canvas)
    step = 32.0 * to.scale
    while step < 22.0:
        step *= 4.0
    for axis, start, low, high in ((0, to.x, panel[0], panel[2]), (1, to.y, panel[1], panel[3])):
        first = math.ceil((low - start) / step)
        for index in range(first, int((high - start) // step) + 1):
            at = round(start + index * step) + 0.5
            color = brush.ink.grid if index % 4 else brush.ink.grid_strong
            if axis:
                draw.add_line((panel[0], at), (panel[2], at), color)
            else:
                draw.add_line((at, panel[1]), (at, panel[3]), color)


def find_frame_color(ink: CanvasColors, facts: Mapping[str, Any]) -> tuple[float, float, float]:
    """The color of a frame: its own, or that of headers."""
    color = facts.get("color")
    if isinstance(color, list | tuple) and len(color) == 3:
        return color[0], color[1], color[2]
    return ink.palette.category("")


def paint_frame(brush: DrawContext, box: ElementBox, facts: Mapping[str, Any], selected: bool, lit: bool) -> None:
    """Paint a frame with its title; `lit` while the mouse is on its edge or title."""
    ink = brush.ink
    color = find_frame_color(ink, facts)
    rect = box.rect
    brush.fill_rect(rect, u32(mix(color, ink.palette.canvas, 0.55), 0.42), ROUND)
    title = (rect[0], rect[1], rect[2], rect[1] + min(FRAME_TITLE, box.h))
    brush.fill_rect(title, u32(color, 0.55), ROUND, flags=int(imgui.ImDrawFlags_.round_top))
    edge = ink.accent if selected else u32(mix(color, ink.palette.text, 0.25 if lit else 0.1), 0.9)
    brush.draw_outline(rect, edge, ROUND, 2.0 if selected else 1.0 + lit)
    text = str(facts.get("title") or "frame")
    size = min(max(15.0, 11.0 / brush.zoom), 40.0)
    y = rect[1] + (FRAME_TITLE / 2 if brush.zoom >= 0.6 else max(FRAME_TITLE / 2, size * 0.8))
    brush.draw_text(rect[0] + 12.0, y, ink.text, brush.shorten(text, box.w - 24.0, size, True), size, True)


def paint_comment(brush: DrawContext, box: ElementBox, text: str, selected: bool) -> None:
    """Paint a comment."""
    ink, rect = brush.ink, box.rect
    brush.fill_rect(rect, u32(mix(ink.palette.canvas, ink.palette.warning, 0.12)), 4.0)
    bar = (rect[0], rect[1], rect[0] + 3.0, rect[3])
    brush.fill_rect(bar, u32(ink.palette.warning, 0.75), 1.5)
    if selected:
        brush.draw_outline(rect, ink.accent, 4.0, 2.0, 1.0)
    low, high = brush.project_corners(rect)
    s = brush.to.scale
    words, color = (text, ink.text) if text else (translate("double-click to write"), ink.faint)
    size = _find_comment_size(brush, words, (box.w - 20.0) * s, (box.h - 16.0) * s)
    brush.draw.push_clip_rect(low, high, True)
    brush.draw.add_text(brush.fonts.text, size, (low[0] + 12 * s, low[1] + 8 * s), color, words, (box.w - 20.0) * s)
    brush.draw.pop_clip_rect()


def _find_comment_size(brush: DrawContext, words: str, width: float, height: float) -> float:
    """The size of the text of a comment in pixels: readable however far the canvas is zoomed out, if it has room."""
    least, size = TEXT * brush.to.scale, READABLE * brush.to.scale / brush.zoom
    imgui.push_font(brush.fonts.text, TEXT)
    measured = imgui.get_font_size()
    while size > least and imgui.calc_text_size(words, wrap_width=width * measured / size).y * size > height * measured:
        size -= 1.0
    imgui.pop_font()
    return max(size, least)


def paint_dot(brush: DrawContext, box: ElementBox, color: int, selected: bool) -> None:
    """Paint a dot of a link."""
    x, y = brush.to.to_screen(box.x + box.w / 2, box.y + box.h / 2)
    r = box.w / 2 * brush.to.scale
    if selected:
        brush.draw.add_circle_filled((x, y), r + 2.5 * brush.line, brush.ink.accent)
    brush.draw.add_circle_filled((x, y), r, brush.ink.canvas)
    brush.draw.add_circle_filled((x, y), r * 0.75, color)


def paint_wire(brush: DrawContext, wire: Wire, *, lit: bool, faded: bool) -> None:
    """Paint a link in the color of its kind, brighter if `lit`, dashed if it is muted or invalid."""
    ink = brush.ink
    color = ink.error if wire.fault else (ink.kinds_dim if faded or wire.muted else ink.kinds)[wire.kind]
    thickness = LINK + (1.0 if lit else 0.0)
    for shape in wire.curves:
        if not _is_visible(brush, shape):
            continue
        if wire.fault or wire.muted:
            paint_dashes(brush, shape, color, thickness)
        else:
            paint_curve(brush, shape, color, thickness, halo=brush.zoom > 0.35)


def paint_curve(brush: DrawContext, shape: Curve, color: int, thickness: float, halo: bool = True) -> None:
    """Paint one curve with a dark rim, so that crossing curves stand apart."""
    to = brush.to
    x, y, s = to.x, to.y, to.scale
    a, b, c, d = ((x + shape[at] * s, y + shape[at + 1] * s) for at in (0, 2, 4, 6))
    if halo:
        brush.draw.add_bezier_cubic(a, b, c, d, brush.ink.canvas, (thickness + 2.5) * brush.line)
    brush.draw.add_bezier_cubic(a, b, c, d, color, thickness * brush.line)


def paint_dashes(brush: DrawContext, shape: Curve, color: int, thickness: float) -> None:
    """Paint one dashed curve."""
    x0, y0, x1, y1, x2, y2, x3, y3 = shape
    length = math.dist((x0, y0), (x1, y1)) + math.dist((x1, y1), (x2, y2)) + math.dist((x2, y2), (x3, y3))
    count = min(max(int(length / ((DASH + HOLE) * max(1.0, 0.5 / brush.zoom))), 2), 64)
    for index in range(count):
        ends: list[Point] = []
        for t in (index / count, (index + DASH / (DASH + HOLE)) / count):
            u = 1.0 - t
            a, b, c, d = u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t
            ends.append(brush.to.to_screen(a * x0 + b * x1 + c * x2 + d * x3, a * y0 + b * y1 + c * y2 + d * y3))
        brush.draw.add_line(ends[0], ends[1], color, thickness * brush.line)


def paint_band(brush: DrawContext, rect: Rect) -> None:
    """Paint the selection rectangle."""
    brush.fill_rect(rect, brush.ink.accent_soft, 2.0)
    brush.draw_outline(rect, brush.ink.accent, 2.0)


def paint_cut(brush: DrawContext, start: Point, end: Point, color: int) -> None:
    """Paint the line that cuts links or puts dots on them."""
    brush.draw.add_line(brush.to.to_screen(*start), brush.to.to_screen(*end), color, 2.0 * brush.line)
    brush.draw.add_circle_filled(brush.to.to_screen(*start), 3.0 * brush.line, color)


def paint_note(brush: DrawContext, x: float, y: float, text: str, color: int) -> None:
    """Paint a sentence beside the pointer, on top of everything; `x`, `y` and sizes are pixels of the screen."""
    scale = brush.to.scale / brush.zoom
    draw = imgui.get_foreground_draw_list()
    size, wrap = TEXT * scale, 340.0 * scale
    font = brush.fonts.text
    imgui.push_font(font, TEXT)
    area = imgui.calc_text_size(text, wrap_width=wrap)
    imgui.pop_font()
    low = x + 16.0 * scale, y + 14.0 * scale
    pad = 7.0 * scale
    high = low[0] + area.x + pad * 2, low[1] + area.y + pad * 1.6
    draw.add_rect_filled(low, high, u32(brush.ink.palette.window, 0.96), 5.0 * scale)
    draw.add_rect(low, high, color, 5.0 * scale)
    draw.add_text(font, size, (low[0] + pad, low[1] + pad * 0.8), color, text, wrap)


def paint_hint(brush: DrawContext, panel: Rect, lines: tuple[str, ...]) -> None:
    """Paint a hint on an empty canvas, above the ends of the graph, which lie in the middle."""
    scale = brush.to.scale / brush.zoom
    x, y = (panel[0] + panel[2]) / 2, panel[1] + (panel[3] - panel[1]) * 0.14
    for index, line in enumerate(lines):
        size = (18.0 if index == 0 else TEXT) * scale
        font = brush.fonts.bold if index == 0 else brush.fonts.text
        width = brush.texts.measure(brush.fonts, line, size, index == 0)
        brush.draw.add_text(font, size, (x - width / 2, y), brush.ink.dim, line)
        y += size * 1.7


def _is_visible(brush: DrawContext, shape: Curve) -> bool:
    left, top, right, bottom = brush.visible
    xs, ys = shape[0::2], shape[1::2]
    return max(xs) >= left and min(xs) <= right and max(ys) >= top and min(ys) <= bottom
