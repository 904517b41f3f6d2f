"""Draws lights over the picture."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from halation.nodes import Light, LightKind
from imgui_bundle import imgui

from ...language.translation import translate
from ..fields.colors import swatch
from ..shared.declared_words import name_value
from ..theme.palette import RGB
from ..theme.style import mix, u32, ui_scale
from .dome import RADIUS, knob_of, middle_of
from .geometry import Point, Sight
from .lamp_outlines import cone, outline, sides
from .light_sizes import SizeHandle, list_size_handles
from .lights import Lamp, lamps, suns
from .perspective import Place, dot, project, unit
from .strokes import BLACK, CHOSEN, SHADE, WHITE, around, draw_dashed_circle, draw_label, draw_path

if TYPE_CHECKING:
    from .context import ViewerContext

_RINGS = 14


def draw_lamps(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw a disk for each light and a line to the target of a spot; for the selected one also range and cones."""
    mouse = imgui.get_mouse_pos()
    at_mouse, reach = (mouse.x, mouse.y), 10.0 * ui_scale()
    for lamp in lamps(context):
        at = sight.place(lamp.at)
        near = math.dist(at_mouse, at) <= reach
        ring = CHOSEN if near or lamp.chosen else WHITE
        if lamp.chosen:
            _extent(context, lines, sight, lamp, ring)
        if lamp.aims:
            _goal(context, lines, sight, lamp, ring, near=math.dist(at_mouse, sight.place(lamp.aims[0])) <= reach)
        _knob(lines, at, lamp.light, ring)
        if near or (lamp.chosen and context.interface.dragging and context.viewer.hovered):
            words = f"{lamp.name}  depth {lamp.depth:.4g}"
            context.places[f"label {lamp.port} {lamp.name}"] = draw_label(lines, (at[0], at[1] + 2.0 * reach), words)
        context.places[f"handle {lamp.port} {lamp.name}"] = around(at, 0.6 * reach)


def draw_dome(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw the sun dome: a ball lit by the selected sun, and a knob for every sun."""
    visible_suns, scale = suns(context), ui_scale()
    if not visible_suns:
        return
    middle, mouse, last = middle_of(sight, scale), imgui.get_mouse_pos(), visible_suns[-1]
    lines.add_circle_filled(middle, (RADIUS + 4.0) * scale, u32(BLACK, 0.45))
    _ball(lines, middle, 0.5 * RADIUS * scale, last)
    draw_dashed_circle(lines, middle, 0.5 * RADIUS * scale, mix(BLACK, WHITE, 0.6))
    lines.add_circle(middle, RADIUS * scale, u32(WHITE, 0.6), 0, 1.2 * scale)
    for sun in visible_suns:
        at = knob_of(sight, scale, sun.camera, sun.light.direction)
        near = math.dist((mouse.x, mouse.y), at) <= 10.0 * scale
        if sun.chosen:
            lines.add_line(at, middle, u32(BLACK, SHADE), 3.0 * scale)
            lines.add_line(at, middle, u32(WHITE), 1.5 * scale)
        _knob(lines, at, sun.light, CHOSEN if near or sun.chosen else WHITE)
        if near:
            draw_label(lines, (at[0], at[1] - 20.0 * scale), sun.name)
        context.places[f"handle {sun.port} {sun.name}"] = around(at, 6.0 * scale)
    context.places["viewer dome"] = around(middle, RADIUS * scale)


def _knob(lines: imgui.ImDrawList, at: Point, light: Light, ring: RGB) -> None:
    """Draw the knob of a light in its color; black if it is off, with a bar if it is negative."""
    scale = ui_scale()
    lines.add_circle_filled(at, 7.5 * scale, u32(BLACK, SHADE))
    lines.add_circle_filled(at, 6.0 * scale, u32(ring))
    color = swatch(light.color) if light.on else BLACK
    lines.add_circle_filled(at, 4.5 * scale, u32(color))
    if light.intensity < 0.0:
        ink, half = BLACK if sum(color) > 1.5 else WHITE, 3.0 * scale
        lines.add_line((at[0] - half, at[1]), (at[0] + half, at[1]), u32(ink), 1.5 * scale)


def _goal(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight, lamp: Lamp, ring: RGB, *, near: bool) -> None:
    """Draw the target of a spot: a ring at the end of a line."""
    assert lamp.aims is not None
    scale, (goal_point, depth) = ui_scale(), lamp.aims
    end, color = sight.place(goal_point), CHOSEN if near else ring
    draw_path(lines, (sight.place(lamp.at), end), ring)
    lines.add_circle(end, 5.0 * scale, u32(BLACK, SHADE), 0, 3.5 * scale)
    lines.add_circle(end, 5.0 * scale, u32(color), 0, 2.0 * scale)
    if near:
        words = translate("{name} shines here  depth {depth:.4g}", name=lamp.name, depth=depth)
        context.places[f"label goal {lamp.port} {lamp.name}"] = draw_label(lines, (end[0], end[1] + 20 * scale), words)
    context.places[f"goal {lamp.port} {lamp.name}"] = around(end, 6.0 * scale)


def _extent(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight, lamp: Lamp, color: RGB) -> None:
    """Draw the range as a dashed circle, the radius of a sphere, the edges of an area, and the cones of a spot."""
    light, at = lamp.light, sight.place(lamp.at)
    unit_size = lamp.camera.focal[0] * sight.picture[0] * sight.zoom / sight.density / lamp.depth
    if light.reach > 0.0:
        draw_dashed_circle(lines, at, light.reach * unit_size, color)
    if light.kind is LightKind.SPHERE:
        lines.add_circle(at, light.size * unit_size, u32(BLACK, SHADE), 0, 3.0 * ui_scale())
        lines.add_circle(at, light.size * unit_size, u32(color), 0, 1.5 * ui_scale())
    for edge in outline(light):
        if points := _project_places(sight, lamp, edge):
            draw_path(lines, points, color, 1.5, closed=True)
    for handle in list_size_handles(sight, lamp):
        _size_handle(context, lines, handle, color)
    for angle, width in ((light.outer, 1.5), (light.inner, 0.8)):
        rim = _project_places(sight, lamp, cone(lamp, angle)) if light.kind is LightKind.SPOT else []
        if not rim:
            continue
        draw_path(lines, rim, color, width, closed=True)
        if angle == light.outer:
            for corner in sides(at, rim):
                draw_path(lines, (at, corner), color, width)


def _size_handle(context: ViewerContext, lines: imgui.ImDrawList, handle: SizeHandle, color: RGB) -> None:
    """Draw a square at the end of a size; with its number while the pointer is there, or holds it."""
    scale, (x, y), mouse = ui_scale(), handle.end, imgui.get_mouse_pos()
    near = math.dist((mouse.x, mouse.y), handle.end) <= 10.0 * scale
    for half, ink in ((5.0, u32(BLACK, SHADE)), (3.5, u32(CHOSEN if near else color))):
        lines.add_rect_filled((x - half * scale, y - half * scale), (x + half * scale, y + half * scale), ink)
    if near:
        number = getattr(handle.lamp.light, handle.field)
        draw_label(lines, (x, y + 20.0 * scale), f"{name_value(handle.field)}  {number:.4g}")
    context.places[f"size {handle.field} {handle.lamp.port} {handle.lamp.name}"] = around(handle.end, 5.0 * scale)


def _project_places(sight: Sight, lamp: Lamp, places: list[Place]) -> list[Point]:
    """Positions on the screen; none if any of them is behind the camera."""
    projections = [project(lamp.camera, place) for place in places]
    if any(projection is None or projection[2] < 0.02 * lamp.depth for projection in projections):
        return []
    return [sight.place(projection[:2]) for projection in projections if projection is not None]


def _ball(lines: imgui.ImDrawList, middle: Point, radius: float, sun: Lamp) -> None:
    """Rings that shrink towards where the light comes from: brighter, the more of it comes from the camera's side."""
    aim, color = unit(sun.light.direction), swatch(sun.light.color) if sun.light.on else BLACK
    x, y, ahead = -dot(sun.camera.right, aim), -dot(sun.camera.down, aim), dot(sun.camera.forward, aim)
    for ring in range(_RINGS):
        part = ring / (_RINGS - 1)
        light = min(max((part + ahead) / (1.0 + abs(ahead)), 0.0), 1.0)
        away = radius * part * 0.9
        center = middle[0] + x * away, middle[1] + y * away
        lines.add_circle_filled(center, radius * (1.0 - 0.9 * part), u32(mix((0.1, 0.1, 0.1), color, light)))
