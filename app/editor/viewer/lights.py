"""Lights of the active node on the picture, where its camera sees them, and where they are put."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ....nodes import Camera, Kind, Light, LightKind, lights_of
from ...graph import Port, Unknown, signature
from ..inspector.lights import changed, count_of, light_at

if TYPE_CHECKING:
    from ..editor import Editor

Point = tuple[float, float]
Place = tuple[float, float, float]

MOST = 64
"""Lights that are shown together; of longer lists only the selected one is."""

_AHEAD = 0.12
"""Length of the line from a spot, as a part of its depth."""


@dataclass(frozen=True)
class Lamp:
    """A light in front of the camera: its value, its number there, and where it is as a fraction of the picture."""

    port: Port
    index: int
    light: Light
    camera: Camera
    at: Point
    depth: float
    chosen: bool


def lamps(editor: Editor) -> tuple[Lamp, ...]:
    """Those of the active node, the selected one last; none if no camera is linked to it, or none is known yet."""
    session = editor.session
    item = session.graph.nodes.get(session.active)
    if item is None or isinstance(item, Unknown):
        return ()
    face, found = signature(item), list[Lamp]()
    values = [name for name, value in face.values.items() if value.type == "lights"]
    if not values or (camera := _camera(editor, [name for name, one in face.inputs.items() if one.kind is Kind.CAMERA])
                      ) is None:
        return ()
    for name in values:
        port = Port(session.active, name)
        numbers = session.value(port)
        if session.linked(port) is not None or not isinstance(numbers, tuple) or not numbers:
            continue
        chosen = min(editor.lights.get(str(port), 0), count_of(numbers) - 1)
        few = count_of(numbers) <= MOST
        for index, light in enumerate(lights_of(numbers)) if few else ((chosen, light_at(numbers, chosen)),):
            seen = project(camera, light.place)
            if light.kind is not LightKind.SUN and seen is not None:
                found.append(Lamp(port, index, light, camera, seen[:2], seen[2], index == chosen))
    return tuple(sorted(found, key=lambda lamp: lamp.chosen))


def put(editor: Editor, lamp: Lamp, to: Point) -> None:
    """Put a light elsewhere on the picture, as far from the camera as it is."""
    u, v = (min(max(part, -1.0), 2.0) for part in to)
    numbers = editor.session.value(lamp.port)
    if not isinstance(numbers, tuple) or lamp.index >= count_of(numbers):
        return
    light = replace(light_at(numbers, lamp.index), place=unproject(lamp.camera, u, v, lamp.depth))
    value = changed(numbers, lamp.index, light)
    editor.dragging = True
    editor.attempt(lambda: editor.session.set(lamp.port, value, merge=f"light {lamp.port} {lamp.index}"))


def ahead(lamp: Lamp) -> Point | None:
    """Where on the picture a spot shines to, a little way from it; None for other lights."""
    length = math.hypot(*lamp.light.direction)
    if lamp.light.kind is not LightKind.SPOT or not length:
        return None
    far = lamp.depth * _AHEAD / length
    x, y, z = (at + way * far for at, way in zip(lamp.light.place, lamp.light.direction, strict=True))
    seen = project(lamp.camera, (x, y, z))
    return None if seen is None else seen[:2]


def project(camera: Camera, place: Place) -> tuple[float, float, float] | None:
    """Where a place is on the picture, and its depth; None for what is not in front of the camera."""
    try:
        u, v, depth = camera.project(place)
    except ZeroDivisionError:
        return None
    return (u, v, depth) if depth > 0.0 and math.isfinite(u) and math.isfinite(v) else None


def unproject(camera: Camera, u: float, v: float, depth: float) -> Place:
    """The place in the world of a point of the picture at a depth."""
    rows, seen = camera.inverse, (u * depth, v * depth, depth, 1.0)
    x, y, z = (
        round(sum(part * number for part, number in zip(rows[at : at + 4], seen, strict=True)), 5) for at in (0, 4, 8)
    )
    return x, y, z


def _camera(editor: Editor, inputs: list[str]) -> Camera | None:
    session = editor.session
    path = "/".join((*session.place, session.active))
    linked = (name for name in inputs if session.linked(Port(session.active, name)) is not None)
    found = (editor.preview.camera(Port(path, name)) for name in linked)
    return next((camera for camera in found if camera is not None), None)
