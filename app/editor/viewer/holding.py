"""Drags of handles on the picture: finding what is under the mouse, and applying the drag."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from ...authoring.commands import SetValue, SetValues
from ...language.translation import translate
from .dome import RADIUS, direction_at, knob_of, middle_of
from .geometry import Box, Grip, Point, Sight, box_grip, drag_box, order_box, wipe_angle, wipe_grip
from .gizmos import Gizmo, GizmoDrag
from .ground import FAR, SCENE, depth_at
from .handles import find_grip, list_gizmos
from .light_sizes import SizeHandle, list_size_handles, resize_light
from .lights import Lamp, change_light, drop_light, lamps, make_merge_token, place_light, suns, turn_spot
from .mattes import click, picks
from .orbit import Orbit, aspect_of, move_camera, scene_at
from .painting import begin_stroke, extend_stroke, finish_stroke, make_stroke_token, paints
from .snapping import Snapping
from .spline_edits import (
    aim_pen,
    begin_move,
    can_draw,
    drag_feather,
    find_pen,
    lift_pen,
    move_part,
    select_alone,
    select_in_lasso,
)
from .splines import SplineTarget, find_chosen, find_spline

if TYPE_CHECKING:
    from .context import ViewerContext

HoldKind = Literal[
    "pan",
    "handle",
    "light",
    "light depth",
    "light drop",
    "light size",
    "goal",
    "goal depth",
    "sun",
    "orbit",
    "track",
    "wipe",
    "region",
    "new region",
    "measure",
    "pick",
    "matte",
    "spline",
    "add point",
    "lasso",
    "pen",
    "paint",
    "brush size",
    "brush copy",
]

ARM = 56.0
"""Length of the wipe's turning handle at UI scale 1."""

REACH = 6.0
"""The distance at which a handle is hit, in pixels at UI scale 1."""

SNAP_REACH = 6.0
"""The distance from which on a line attracts what is dragged, in pixels at UI scale 1: as that of the wipe."""

DOUBLINGS = 3.0
"""How often the depth of a light doubles for a drag up across the whole panel."""


class HandleTarget(Struct, frozen=True):
    """What a press of the mouse button would grab."""

    kind: HoldKind
    grip: Grip = ""
    gizmo: Gizmo | None = None
    part: str = ""
    """The grip of the gizmo."""
    lamp: Lamp | None = None
    size: SizeHandle | None = None
    """The handle of a size of the lamp."""
    spline: SplineTarget | None = None


def aim(
    context: ViewerContext,
    sight: Sight,
    at: Point,
    scale: float = 1.0,
    *,
    ctrl: bool = False,
    alt: bool = False,
    shift: bool = False,
) -> HandleTarget:
    """The handle under the mouse. `scale` is the UI scale.

    Modes come first, then the smallest things, then what fills the picture: a handle on top of a wipe can be taken.
    """
    viewer, reach = context.viewer, REACH * scale
    if viewer.picking:
        return HandleTarget("pick")
    if viewer.drawing_region:
        return HandleTarget("new region")
    if viewer.pen.is_drawing and can_draw(context):
        return HandleTarget("pen", part=find_pen(context, sight, at, scale))
    if paints(context):
        return HandleTarget("brush size" if shift else "brush copy" if alt or ctrl else "paint")
    if ctrl:
        return HandleTarget("measure")
    if grip_target := find_grip(list_gizmos(context, sight, scale), sight, at, scale):
        return HandleTarget("handle", gizmo=grip_target[0], part=grip_target[1].part)
    if spline_target := find_spline(context, sight, at, scale):
        return HandleTarget("add point" if shift and spline_target.part == "point" else "spline", spline=spline_target)
    if light_target := _light(context, sight, at, scale, alt, shift):
        return light_target
    if viewer.compare == "wipe" and sight.under(at):
        grip = wipe_grip(at, sight.place(viewer.wipe), viewer.wipe_angle, ARM * scale, reach)
        if grip:
            return HandleTarget("wipe", grip)
    if viewer.region is not None:
        grip = box_grip(at, sight.rectangle(viewer.region), reach)
        if grip:
            return HandleTarget("region", grip)
    if viewer.orbits or (alt and viewer.scene):
        return HandleTarget("track" if shift else "orbit")
    if shift and find_chosen(context):
        return HandleTarget("lasso")
    return HandleTarget("matte" if picks(context) else "pan")


def _light(
    context: ViewerContext, sight: Sight, at: Point, scale: float, alt: bool, shift: bool
) -> HandleTarget | None:
    """The light, or the target of a spot, under the mouse; the selected light first."""
    near = REACH * scale * 1.6
    if math.dist(at, middle_of(sight, scale)) <= RADIUS * scale + near:
        for lamp in reversed(suns(context)):
            if math.dist(at, knob_of(sight, scale, lamp.camera, lamp.light.direction)) <= near:
                return HandleTarget("sun", lamp=lamp)
    for lamp in reversed(lamps(context)):
        if math.dist(at, sight.place(lamp.at)) <= near:
            return HandleTarget("light depth" if alt else "light drop" if shift else "light", lamp=lamp)
        if lamp.aims and math.dist(at, sight.place(lamp.aims[0])) <= near:
            return HandleTarget("goal depth" if alt else "goal", lamp=lamp)
        for handle in list_size_handles(sight, lamp) if lamp.chosen else ():
            if math.dist(at, handle.end) <= near:
                return HandleTarget("light size", lamp=lamp, size=handle)
    return None


class MouseHold(Struct):
    """A drag, from press to release of the mouse button."""

    context: ViewerContext
    aim: HandleTarget
    start: Point
    """The screen point where the button was pressed."""
    offset: Point = (0.0, 0.0)
    """From the mouse to the held point, as a fraction of the picture."""
    box: Box = (0.0, 0.0, 1.0, 1.0)
    moved: bool = False
    scale: float = 1.0
    """The UI scale."""
    orbit: Orbit | None = None
    """The camera at the start of the drag."""
    depth: float = 0.0
    """The depth at the point where the button was pressed; the size of the brush then."""
    deferred: GizmoDrag | None = None
    """What counts when the button is released."""

    @classmethod
    def begin(cls, context: ViewerContext, sight: Sight, at: Point, aim: HandleTarget, scale: float = 1.0) -> MouseHold:
        """Start the drag of a target.

        The distance between the pointer and the held point is kept, so that nothing jumps when the drag begins.
        """
        hold, (x, y) = cls(context, aim, at, scale=scale), sight.fraction(at)
        held_point = None
        if aim.gizmo is not None:
            grip = next(grip.at for grip in aim.gizmo.grips if grip.part == aim.part)
            held_point = grip[0] / sight.picture[0], grip[1] / sight.picture[1]
        if aim.spline is not None:
            begin_move(context, aim.spline, adds=aim.kind == "add point")
        if aim.kind == "pen" and aim.part == "new":
            aim_pen(context, (x, y), None)
        if aim.kind == "paint":
            begin_stroke(context, (x, y))
        elif aim.kind == "brush copy":
            context.viewer.brush.copy_from((x, y))
        hold.depth = context.viewer.brush.size if aim.kind == "brush size" else 0.0
        if aim.lamp is not None:
            held_point, context.items[str(aim.lamp.port)] = aim.lamp.at, aim.lamp.name
            if aim.kind in ("goal", "goal depth") and aim.lamp.aims:
                held_point, hold.depth = aim.lamp.aims
            elif aim.kind == "sun":
                knob = knob_of(sight, scale, aim.lamp.camera, aim.lamp.light.direction)
                held_point, hold.offset = None, (knob[0] - at[0], knob[1] - at[1])
            elif aim.size is not None:
                held_point, hold.offset = None, (aim.size.end[0] - at[0], aim.size.end[1] - at[1])
        if aim.kind in ("orbit", "track") and (scene := scene_at(context)) is not None:
            hold.orbit = Orbit.of(scene)
            depth = depth_at(context, (x, y), SCENE) if aim.kind == "track" else None
            hold.depth = depth if depth is not None and depth < FAR else hold.orbit.distance
        if aim.kind == "wipe" and aim.grip == "line":
            held_point = context.viewer.wipe
        if held_point is not None:
            hold.offset = held_point[0] - x, held_point[1] - y
        if aim.kind == "region" and context.viewer.region:
            hold.box = context.viewer.region
        return hold

    def drag(
        self,
        sight: Sight,
        at: Point,
        by: Point,
        *,
        is_free: bool = False,
        is_constrained: bool = False,
        is_broken: bool = False,
    ) -> None:
        """Follow the mouse to `at`, `by` screen units from where it was a frame ago.

        Nothing snaps if it is free; tangents of a spline move alone if they are broken.
        """
        self.moved = self.moved or math.dist(at, self.start) > 3.0
        viewer, (x, y), begun = self.context.viewer, sight.fraction(at), sight.fraction(self.start)
        match self.aim.kind:
            case "pan" | "matte":
                if by != (0.0, 0.0) and self.moved:
                    viewer.zoom, viewer.pan = (moved := sight.pan_by(*by)).zoom, moved.pan
            case "handle" if self.moved:
                self._move_grip(sight, (x + self.offset[0], y + self.offset[1]), is_free, is_constrained)
            case _ if self.aim.lamp is not None and self.moved:
                self._move_light(sight, at, (x + self.offset[0], y + self.offset[1]))
            case "spline" | "add point" if self.moved and self.aim.spline:
                self._move_spline(self.aim.spline, sight, at, is_broken)
            case "lasso":
                viewer.pen.lasso.append((x, y))
            case "pen" if self.moved and self.aim.part == "new":
                aim_pen(self.context, begun, (x, y))
            case "paint":
                extend_stroke(self.context, sight, (x, y))
            case "brush size":
                across = (at[0] - self.start[0]) * sight.density / sight.zoom
                viewer.brush.resize(self.depth + 2.0 * across / sight.picture[1])
            case "orbit" | "track" if self.moved and self.orbit is not None:
                self._move_camera(sight, at, self.orbit)
            case "wipe" if self.aim.grip == "angle":
                viewer.wipe_angle = wipe_angle(at, sight.place(viewer.wipe))
            case "wipe":
                left, top = (min(max(part, 0.0), 1.0) for part in (x + self.offset[0], y + self.offset[1]))
                viewer.wipe = left, top
            case "region":
                viewer.region = drag_box(self.box, self.aim.grip, (x - begun[0], y - begun[1]))
            case "new region" if self.moved:
                viewer.region = order_box((*begun, x, y))
            case "measure" if self.moved:
                viewer.measured = order_box((*begun, x, y))
            case _:
                pass

    def release(self, sight: Sight, at: Point) -> None:
        """End the drag."""
        viewer = self.context.viewer
        viewer.guides = ()
        if self.deferred is not None:
            self._apply(self.deferred)
            viewer.deferred = None
        if self.aim.kind == "spline" and self.aim.spline and not self.moved:
            select_alone(self.context, self.aim.spline)
        if self.aim.kind == "paint":
            finish_stroke(self.context, sight)
        elif self.token:
            self.context.session.seal()
        elif self.aim.kind == "lasso":
            select_in_lasso(self.context)
        elif self.aim.kind == "pen" and self.aim.part == "new":
            lift_pen(self.context)
        elif self.aim.kind == "pen":
            viewer.pen.end()
        elif self.aim.kind == "matte" and not self.moved:
            click(self.context, sight, at)
        elif self.aim.kind == "new region":
            viewer.drawing_region = False
            viewer.region = viewer.region if self.moved else None
        elif self.aim.kind == "measure":
            viewer.table = True  # only now: the table takes space, and the picture would move under the pointer
            if not self.moved and sight.under(at):
                viewer.markers = toggle_marker(viewer.markers, sight, at)

    @property
    def token(self) -> str:
        """The merge token of the drag's edits; "" if it does not edit the document."""
        if self.aim.gizmo is not None:
            return f"handle {self.aim.gizmo.grips[0].port} {self.aim.part}"
        if self.aim.spline is not None:
            return self.aim.spline.outline.token
        if self.aim.kind == "paint":
            return make_stroke_token(self.context)
        return make_merge_token(self.aim.lamp) if self.aim.lamp else "orbit" if self.orbit else ""

    def _move_spline(self, target: SplineTarget, sight: Sight, at: Point, is_broken: bool) -> None:
        if target.part == "feather":
            drag_feather(self.context, target, sight, at, self.scale)
        elif target.part != "curve":
            (x, y), begun = sight.fraction(at), sight.fraction(self.start)
            by = x - begun[0], y - begun[1]
            move_part(self.context, target, by, (x, y), is_broken=is_broken, pulls_tangents=is_broken)

    def _move_light(self, sight: Sight, at: Point, to: Point) -> None:
        lamp = self.aim.lamp
        assert lamp is not None
        farther = 2.0 ** (DOUBLINGS * (self.start[1] - at[1]) * sight.density / sight.panel[1])
        match self.aim.kind:
            case "light":
                place_light(self.context, lamp, to)
            case "light depth":
                place_light(self.context, lamp, lamp.at, lamp.depth * farther)
            case "light drop":
                drop_light(self.context, lamp, to)
            case "goal":
                turn_spot(self.context, lamp, to, self.depth)
            case "goal depth" if lamp.aims:
                turn_spot(self.context, lamp, lamp.aims[0], self.depth * farther)
            case "sun":
                knob = at[0] + self.offset[0], at[1] + self.offset[1]
                direction = direction_at(sight, self.scale, lamp.camera, knob)
                change_light(self.context, lamp, direction=direction)
            case "light size" if self.aim.size is not None:
                resize_light(self.context, self.aim.size, (at[0] + self.offset[0], at[1] + self.offset[1]))
            case _:
                pass

    def _move_camera(self, sight: Sight, at: Point, orbit: Orbit) -> None:
        """Move the camera from where it was at the start, so that rounding errors do not add up."""
        self.context.interface.dragging = True
        if self.aim.kind == "orbit":
            across = sight.panel[0] / sight.density
            orbit = orbit.turn_by((at[0] - self.start[0]) / across, (at[1] - self.start[1]) / across)
        else:
            (x, y), (left, top) = sight.fraction(at), sight.fraction(self.start)
            orbit = orbit.shift_target(x - left, y - top, self.depth, aspect_of(self.context))
        move_camera(self.context, orbit, self.token)

    def _move_grip(self, sight: Sight, to: Point, is_free: bool, is_constrained: bool) -> None:
        gizmo, viewer = self.aim.gizmo, self.context.viewer
        assert gizmo is not None
        pixel = sight.density / sight.zoom
        size = float(sight.picture[0]), float(sight.picture[1])
        snapping = Snapping(size, 0.0 if is_free else SNAP_REACH * self.scale * pixel)
        target = to[0] * size[0], to[1] * size[1]
        drag = gizmo.drag(self.aim.part, target, snapping, is_constrained=is_constrained)
        viewer.guides = drag.guides
        if gizmo.is_deferred:
            self.deferred = drag
            viewer.deferred = drag.values
        else:
            self.context.interface.dragging = True
            self._apply(drag)

    def _apply(self, drag: GizmoDrag) -> None:
        """Set the values of a drag as one step."""
        (port, value), *others = drag.values.items()
        command = SetValue(port, value, merge=self.token)
        if others:
            command = SetValues(drag.values, translate("Set {node}", node=port.node), merge=self.token)
        self.context.log.attempt(lambda: self.context.session.apply(command))


def toggle_marker(markers: tuple[Point, ...], sight: Sight, at: Point) -> tuple[Point, ...]:
    """The markers with one added at the pixel under the mouse, or without the marker there."""
    pixel = sight.under(at)
    assert pixel is not None
    width, height = sight.picture
    near = tuple(marker for marker in markers if math.dist(sight.place(marker), at) <= REACH)
    if near:
        return tuple(marker for marker in markers if marker not in near)
    return (*markers, ((pixel[0] + 0.5) / width, (pixel[1] + 0.5) / height))
