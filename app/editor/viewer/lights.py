"""Lights of the active node: where its camera sees them, and edits of their position."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from halation.nodes import LIGHTS, CameraModel, ItemSet, Kind, Light, LightKind, light_of
from msgspec import Struct

from ...authoring.commands import AddItem, RemoveItem, SetValues
from ...graph import Port, Unknown, signature
from ...graph.named_items import join_path
from ...language.translation import translate
from ..fields.item_facts import choose_item, neighbor_of
from .geometry import Point
from .ground import surface_at
from .item_lists import find_item_lists
from .perspective import Place, dot, move_place, project, unit, unproject

if TYPE_CHECKING:
    from .context import ViewerContext

MOST = 64
"""The most lights that are drawn; of longer lists only the selected one is."""

_SHORTEST = 0.12
"""The least length of the line from a spot to its target, as a fraction of its depth."""

_NEAREST = 0.2
"""The least depth of the target, as a fraction of the depth of the spot."""

_OVER = 0.05
"""The distance from a surface to a light dropped on it, as a fraction of the depth; a sphere's radius is added."""

_DEFAULT_DEPTH = 5.0
"""Units of the scene in front of the camera, where a first light is put that meets no surface. Chosen by judgement."""

_AIMED = (LightKind.SPOT, LightKind.RECTANGLE, LightKind.DISC, LightKind.TUBE)
"""The lights at a place that have a direction."""


class Lamp(Struct, frozen=True):
    """A light before the camera: its value, its name there, and where it is as a fraction of the picture.

    A sun is everywhere: `at` is the middle of the picture, and the depth 0.
    """

    port: Port
    name: str
    light: Light
    camera: CameraModel
    at: Point
    depth: float
    chosen: bool

    @property
    def goal(self) -> Place | None:
        """The target of a light with a direction: as far away as its direction is long, but within view."""
        length = math.hypot(*self.light.direction)
        if self.light.kind not in _AIMED or not 0.0 < length < math.inf:
            return None
        far = max(1.0, _SHORTEST * self.depth / length)
        ahead = dot(self.camera.forward, self.light.direction) * far
        if self.depth + ahead < _NEAREST * self.depth:
            far *= (1.0 - _NEAREST) * self.depth / -ahead
        return move_place(self.light.place, self.light.direction, far)

    @property
    def aims(self) -> tuple[Point, float] | None:
        """The target on the picture, and its depth."""
        goal = self.goal
        projection = project(self.camera, goal) if goal else None
        return (projection[:2], projection[2]) if projection else None


def lamps(context: ViewerContext) -> tuple[Lamp, ...]:
    """The lights in front of the camera, the selected one last; none if no camera is linked or known yet."""
    return tuple(lamp for lamp in _list_lamps(context) if lamp.light.kind is not LightKind.SUN)


def suns(context: ViewerContext) -> tuple[Lamp, ...]:
    """The suns of the active node, the selected one last."""
    return tuple(lamp for lamp in _list_lamps(context) if lamp.light.kind is LightKind.SUN)


def _list_lamps(context: ViewerContext) -> tuple[Lamp, ...]:
    camera, found_lamps = _camera(context), list[Lamp]()
    for port in lists(context) if camera else ():
        items = _items(context, port)
        chosen = choose_item(context.items, str(port), items)
        names = tuple(items) if len(items) <= MOST else (chosen,)
        for name in names:
            assert camera is not None
            light = light_of(items[name])
            projection = (0.5, 0.5, 0.0) if light.kind is LightKind.SUN else project(camera, light.place)
            if projection is not None:
                found_lamps.append(Lamp(port, name, light, camera, projection[:2], projection[2], name == chosen))
    return tuple(sorted(found_lamps, key=lambda lamp: lamp.chosen))


def lists(context: ViewerContext) -> tuple[Port, ...]:
    """The values of the active node that hold lights; none while handles are hidden."""
    return find_item_lists(context, LIGHTS)


def _items(context: ViewerContext, port: Port) -> ItemSet:
    """The items of a value at the current frame."""
    items = context.session.time.evaluated_graph.value(port)
    return items if isinstance(items, ItemSet) else ItemSet()


def _camera(context: ViewerContext) -> CameraModel | None:
    """The camera that is linked to the active node."""
    session = context.session
    item = session.graph.nodes.get(session.active)
    if item is None or isinstance(item, Unknown):
        return None
    path = "/".join((*session.place, session.active))
    inputs = [name for name, socket in signature(item).inputs.items() if socket.kind is Kind.CAMERA]
    linked = (name for name in inputs if session.graph.links.get(Port(session.active, name)) is not None)
    cameras = (context.preview.camera(Port(path, name)) for name in linked)
    return next((camera for camera in cameras if camera is not None), None)


# --- what is done to them ------------------------------------------------------------------------------------------


def place_light(context: ViewerContext, lamp: Lamp, to: Point, depth: float | None = None) -> None:
    """Move a light to a point of the picture, at its depth or at another one."""
    u, v = (min(max(part, -1.0), 2.0) for part in to)
    change_light(context, lamp, place=unproject(lamp.camera, u, v, depth or lamp.depth))


def drop_light(context: ViewerContext, lamp: Lamp, to: Point) -> None:
    """Move a light in front of the surface at a point of the picture; without a surface it keeps its depth."""
    place = _over(context, lamp.camera, to, lamp.light)
    if place is None:
        place_light(context, lamp, to)
    else:
        change_light(context, lamp, place=place)


def turn_spot(context: ViewerContext, lamp: Lamp, to: Point, depth: float) -> None:
    """Aim a spot at a point of the picture at a depth."""
    u, v = (min(max(part, -1.0), 2.0) for part in to)
    direction = move_place(unproject(lamp.camera, u, v, depth), lamp.light.place, -1.0)
    x, y, z = (round(part, 5) for part in direction)
    if any((x, y, z)):
        change_light(context, lamp, direction=(x, y, z))


def change_light(context: ViewerContext, lamp: Lamp, **fields: object) -> None:
    """Set fields of a light, or keys of those that have some; consecutive changes are one undo step."""
    if lamp.name not in _items(context, lamp.port):
        return
    values = {Port(lamp.port.node, join_path(lamp.port.socket, lamp.name, name)): part for name, part in fields.items()}
    context.interface.dragging = True
    label = translate("Move {element}", element=lamp.name)
    context.log.attempt(lambda: context.session.apply(SetValues(values, label, merge=make_merge_token(lamp))))


def make_merge_token(lamp: Lamp) -> str:
    """The merge token of changes of a light."""
    return f"light {lamp.port} {lamp.name}"


def can_add(context: ViewerContext) -> bool:
    """True if the active node has a light list and a camera."""
    return bool(lists(context)) and _camera(context) is not None


def add_light(context: ViewerContext, to: Point) -> None:
    """Add a point light in front of the surface at a point; without a surface, at the depth of the selected light."""
    ports, camera = lists(context), _camera(context)
    if not ports or camera is None:
        return
    port = ports[0]
    depths = [lamp.depth for lamp in lamps(context)]
    deep = depths[-1] if depths else _DEFAULT_DEPTH
    place = _over(context, camera, to, Light()) or unproject(camera, *to, deep)

    def add() -> None:
        command = AddItem(port, LightKind.POINT.value, {"place": place})
        context.items[str(port)] = context.session.apply(command)

    context.log.attempt(add)


def can_remove(context: ViewerContext) -> bool:
    """True if a light is selected."""
    return any(_items(context, port) for port in lists(context))


def remove_chosen_light(context: ViewerContext) -> None:
    """Remove the selected light."""
    port = next((port for port in lists(context) if _items(context, port)), None)
    if port is None:
        return
    items = _items(context, port)
    name = choose_item(context.items, str(port), items)

    def remove() -> None:
        context.session.apply(RemoveItem(port, name))
        context.items[str(port)] = neighbor_of(items, name)

    context.log.attempt(remove)


def _over(context: ViewerContext, camera: CameraModel, to: Point, light: Light) -> Place | None:
    """A position in front of the surface at a point of the picture."""
    surface = surface_at(context, camera, to)
    if surface is None:
        return None
    place, depth = surface
    back = move_place(camera.eye, place, -1.0)
    gap = _OVER * depth + (light.size if light.kind is LightKind.SPHERE else 0.0)
    direction = unit(back)
    far = min(gap / max(-dot(direction, camera.forward), 1e-3), 0.9 * math.hypot(*back))
    x, y, z = (round(part, 5) for part in move_place(place, direction, far))
    return x, y, z
