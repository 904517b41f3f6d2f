"""The depth and the position in the world under a point of the picture."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from halation.nodes import LIGHTS, CameraModel, Node

from ...graph import Port
from .focus import focuses
from .geometry import Point
from .orbit import scene_at
from .perspective import Place, project, unproject

if TYPE_CHECKING:
    from .context import ViewerContext

SCENE, DEPTH, PLACE = "scene depth", "depth", "place"
"""Names of requested pictures: the depth of the orbited scene, and depth and positions of the active node."""

FAR = 1e9
"""The depth from which on everything is background."""

_ASTRAY = 0.02
"""The largest offset of a pixel from its projected position, as a fraction: a wrong camera gives more."""


def depths(context: ViewerContext) -> dict[str, Port]:
    """The ports that handles need, by name."""
    session, ports = context.session, dict[str, Port]()
    if context.viewer.orbits and (scene := scene_at(context)) is not None and "depth" in scene.outputs:
        ports[SCENE] = Port(context.viewer.scene, "depth")
    item = session.graph.nodes.get(session.active)
    if isinstance(item, Node) and (focuses(item) or any(value.items is LIGHTS for value in item.values.values())):
        linked = {DEPTH: session.graph.links.get(Port(session.active, "depth"))}
        if not focuses(item):
            linked[PLACE] = session.graph.links.get(Port(session.active, "position"))
        ports |= {name: port for name, port in linked.items() if port is not None}
    return ports


def depth_at(context: ViewerContext, at: Point, name: str = DEPTH) -> float | None:
    """The depth at a point of the picture (a fraction); 1e10 for the background, None if unknown."""
    values = _read(context, name, at)
    if not values or not values[0] > 0.0:
        return None
    return values[0] if values[0] < FAR else 1e10


def surface_at(context: ViewerContext, camera: CameraModel, at: Point) -> tuple[Place, float] | None:
    """The position in the world at a point of the picture, and its depth; None for the background, or if unknown."""
    values = _read(context, PLACE, at)
    if values is not None:
        x, y, z = values[:3]
        projection = project(camera, (x, y, z)) if math.isfinite(x + y + z) else None
        return ((x, y, z), projection[2]) if projection and math.dist(projection[:2], at) < _ASTRAY else None
    depth = depth_at(context, at)
    return (unproject(camera, *at, depth), depth) if depth is not None and depth < FAR else None


def _read(context: ViewerContext, name: str, at: Point) -> tuple[float, ...] | None:
    """The numbers at a point; None until the picture of the current node is ready."""
    port, image = depths(context).get(name), context.preview.find_whole_image(name)
    inside = 0.0 <= at[0] < 1.0 and 0.0 <= at[1] < 1.0
    if port is None or image is None or not inside:
        return None
    if image.port != Port("/".join((*context.session.place, port.node)), port.socket):
        return None
    width, height = image.full_size
    return context.viewer.reader.read_pixel(context.probe, name, image, (int(at[0] * width), int(at[1] * height)))
