"""Lines and labels of overlays, readable over any picture."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from imgui_bundle import imgui

from ..theme.palette import RGB
from ..theme.style import u32, ui_scale
from .geometry import Box, Point

WHITE: RGB = (1.0, 1.0, 1.0)
BLACK: RGB = (0.0, 0.0, 0.0)
"""Lines over pictures of any color: white on black, whatever the theme."""

CHOSEN: RGB = (1.0, 0.62, 0.30)
"""The color of what is selected, or under the mouse."""

SHADE = 0.6
"""Opacity of the black below lines."""

_DASH = 5.0


def cross(lines: imgui.ImDrawList, at: Point, arm: float, color: RGB = WHITE) -> None:
    """Two thin lines."""
    x, y = at
    for shade, width in ((u32(BLACK, SHADE), 3.0), (u32(color), 1.0)):
        lines.add_line((x - arm, y), (x + arm, y), shade, width)
        lines.add_line((x, y - arm), (x, y + arm), shade, width)


def frame(lines: imgui.ImDrawList, box: Box, color: RGB = WHITE) -> None:
    """A thin rectangle."""
    lines.add_rect(box[:2], box[2:], u32(BLACK, SHADE), 0.0, 3.0)
    lines.add_rect(box[:2], box[2:], u32(color), 0.0, 1.0)


def draw_path(
    lines: imgui.ImDrawList, points: Sequence[Point], color: RGB, width: float = 1.5, *, closed: bool = False
) -> None:
    """A line through points."""
    scale, around = ui_scale(), [*points, *points[:1]] if closed else [*points]
    for shade, thick in ((u32(BLACK, SHADE), width + 1.5), (u32(color), width)):
        for first, second in itertools.pairwise(around):
            lines.add_line(first, second, shade, thick * scale)


def draw_dashed_circle(lines: imgui.ImDrawList, center: Point, radius: float, color: RGB, stretch: float = 1.0) -> None:
    """A thin circle of dashes, wider by `stretch`."""
    length = _DASH * ui_scale()
    count = min(max(round(math.pi * radius / length), 8), 360)
    for shade, width in ((u32(BLACK, SHADE), 2.5), (u32(color), 1.2)):
        for dash in range(count):
            start = 2.0 * math.pi * dash / count
            lines.path_elliptical_arc_to(center, (radius * stretch, radius), 0.0, start, start + math.pi / count)
            lines.path_stroke(shade, width * ui_scale())


def draw_label(lines: imgui.ImDrawList, center: Point, text: str) -> Box:
    """Draw a label centered on a point; returns its rectangle."""
    size = imgui.calc_text_size(text)
    x, y = round(center[0] - size.x / 2), round(center[1] - size.y / 2)
    pad = 3.0 * ui_scale()
    box = x - pad, y, x + size.x + pad, y + size.y
    lines.add_rect_filled(box[:2], box[2:], u32(BLACK, SHADE), pad)
    lines.add_text((x, y), u32(WHITE), text)
    return box


def around(at: Point, reach: float) -> Box:
    """The square around a point."""
    return at[0] - reach, at[1] - reach, at[0] + reach, at[1] + reach
