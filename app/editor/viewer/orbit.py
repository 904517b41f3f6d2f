"""The orbit camera of a node: a target, a distance and angles, and how the mouse changes them."""

from __future__ import annotations

import math
from pathlib import PurePath
from typing import TYPE_CHECKING, cast

import numpy as np
from halation.nodes import BuiltInScene, CameraModel, Node, SceneFile, orbit_camera
from msgspec import Struct
from msgspec.structs import replace

from ...authoring.commands import ReplaceGraph
from ...graph import Graph, Item, Port
from ...language.translation import translate
from ...media.meshes.load import load_mesh
from ...resources.mesh import ATTRIBUTES
from .perspective import Place, neat

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .context import ViewerContext

SENSOR = 36.0
"""The width of the sensor in mm to which the focal length refers (full frame)."""

HALF_TURN = 180.0
"""Degrees that a drag across the whole panel turns the camera."""

VALUES = ("target", "distance", "azimuth", "elevation", "focal")
"""The values of a node with an orbit camera."""

NEAREST, FARTHEST = 1e-3, 1e6
STEEPEST = 89.0
"""The steepest elevation in degrees: straight from above, the camera's roll is undefined."""

_MARGIN = 0.9
"""The fraction of the picture that a framed scene fills."""

_SURROUNDING = 0.99
"""An object that covers this fraction of the scene in x and y is a floor or backdrop, which framing leaves out."""


class Orbit(Struct, frozen=True):
    """An orbit camera: angles in degrees, focal length in mm."""

    target: Place
    distance: float
    azimuth: float
    elevation: float
    focal: float = 50.0

    @classmethod
    def of(cls, node: Node) -> Orbit:
        """The camera in the values of a node."""
        return cls(*(getattr(node, name) for name in VALUES))

    def camera(self, aspect: float) -> CameraModel:
        """The camera as effects take it; `aspect` is the picture's width over its height."""
        across = self.focal / SENSOR
        angles = math.radians(self.azimuth), math.radians(self.elevation)
        return orbit_camera(self.target, self.distance, *angles, (across, across * aspect))

    def turn_by(self, right: float, down: float) -> Orbit:
        """The camera after a drag by fractions of the panel's width: what is before the target follows the mouse."""
        azimuth = (self.azimuth - HALF_TURN * right + 180.0) % 360.0 - 180.0
        low, high = min(self.elevation, -STEEPEST), max(self.elevation, STEEPEST)
        elevation = min(max(self.elevation + HALF_TURN * down, low), high)
        return replace(self, azimuth=round(azimuth, 3), elevation=round(elevation, 3))

    def shift_target(self, right: float, down: float, depth: float, aspect: float) -> Orbit:
        """The camera with its target moved: objects at a depth move right and down by fractions of the picture."""
        camera = self.camera(aspect)
        across, along = right * depth / camera.focal[0], down * depth / camera.focal[1]
        x, y, z = (
            neat(at - across * to_right - along * to_bottom)
            for at, to_right, to_bottom in zip(self.target, camera.right, camera.down, strict=True)
        )
        return replace(self, target=(x, y, z))

    def approach_by(self, factor: float) -> Orbit:
        """The camera at a smaller distance, by a factor."""
        return replace(self, distance=neat(min(max(self.distance / factor, NEAREST), FARTHEST)))

    def frame_places(self, places: np.ndarray, aspect: float) -> Orbit:
        """The camera that shows all positions [n, 3] from the same side, centered."""
        low, high = places.min(axis=0), places.max(axis=0)
        x, y, z = (neat(float(part)) for part in (low + high) / 2.0)
        camera = replace(self, target=(x, y, z)).camera(aspect)
        away = np.asarray(places, np.float64) - (x, y, z)
        ahead = away @ camera.forward
        needed = [
            np.abs(away @ axis) * focal / (0.5 * _MARGIN) - ahead
            for axis, focal in zip((camera.right, camera.down), camera.focal, strict=True)
        ]
        distance = max(float(np.max(needed)), NEAREST)
        return replace(self, target=(x, y, z), distance=neat(min(distance, FARTHEST)))


# --- the node whose camera it is -----------------------------------------------------------------------------------


def find_orbit_node(session: Session) -> str:
    """The node whose camera the viewer moves: the selected scene, else the only viewed one; "" if there is none.

    A selected scene must be viewed too, and its camera neither linked nor animated.
    """
    graph, viewed_port = session.graph, session.views.find_port("A")
    scenes = [id for id, item in graph.nodes.items() if _goes_around(item)]
    if not scenes or viewed_port is None:
        return ""
    behind = _upstream(graph, viewed_port)
    scenes = [id for id in scenes if id in behind and _is_free(graph, id)]
    return session.active if session.active in scenes else scenes[0] if len(scenes) == 1 else ""


def _goes_around(item: Item) -> bool:
    return isinstance(item, Node) and "azimuth" in item.values and set(VALUES) <= item.values.keys()


def _upstream(graph: Graph, port: Port) -> set[str]:
    """The nodes that a port depends on."""
    feeds: dict[str, list[Port]] = {}
    for target, source in graph.links.items():
        feeds.setdefault(target.node, []).append(source)
    start = graph.links.get(port, port)
    upstream, pending = set[str](), [start.node]
    while pending:
        node = pending.pop()
        if node not in upstream:
            upstream.add(node)
            pending.extend(source.node for source in feeds.get(node, ()))
    return upstream


def _is_free(graph: Graph, id: str) -> bool:
    ports = [Port(id, name) for name in VALUES]
    return not any(port in graph.links or port in graph.animation for port in ports)


def scene_at(context: ViewerContext) -> Node | None:
    """The node whose camera the viewer moves, at the current frame."""
    item = context.session.graph.nodes.get(context.viewer.scene)
    return item if isinstance(item, Node) and _goes_around(item) else None


def move_camera(context: ViewerContext, orbit: Orbit, merge: str = "") -> None:
    """Set the camera; equal `merge` tokens make one undo step."""
    session, id = context.session, context.viewer.scene
    graph, before = session.graph, scene_at(context)
    if before is None:
        return
    for name in ("target", "distance", "azimuth", "elevation"):
        if getattr(orbit, name) != getattr(before, name):
            graph = graph.set(Port(id, name), getattr(orbit, name))
    context.log.attempt(lambda: session.apply(ReplaceGraph(translate("Orbit {id}", id=id), graph, merge=merge)))


def aspect_of(context: ViewerContext) -> float:
    """Width over height of the picture."""
    width, height = context.viewer.picture
    return max(width, 1) / max(height, 1)


def frame_scene(context: ViewerContext) -> None:
    """Frame the whole scene, as one undo step."""
    node = scene_at(context)
    if node is not None:
        move_camera(context, Orbit.of(node).frame_places(_places(context, node), aspect_of(context)))


def _places(context: ViewerContext, node: Node) -> np.ndarray:
    """The vertices of the scene, without a floor or backdrop."""
    name, file, up = (getattr(node, value) for value in ("scene", "file", "up"))
    path = str(PurePath(context.session.graph.folder, file))
    mesh = load_mesh(SceneFile(path, up) if name == "file" else BuiltInScene(name), sandbox=context.session.sandbox)
    vertices = cast("np.ndarray", mesh.vertices)
    column = np.cumsum([0, *ATTRIBUTES.values()])[list(ATTRIBUTES).index("object_material_moving")]
    return without_surroundings(vertices[:, :3], vertices[:, column])


def without_surroundings(places: np.ndarray, objects: np.ndarray) -> np.ndarray:
    """The positions of all objects except those as wide as the scene; of all objects, if none would be left.

    Places of one object stand in a row.
    """
    starts = np.flatnonzero(np.diff(objects, prepend=objects[0] - 1))
    ends = (np.maximum.reduceat(places, starts), np.minimum.reduceat(places, starts))
    wide = (ends[0] - ends[1])[:, :2] >= _SURROUNDING * np.ptp(places[:, :2], axis=0)
    is_inside = np.repeat(~wide.all(axis=1), np.diff(starts, append=len(places)))
    return places[is_inside] if is_inside.any() else places
