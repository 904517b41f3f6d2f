"""Draws overlays over the picture: grid, region, wipe, handles, lights, markers and messages."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ..theme.palette import RGB
from ..theme.style import u32, ui_scale
from .axes import draw_axes
from .brush_lines import draw_brush
from .focus import distance_in_words, find_focus_port, is_distance
from .geometry import GRID_FROM, Box, Point, Sight, wipe_direction
from .gizmo_lines import draw_gizmos
from .ground import depth_at
from .holding import ARM
from .lamp_lines import draw_dome, draw_lamps
from .mattes import draw_name
from .spline_lines import draw_splines
from .strokes import BLACK, WHITE, around, cross, draw_label, frame

if TYPE_CHECKING:
    from .context import ViewerContext


def draw_overlays(context: ViewerContext, sight: Sight) -> None:
    """Draw all overlays with a place on the picture."""
    lines = imgui.get_window_draw_list()
    if sight.zoom >= GRID_FROM:
        _grid(lines, sight)
    viewer = context.viewer
    if viewer.region is not None:
        _region(context, lines, sight.rectangle(viewer.region))
    if viewer.measured is not None:
        frame(lines, sight.rectangle(viewer.measured), context.palette.accent)
    for number, marker in enumerate(viewer.markers, 1):
        _marker(lines, sight.place(marker), str(number))
    if viewer.compare == "wipe" and context.session.views.find_port("B") is not None:
        _wipe(context, lines, sight)
    draw_splines(context, lines, sight)
    draw_brush(context, lines, sight)
    draw_gizmos(context, lines, sight)
    draw_lamps(context, lines, sight)
    draw_dome(context, lines, sight)
    if viewer.orbits or (viewer.scene and viewer.hovered and imgui.get_io().key_alt):
        draw_axes(context, lines, sight)
    _draw_picked_depth(context, lines, sight)
    draw_name(context, sight)


def draw_outline(context: ViewerContext, sight: Sight) -> None:
    """Draw the edge of the frame, where the picture goes on beyond it."""
    context.places["viewer frame"] = box = sight.rectangle((0.0, 0.0, 1.0, 1.0))
    frame(imgui.get_window_draw_list(), box)


def _grid(lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw lines between the visible pixels."""
    left, top, right, bottom = _visible(sight)
    color = u32(WHITE, min((sight.zoom - GRID_FROM) / 16.0, 1.0) * 0.16 + 0.04)
    x0, y0 = sight.screen((left, top))
    x1, y1 = sight.screen((right, bottom))
    across, down = sight.pixel_size
    for index in range(right - left + 1):
        lines.add_line((x0 + index * across, y0), (x0 + index * across, y1), color)
    for index in range(bottom - top + 1):
        lines.add_line((x0, y0 + index * down), (x1, y0 + index * down), color)


def _visible(sight: Sight) -> tuple[int, int, int, int]:
    """The visible pixels: left, top, right, bottom."""
    (left, top), (right, bottom) = (sight.pixel(corner) for corner in _corners(sight))
    width, height = sight.picture
    return (
        max(math.floor(left), 0),
        max(math.floor(top), 0),
        min(math.ceil(right), width),
        min(math.ceil(bottom), height),
    )


def _corners(sight: Sight) -> tuple[Point, Point]:
    width, height = (length / sight.density for length in sight.panel)
    return sight.origin, (sight.origin[0] + width, sight.origin[1] + height)


def _region(context: ViewerContext, lines: imgui.ImDrawList, box: Box) -> None:
    left, top, right, bottom = box
    frame(lines, box)
    size = 3.5 * ui_scale()
    middle = (left + right) / 2, (top + bottom) / 2
    for x in (left, middle[0], right):
        for y in (top, middle[1], bottom):
            if (x, y) != middle:
                lines.add_rect_filled((x - size, y - size), (x + size, y + size), u32(BLACK, 0.7))
                lines.add_rect_filled((x - size + 1, y - size + 1), (x + size - 1, y + size - 1), u32(WHITE))
    cross(lines, middle, 5.0 * ui_scale())
    context.places["viewer region"] = box


def _wipe(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw the grips of the wipe line; the display draws the line."""
    viewer, scale = context.viewer, ui_scale()
    x, y = sight.place(viewer.wipe)
    dx, dy = wipe_direction(viewer.wipe_angle)
    end = x + dx * ARM * scale, y + dy * ARM * scale
    for color, width in ((u32(BLACK, 0.6), 4.0), (u32(WHITE), 2.0)):
        lines.add_line((x, y), end, color, width * scale)
        lines.add_circle_filled((x, y), (width + 4.0) * scale, color)
        lines.add_circle_filled(end, (width + 2.5) * scale, color)
    for name, away in (("A", -1.0), ("B", 1.0)):
        at = x + dy * away * 18 * scale, y - dx * away * 18 * scale
        draw_label(lines, at, name)
    context.places["viewer wipe"] = around((x, y), 6.0 * scale)
    context.places["viewer wipe angle"] = around(end, 6.0 * scale)


def _draw_picked_depth(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw the depth under the pointer while a distance is picked."""
    viewer, port = context.viewer, find_focus_port(context.session)
    if not viewer.hovered or port is None or viewer.picking != str(port) or not is_distance(port):
        return
    mouse, scale = imgui.get_mouse_pos(), ui_scale()
    words = distance_in_words(depth_at(context, sight.fraction((mouse.x, mouse.y))))
    context.places[f"label {port}"] = draw_label(lines, (mouse.x, mouse.y + 26 * scale), words)


def _marker(lines: imgui.ImDrawList, at: Point, text: str) -> None:
    scale = ui_scale()
    cross(lines, at, 6.0 * scale)
    draw_label(lines, (at[0] + 10 * scale, at[1] - 10 * scale), text)


# --- messages ------------------------------------------------------------------------------------------------------


def draw_progress(context: ViewerContext, sight: Sight, fraction: float) -> None:
    """Draw progress as a thin line at the top."""
    (left, top), (right, _) = _corners(sight)
    lines, height = imgui.get_window_draw_list(), 2.0 * ui_scale()
    lines.add_rect_filled((left, top), (right, top + height), u32(BLACK, 0.4))
    lines.add_rect_filled((left, top), (left + (right - left) * fraction, top + height), u32(context.palette.accent))


def draw_message(context: ViewerContext, sight: Sight, text: str, color: RGB, dim: bool = False) -> None:
    """Draw a sentence in the middle of the panel; `dim` darkens the background."""
    (left, top), (right, bottom) = _corners(sight)
    palette, scale = context.palette, ui_scale()
    lines = imgui.get_window_draw_list()
    if dim:
        lines.add_rect_filled((left, top), (right, bottom), u32(palette.surround, 0.6))
    width = min((right - left) - 48 * scale, 520 * scale)
    if width < 40 * scale:
        return
    size = imgui.calc_text_size(text, wrap_width=width)
    x, y = round((left + right - size.x) / 2), round((top + bottom - size.y) / 2)
    pad = 12 * scale
    box = (x - pad, y - pad), (x + size.x + pad, y + size.y + pad)
    lines.add_rect_filled(*box, u32(palette.panel, 0.94), 6 * scale)
    lines.add_rect(*box, u32(color, 0.35), 6 * scale)
    lines.add_text(imgui.get_font(), imgui.get_font_size(), (x, y), u32(color), text, wrap_width=width)
    context.places["viewer message"] = (*box[0], *box[1])


def draw_badge(context: ViewerContext, sight: Sight, text: str, color: RGB) -> Box:
    """Draw a label in the upper right corner; returns its rectangle."""
    (_, top), (right, _) = _corners(sight)
    palette, scale = context.palette, ui_scale()
    size, pad = imgui.calc_text_size(text), 5 * scale
    box = right - size.x - 3 * pad, top + 2 * pad, right - pad, top + 2 * pad + size.y + pad
    lines = imgui.get_window_draw_list()
    lines.add_rect_filled(box[:2], box[2:], u32(palette.panel, 0.9), 4 * scale)
    lines.add_rect(box[:2], box[2:], u32(color, 0.7), 4 * scale)
    lines.add_text((box[0] + pad, box[1] + pad / 2), u32(color), text)
    return box
