"""Sizes of the selected light as handles on the picture: radius, reach, edges of an area, and the cones of a spot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from halation.nodes import LightKind
from msgspec import Struct

from .geometry import Point, Sight
from .lamp_outlines import WIDEST_CONE, cone, half_axes_of
from .lights import Lamp, change_light
from .perspective import Place, move_place, project

if TYPE_CHECKING:
    from .context import ViewerContext

LEAST = 0.001
"""The least length that a drag leaves, in units of the scene, and the tangent of the least cone: a size of 0 has no
handle any more."""


class SizeHandle(Struct, frozen=True):
    """A field of a light, shown by how far one point of the screen is from another.

    `length` is what the distance stands for: a length in the scene, or the tangent of half a cone.
    """

    lamp: Lamp
    field: str
    center: Point
    end: Point
    length: float

    def measure(self, at: Point) -> float:
        """The length for which the handle would be at a point of the screen, across from its own line."""
        line = self.end[0] - self.center[0], self.end[1] - self.center[1]
        offset = at[0] - self.center[0], at[1] - self.center[1]
        share = (line[0] * offset[0] + line[1] * offset[1]) / max(line[0] ** 2 + line[1] ** 2, 1e-9)
        return max(share * self.length, LEAST)


def list_size_handles(sight: Sight, lamp: Lamp) -> tuple[SizeHandle, ...]:
    """The handles of a light in front of the camera; none for sizes of 0, and where an end is behind the camera."""
    return tuple(
        SizeHandle(lamp, field, center, end, length)
        for field, center, end, length in _list_ends(sight, lamp)
        if length > 0.0 and math.dist(center, end) > 0.0
    )


def resize_light(context: ViewerContext, handle: SizeHandle, at: Point) -> None:
    """Set the field of a handle so that it is at a point of the screen."""
    length = handle.measure(at)
    value = {
        "width": 2.0 * length,
        "height": 2.0 * length,
        "length": 2.0 * length,
        "outer": math.degrees(math.atan(length)),
        "inner": math.degrees(math.atan(length)),
    }.get(handle.field, length)
    change_light(context, handle.lamp, **{handle.field: float(f"{value:.4g}")})


def _list_ends(sight: Sight, lamp: Lamp) -> Iterator[tuple[str, Point, Point, float]]:
    """The field, the two points and the length of each handle."""
    light, at = lamp.light, sight.place(lamp.at)
    scale = lamp.camera.focal[0] * sight.picture[0] * sight.zoom / sight.density / lamp.depth
    yield "reach", at, _step_inward(sight, at, light.reach * scale), light.reach
    if light.kind is LightKind.SPHERE:
        yield "size", at, (at[0] + light.size * scale, at[1]), light.size
    elif light.kind is LightKind.SPOT:
        yield from _list_cone_ends(sight, lamp)
    else:
        fields = {
            LightKind.RECTANGLE: (("width", light.width / 2.0), ("height", light.height / 2.0)),
            LightKind.DISC: (("size", light.size),),
            LightKind.TUBE: (("length", light.length / 2.0), ("size", light.size)),
        }.get(light.kind, ())
        for (field, length), axis in zip(fields, half_axes_of(light), strict=False):
            if end := _find(sight, lamp, move_place(light.place, axis, 1.0)):
                yield field, at, end, length


def _list_cone_ends(sight: Sight, lamp: Lamp) -> Iterator[tuple[str, Point, Point, float]]:
    """The rims of both cones, on two sides of the target, so that neither hides the other."""
    goal = lamp.goal
    center = _find(sight, lamp, goal) if goal else None
    if center is None:
        return
    for field, angle, part in (("outer", lamp.light.outer, 0.25), ("inner", lamp.light.inner, 0.75)):
        rim = cone(lamp, angle)
        if angle <= WIDEST_CONE and (end := _find(sight, lamp, rim[int(part * len(rim))])):
            yield field, center, end, math.tan(math.radians(angle))


def _step_inward(sight: Sight, at: Point, length: float) -> Point:
    """A point toward the middle of the picture, where the end of a large circle is likely to be seen."""
    middle = sight.place((0.5, 0.5))
    offset = middle[0] - at[0], middle[1] - at[1]
    far = math.hypot(*offset)
    x, y = (offset[0] / far, offset[1] / far) if far > 0.0 else (1.0, 0.0)
    return at[0] + length * x, at[1] + length * y


def _find(sight: Sight, lamp: Lamp, place: Place) -> Point | None:
    """A place on the screen, None behind the camera."""
    projection = project(lamp.camera, place)
    return sight.place(projection[:2]) if projection else None
