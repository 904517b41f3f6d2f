"""Draws the axes of the world in a corner of the panel."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from halation.nodes import CameraModel
from imgui_bundle import imgui

from ..theme.palette import RGB
from ..theme.style import mix, u32, ui_scale
from .geometry import Point, Sight
from .orbit import Orbit, aspect_of, scene_at
from .strokes import BLACK, WHITE, around

if TYPE_CHECKING:
    from .context import ViewerContext

_BRIGHT = 0.8
"""The length of a color from which on black letters can be read on it better than white ones. Chosen by eye."""

_COLORS: dict[str, RGB] = {"x": (0.95, 0.30, 0.33), "y": (0.42, 0.78, 0.25), "z": (0.30, 0.56, 0.98)}
_ARM, _MARGIN, _KNOB = 30.0, 16.0, 7.5
"""Lengths at UI scale 1."""


def axes(camera: CameraModel) -> tuple[tuple[str, Point, float], ...]:
    """The axes x, y and z in camera space, the farthest first: right, down and depth."""
    arms = [(name, (camera.right[at], camera.down[at]), camera.forward[at]) for at, name in enumerate("xyz")]
    return tuple(sorted(arms, key=lambda axis: -axis[2]))


def draw_axes(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw the axes of the orbited scene in the lower left corner."""
    scene, scale = scene_at(context), ui_scale()
    if scene is None:
        return
    arm, reach = _ARM * scale, (_ARM + _KNOB) * scale
    x = sight.origin[0] + _MARGIN * scale + reach
    y = sight.origin[1] + sight.panel[1] / sight.density - _MARGIN * scale - reach
    lines.add_circle_filled((x, y), reach + 4.0 * scale, u32(BLACK, 0.35))
    context.places["viewer axes"] = around((x, y), reach)
    for name, (right, down), ahead in axes(Orbit.of(scene).camera(aspect_of(context))):
        color = mix(_COLORS[name], BLACK, 0.25 + 0.25 * ahead)
        end = x + right * arm, y + down * arm
        lines.add_line((x, y), end, u32(color), 2.5 * scale)
        lines.add_circle_filled(end, _KNOB * scale, u32(color))
        size = imgui.calc_text_size(name.upper())
        ink = BLACK if math.hypot(*color) > _BRIGHT else WHITE
        lines.add_text((round(end[0] - size.x / 2), round(end[1] - size.y / 2)), u32(ink), name.upper())
        context.places[f"axis {name}"] = around(end, _KNOB * scale)
