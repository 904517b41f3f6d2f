"""Draws the grips of handles, all alike: what can be dragged is white on black, the one under the mouse is orange.

The shape says what a drag does: a ring moves a place, a square a corner or an edge, a dot on a line turns, a dot on a
dashed circle changes a size, a diamond skews.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

from imgui_bundle import imgui

from ..theme.style import u32, ui_scale
from .geometry import Point
from .strokes import BLACK, CHOSEN, SHADE, WHITE, cross

GripShape = Literal["place", "corner", "turn", "size", "skew"]

GRIP_REACH = 9.6
"""The distance at which a grip is under the mouse, in pixels at UI scale 1: its radius, and the width of its line."""

_TURNS: Mapping[str, float] = MappingProxyType({"corner": math.pi / 4.0, "skew": 0.0})
_RADII: Mapping[str, float] = MappingProxyType({"place": 5.0, "corner": 5.0, "turn": 4.5, "size": 4.5, "skew": 6.0})


def is_near(at: Point, mouse: Point) -> bool:
    """True if a grip is under the mouse."""
    return math.dist(at, mouse) <= GRIP_REACH * ui_scale()


def draw_grip(lines: imgui.ImDrawList, at: Point, shape: GripShape, *, is_lit: bool = False) -> None:
    """Draw one grip; lit if it is under the mouse, dragged or selected."""
    scale, color, radius = ui_scale(), CHOSEN if is_lit else WHITE, _RADII[shape] * ui_scale()
    if shape == "place":
        cross(lines, at, 9.0 * scale, color)
        lines.add_circle(at, radius, u32(BLACK, SHADE), 0, 3.0 * scale)
        lines.add_circle(at, radius, u32(color), 0, 1.5 * scale)
    elif shape in _TURNS:
        for grown, ink in ((1.5 * scale, u32(BLACK, SHADE)), (0.0, u32(color))):
            lines.add_convex_poly_filled(_find_corners(at, radius + grown, _TURNS[shape]), ink)
    else:
        lines.add_circle_filled(at, radius + 1.5 * scale, u32(BLACK, SHADE))
        lines.add_circle_filled(at, radius, u32(color))


def _find_corners(at: Point, radius: float, first_angle: float) -> list[imgui.ImVec2Like]:
    angles = (first_angle + index * math.pi / 2.0 for index in range(4))
    return [imgui.ImVec2(at[0] + radius * math.cos(angle), at[1] + radius * math.sin(angle)) for angle in angles]
