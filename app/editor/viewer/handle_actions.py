"""Actions of handles in the viewer: the camera of a scene, lights and focus."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..shared.action import Action
from .focus import find_focus_port, pick_focus
from .lights import can_remove, remove_chosen_light
from .orbit import frame_scene
from .painting import can_paint, paints, scale_brush, toggle_brush
from .spline_edits import can_draw, can_remove_points, remove_points, toggle_pen

if TYPE_CHECKING:
    from .context import ViewerContext


def _orbit(context: ViewerContext) -> None:
    context.viewer.orbiting = not context.viewer.orbiting


def _has_scene(context: ViewerContext) -> bool:
    return context.viewer.scene != ""


def _picks(context: ViewerContext) -> bool:
    port = find_focus_port(context.session)
    return port is not None and context.viewer.picking == str(port)


def _toggle_gizmos(context: ViewerContext) -> None:
    context.viewer.has_gizmos = not context.viewer.has_gizmos


def _remove_chosen(context: ViewerContext) -> None:
    if can_remove_points(context):
        remove_points(context)
    else:
        remove_chosen_light(context)


HANDLES: tuple[Action[ViewerContext], ...] = (
    Action(
        "viewer.gizmos",
        "Show Handles",
        _toggle_gizmos,
        "Viewer/Handles",
        "H",
        "viewer",
        checked=lambda context: context.viewer.has_gizmos,
        contexts=frozenset({"viewer"}),
        doc="Show the handles of positions and lights on the picture. Hidden ones cannot be dragged.",
    ),
    Action(
        "viewer.orbit",
        "Orbit Scene",
        _orbit,
        "Viewer/Handles",
        "O",
        "viewer",
        _has_scene,
        lambda context: context.viewer.orbits,
        contexts=frozenset({"viewer"}),
        doc="Drag to orbit the camera of the viewed scene; Shift or the middle button pans, the wheel moves nearer. "
        "Space and drag pans the picture. Hold Alt to orbit without this mode.",
    ),
    Action(
        "viewer.frame_scene",
        "Frame Scene",
        frame_scene,
        "Viewer/Handles",
        "Home",
        "viewer",
        _has_scene,
        contexts=frozenset({"viewer"}),
        doc="Move the camera so that the whole scene is visible; a floor "
        "or backdrop as wide as everything does not count.",
    ),
    Action(
        "viewer.pick_focus",
        "Pick Focus",
        pick_focus,
        "Viewer/Handles",
        "E",
        "viewer",
        lambda context: find_focus_port(context.session) is not None,
        _picks,
        doc="Click on the picture to focus the selected depth of field node there.",
    ),
    Action(
        "viewer.draw_shape",
        "Draw Shape",
        toggle_pen,
        "Viewer/Handles",
        "N",
        "viewer",
        can_draw,
        lambda context: context.viewer.pen.is_drawing,
        doc="Click on the picture to set corners of a new shape of the selected node, drag to set smooth points, and "
        "click the first point to close it. Afterwards points, tangents and feathers can be dragged; Alt pulls "
        "tangents out of a point, or moves one tangent alone. A double click on the line adds a point. Drag with Shift "
        "around points to select them.",
    ),
    Action(
        "viewer.paint",
        "Paint",
        toggle_brush,
        "Viewer/Handles",
        "Shift+N",
        "viewer",
        can_paint,
        paints,
        doc="Drag on the picture to paint a stroke of the selected node. Drag with Shift for the size of the brush; "
        "click with Alt on what a clone copies. Space and drag pans the picture.",
    ),
    Action(
        "viewer.larger_brush",
        "Larger Brush",
        lambda context: scale_brush(context, 1.15),
        "Viewer/Handles",
        "Shift+RightBracket",
        "viewer",
        paints,
        repeats=True,
    ),
    Action(
        "viewer.smaller_brush",
        "Smaller Brush",
        lambda context: scale_brush(context, 1.0 / 1.15),
        "Viewer/Handles",
        "Shift+LeftBracket",
        "viewer",
        paints,
        repeats=True,
    ),
    Action(
        "viewer.remove_light",
        "Remove Light or Point",
        _remove_chosen,
        "Viewer/Handles",
        "Delete",
        "viewer",
        lambda context: can_remove_points(context) or can_remove(context),
        doc="Remove the selected light of the selected node, or the selected points of its shape. A double click on "
        "the picture adds a light, one on a line of a shape a point.",
    ),
)
