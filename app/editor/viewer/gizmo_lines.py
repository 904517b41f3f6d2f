"""Draws the gizmos of the active node over the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui
from msgspec.structs import replace

from ..theme.style import u32, ui_scale
from .box_gizmos import RectangleGizmo
from .focus import distance_in_words, find_focus_port
from .geometry import Point, Sight
from .gizmos import Gizmo, GizmoGrip, GizmoOutline
from .grips import draw_grip, is_near
from .ground import depth_at
from .handles import list_gizmos, place_grip
from .strokes import BLACK, CHOSEN, SHADE, WHITE, around, draw_dashed_circle, draw_label, draw_path

if TYPE_CHECKING:
    from .context import ViewerContext


def draw_gizmos(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw grips, outlines and labels, and the lines to which a drag has snapped."""
    mouse = imgui.get_mouse_pos()
    for gizmo in list_gizmos(context, sight, ui_scale()):
        moving = _preview(context, gizmo)
        near = [grip for grip in moving.grips if is_near(place_grip(sight, grip.at, ui_scale()), (mouse.x, mouse.y))]
        lit = near[-1] if near and context.viewer.hovered else None
        for outline in moving.outlines:
            if outline.part is None or (lit is not None and outline.part == lit.part):
                _draw_outline(lines, sight, outline)
        for grip in moving.grips:
            _draw_grip(context, lines, sight, grip, is_lit=grip is lit)
    _draw_guides(context, lines, sight)


def _preview(context: ViewerContext, gizmo: Gizmo) -> Gizmo:
    """The gizmo as its drag will leave it, where that counts only when the button is released."""
    values = context.viewer.deferred
    if values is None or not isinstance(gizmo, RectangleGizmo) or gizmo.top_left not in values:
        return gizmo
    top_left, bottom_right = values[gizmo.top_left], values[gizmo.bottom_right]
    assert isinstance(top_left, tuple) and isinstance(bottom_right, tuple)
    return replace(gizmo, box=(*top_left, *bottom_right))


def _draw_outline(lines: imgui.ImDrawList, sight: Sight, outline: GizmoOutline) -> None:
    points = [sight.screen(point) for point in outline.points]
    if outline.radius > 0.0:
        draw_dashed_circle(lines, points[0], outline.radius * sight.pixel_size[1], WHITE, sight.stretch)
    elif len(points) > 1:
        draw_path(lines, points, WHITE, closed=outline.is_closed)


def _draw_grip(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight, grip: GizmoGrip, *, is_lit: bool) -> None:
    at, scale = place_grip(sight, grip.at, ui_scale()), ui_scale()
    draw_grip(lines, at, grip.shape, is_lit=is_lit)
    words = [f"{grip.port}  {_format(context, grip)}"] if is_lit else []
    if grip.port == find_focus_port(context.session) and grip.shape == "place":
        place = grip.at[0] / sight.picture[0], grip.at[1] / sight.picture[1]
        words.append(distance_in_words(depth_at(context, place)))
    if words:
        context.places[f"label {grip.port}"] = draw_label(lines, (at[0], at[1] + 20 * scale), "  ".join(words))
    context.places[f"handle {grip.id}"] = around(at, 6.0 * scale)


def _format(context: ViewerContext, grip: GizmoGrip) -> str:
    """The number of a grip as text."""
    value = (context.viewer.deferred or {}).get(grip.port)
    value = context.session.time.evaluated_graph.value(grip.port) if value is None else value
    numbers = value if isinstance(value, tuple) else (value,)
    return ", ".join(f"{number:.4g}" for number in numbers if isinstance(number, int | float))


def _draw_guides(context: ViewerContext, lines: imgui.ImDrawList, sight: Sight) -> None:
    """Draw what the dragged grip has snapped to, across the whole picture."""
    width, height = sight.picture
    for guide in context.viewer.guides:
        ends: tuple[Point, Point] = (
            ((guide.at, 0.0), (guide.at, height)) if guide.axis == "x" else ((0.0, guide.at), (width, guide.at))
        )
        start, end = (sight.screen(point) for point in ends)
        lines.add_line(start, end, u32(BLACK, SHADE), 3.0 * ui_scale())
        lines.add_line(start, end, u32(CHOSEN), 1.2 * ui_scale())
