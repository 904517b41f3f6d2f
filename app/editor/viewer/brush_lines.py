"""Draws the brush over the picture: a circle at the pointer, what a clone copies, the path of the selected stroke."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import PaintTool
from imgui_bundle import imgui

from ...language.translation import translate
from ..theme.style import u32, ui_scale
from .geometry import Sight
from .painting import find_chosen_stroke, measure_brush, paints
from .strokes import BLACK, CHOSEN, SHADE, WHITE, cross, draw_label, draw_path

if TYPE_CHECKING:
    from .context import ViewerContext


def draw_brush(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw what belongs to the brush while it paints."""
    if not paints(context):
        return
    viewer, brush, scale = context.viewer, context.viewer.brush, ui_scale()
    stroke = None if brush.stroke else find_chosen_stroke(context)
    if stroke is not None and len(stroke.rows) > 1:
        move = stroke.position
        draw_path(lines, [sight.place((x + move[0], y + move[1])) for x, y, _ in stroke.rows], CHOSEN, 1.0)
    if not viewer.hovered:
        return
    mouse = imgui.get_mouse_pos()
    at, radius = (mouse.x, mouse.y), max(measure_brush(context, sight), 1.0)
    inner = radius * brush.hardness
    for shade, width in ((u32(BLACK, SHADE), 3.0), (u32(WHITE), 1.2)):
        lines.add_ellipse(at, (radius * sight.stretch, radius), shade, 0.0, 0, width * scale)
    if inner < radius - 3.0 * scale:
        lines.add_ellipse(at, (inner * sight.stretch, inner), u32(WHITE, 0.5), 0.0, 0, scale)
    if brush.tool is PaintTool.CLONE:
        _draw_copied(context, lines, sight)
    if brush.needs_place:
        draw_label(lines, (at[0], at[1] + radius + 14.0 * scale), translate("Click with Alt on what is to be copied"))


def _draw_copied(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw a cross where a clone copies from."""
    brush, mouse = context.viewer.brush, imgui.get_mouse_pos()
    place = brush.copied
    if place is None and brush.offset is not None:
        x, y = sight.fraction((mouse.x, mouse.y))
        place = x + brush.offset[0], y + brush.offset[1]
    if place is not None:
        cross(lines, sight.place(place), 7.0 * ui_scale())
