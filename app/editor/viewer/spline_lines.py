"""Draws splines over the picture: outlines, and points and tangents of the selected shape."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ...language.translation import translate
from ..theme.style import u32, ui_scale
from .geometry import Point, Sight
from .grips import draw_grip, is_near
from .spline_edits import find_drawn, find_pen_frame
from .splines import SplineOutline, find_selected, list_keyed, list_outlines, list_tangents, place_feather
from .strokes import BLACK, CHOSEN, SHADE, WHITE, around, draw_label, draw_path

if TYPE_CHECKING:
    from .context import ViewerContext


def draw_splines(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw all shapes of the active node, and what the pen is about to add."""
    pen, mouse = context.viewer.pen, imgui.get_mouse_pos()
    for outline in list_outlines(context):
        color = CHOSEN if outline.chosen else WHITE
        for index in range(len(outline.points)):
            draw_path(lines, [sight.place(place) for place in outline.trace_curve(index)], color)
        if outline.chosen:
            _draw_points(context, lines, sight, outline, (mouse.x, mouse.y))
    if len(pen.lasso) > 1:
        draw_path(lines, [sight.place(place) for place in (*pen.lasso, pen.lasso[0])], CHOSEN, 1.0)
    if pen.pending is not None:
        outline = find_pen_frame(context)
        places = [
            pen.pending[:2],
            *((pen.pending[0] + pen.pending[at], pen.pending[1] + pen.pending[at + 1]) for at in (2, 4)),
        ]
        middle, *ends = (sight.place(outline.to_picture((x, y)) if outline else (x, y)) for x, y in places)
        draw_path(lines, [ends[0], middle, ends[1]], WHITE, 1.0)
        draw_grip(lines, middle, "corner", is_lit=True)
    if pen.is_drawing and context.viewer.hovered:
        draw_label(lines, (mouse.x, mouse.y + 24.0 * ui_scale()), _describe_pen(context))


def _describe_pen(context: ViewerContext) -> str:
    """What the next press of the pen does."""
    if find_drawn(context) is None:
        return translate("Click: a corner. Drag: a smooth point")
    return translate("Click the first point to close the shape, or press N")


def _draw_points(
    context: ViewerContext, lines: imgui.ImDrawList, sight: Sight, outline: SplineOutline, mouse: Point
) -> None:
    """Draw the points of the selected shape; tangents and feather of a point that is the only selected one."""
    selected, scale = find_selected(context, outline), ui_scale()
    if len(selected) == 1:
        (number,) = selected
        ends = {f"tangent {part}": sight.place(place) for part, place in list_tangents(outline, number)}
        ends["feather"] = place_feather(outline, sight, number, scale)
        for name, at in ends.items():
            draw_path(lines, [sight.place(outline.places[number]), at], WHITE, 1.0)
            draw_grip(lines, at, "size" if name == "feather" else "turn", is_lit=is_near(at, mouse))
            context.places[f"{name} {outline.points_port}"] = around(at, 5.0 * scale)
    keyed = list_keyed(context, outline)
    for index, place in enumerate(outline.places):
        at, size = sight.place(place), 3.5 * scale
        color = CHOSEN if index in selected or is_near(at, mouse) else WHITE
        for grown, ink in ((1.5 * scale, u32(BLACK, SHADE)), (0.0, u32(color))):
            reach = size + grown
            if index in keyed:
                lines.add_ngon_filled(at, 1.5 * reach, ink, 4)
            else:
                lines.add_rect_filled((at[0] - reach, at[1] - reach), (at[0] + reach, at[1] + reach), ink)
        if keyed.get(index):
            lines.add_ngon_filled(at, 2.2 * scale, u32(BLACK), 4)
        context.places[f"point {index} {outline.points_port}"] = around(at, 5.0 * scale)
