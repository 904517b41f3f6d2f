"""Mouse gestures on the canvas, as values. Nothing here draws or changes a document."""

from __future__ import annotations

import math
from collections.abc import Collection

from msgspec import Struct, field
from msgspec.structs import replace

from ...authoring.edits import routes
from ...authoring.edits.element_id import ElementId
from ...authoring.edits.selection import SelectMode
from ...authoring.edits.wiring import splice_chain
from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Port
from .geometry import Point, Rect, overlaps, snap_to_grid, span_rect
from .scene import CanvasScene

MIN_FRAME_SIZE = (96.0, 64.0)
"""The least size of frames; comments may be as low as their text."""


class Idle(Struct, frozen=True):
    """No gesture."""


class PanGesture(Struct, frozen=True):
    """The view follows the mouse."""

    center: Point
    mouse: Point
    """Where the mouse button was pressed, in pixels of the screen."""


class Band(Struct, frozen=True):
    """A rectangle that selects."""

    start: Point
    mode: SelectMode = "replace"


class MoveGesture(Struct, frozen=True):
    """Elements follow the mouse; until it has moved far enough, this is a click on `key`."""

    key: ElementId
    start: Point
    keys: frozenset[ElementId] = frozenset()
    offset: Point = (0.0, 0.0)
    alone: bool = False
    """True selects only `key` if it stays a click."""
    merge: str = ""
    """The name that merges the move with the extraction at its start into one undo step."""

    @property
    def is_moving(self) -> bool:
        """True if elements move already."""
        return bool(self.keys)


class ResizeGesture(Struct, frozen=True):
    """An edge of a frame or comment follows the mouse."""

    key: ElementId
    edges: str
    start: Point
    before: Rect
    rect: Rect


class CutGesture(Struct, frozen=True):
    """A line across links, to cut them or to put dots on them."""

    start: Point
    dots: bool = False


class LinkGesture(Struct, frozen=True):
    """A link that is dragged. `port` is the fixed end, `detached` the target that it was taken from, if any."""

    port: Port
    output: bool
    detached: Port | None = None
    targets: frozenset[Port] = frozenset()
    """Pins of the other side that it fits."""
    start: Point = (0.0, 0.0)
    """Where the mouse button was pressed: the pin itself may move when a node unfolds below the link."""


Gesture = Idle | PanGesture | Band | MoveGesture | ResizeGesture | CutGesture | LinkGesture
IDLE = Idle()


def find_touched(scene: CanvasScene, rect: Rect) -> tuple[ElementId, ...]:
    """The elements that a selection rectangle touches; frames only if it contains all of them."""
    left, top, right, bottom = rect
    keys: list[ElementId] = []
    for key, box in scene.boxes.items():
        if box.sort == "frame":
            if left <= box.x and right >= box.x + box.w and top <= box.y and bottom >= box.y + box.h:
                keys.append(key)
        elif overlaps(box.rect, rect):
            keys.append(key)
    return tuple(keys)


def move_to(move: MoveGesture, scene: CanvasScene, to: Point, snap: bool) -> MoveGesture:
    """Move to a new mouse position; `snap` puts the dragged element on the grid."""
    dx, dy = to[0] - move.start[0], to[1] - move.start[1]
    if snap and move.key in scene.boxes:
        box = scene.boxes[move.key]
        dx, dy = snap_to_grid(box.x + dx) - box.x, snap_to_grid(box.y + dy) - box.y
    return replace(move, offset=(dx, dy))


def resize_to(resize: ResizeGesture, to: Point, snap: bool) -> ResizeGesture:
    """Resize to a new mouse position."""
    left, top, right, bottom = resize.before
    dx, dy = to[0] - resize.start[0], to[1] - resize.start[1]
    grid = snap_to_grid if snap else float
    if "l" in resize.edges:
        left = min(grid(left + dx), right - MIN_FRAME_SIZE[0])
    if "r" in resize.edges:
        right = max(grid(right + dx), left + MIN_FRAME_SIZE[0])
    if "t" in resize.edges:
        top = min(grid(top + dy), bottom - MIN_FRAME_SIZE[1])
    if "b" in resize.edges:
        bottom = max(grid(bottom + dy), top + MIN_FRAME_SIZE[1])
    return replace(resize, rect=(left, top, right, bottom))


def add_members(
    keys: Collection[ElementId], scene: CanvasScene, members: Collection[frozenset[ElementId]]
) -> frozenset[ElementId]:
    """The elements that move together: `keys`, and all elements on frames among them."""
    return frozenset(keys).union(*members) & scene.boxes.keys()


def find_fitting_pins(graph: Graph, scene: CanvasScene, port: Port, output: bool) -> frozenset[Port]:
    """The pins of the other side that a link from (or, if not `output`, to) `port` could join without a loop."""
    if output:
        closed = frozenset[str]() if port.node == INPUTS else graph.upstream(port.node) | {port.node}
    else:
        closed = frozenset[str]() if port.node == OUTPUTS else graph.downstream(port.node) | {port.node}
    pins: set[Port] = set()
    for candidate, _, _ in scene.list_pins(not output):
        source, target = (port, candidate) if output else (candidate, port)
        if candidate.node not in closed and graph.link_fault(source, target) is None:
            pins.add(candidate)
    return frozenset(pins)


def find_snap_pin(scene: CanvasScene, link: LinkGesture, at: Point, reach: float) -> tuple[Port, Point] | None:
    """The pin that a dragged link would snap to: one within reach, else the first that fits on the node below."""
    best: tuple[float, Port, Point] | None = None
    hovered_key = scene.find_node(*at)
    body_pin: tuple[bool, Port, Point] | None = None
    for port, box, pin in scene.list_pins(not link.output):
        if port not in link.targets:
            continue
        place = box.x + pin.x, box.y + pin.y
        gap = math.hypot(place[0] - at[0], place[1] - at[1])
        if gap <= reach and (best is None or gap < best[0]):
            best = gap, port, place
        if box.key == hovered_key and not pin.value:
            is_free = not link.output or port not in scene.by_target
            if body_pin is None or (is_free and not body_pin[0]):
                body_pin = is_free, port, place
    if best:
        return best[1], best[2]
    return (body_pin[1], body_pin[2]) if body_pin else None


def find_refused_pin(scene: CanvasScene, link: LinkGesture, at: Point, reach: float) -> Port | None:
    """The pin under the pointer if a dragged link does not fit it; where pins lie close together the nearest counts."""
    near = [
        (math.hypot(box.x + pin.x - at[0], box.y + pin.y - at[1]), port)
        for port, box, pin in scene.list_pins(not link.output)
        if abs(box.x + pin.x - at[0]) <= reach and abs(box.y + pin.y - at[1]) <= reach
    ]
    nearest = min(near, default=None)
    return nearest[1] if nearest and nearest[1] not in link.targets else None


def find_insertion(
    graph: Graph, scene: CanvasScene, keys: Collection[ElementId], at: Point, reach: float
) -> Port | None:
    """The target of the link that moved nodes would be put into: they are a chain without other links, and fit."""
    ids = [key for key in keys if key in graph.nodes]
    if not ids or any(key not in graph.nodes and key.kind != "dot" for key in keys):
        return None
    if any(wire.crosses_border(keys) for wire in scene.wires):
        return None
    points = [(box.x + box.w / 2, box.y + min(box.h / 2, 24.0)) for box in map(scene.boxes.__getitem__, ids)]
    wire = next((wire for point in (at, *points) if (wire := scene.links.find_near(*point, reach, keys))), None)
    if wire is None:
        return None
    try:
        splice_chain(graph, ids, wire.target)
    except GraphError:
        return None
    return wire.target


def add_crossing_dots(graph: Graph, crossings: dict[Port, Point]) -> tuple[Graph, tuple[ElementId, ...]]:
    """A graph with a dot where each link was crossed; links from the same source share one. Also the new dots."""
    shared: dict[Port, ElementId] = {}
    for target, at in sorted(crossings.items()):
        source = graph.links[target]
        if source in shared:
            graph = routes.join_dot(graph, shared[source], target)
        else:
            graph, shared[source] = routes.add_dot(graph, target, at)
    return graph, tuple(shared.values())


def make_band_rect(band: Band, to: Point) -> Rect:
    """The rectangle between the start of the gesture and the mouse."""
    return span_rect(band.start, to)


class GesturePreview(Struct):
    """The scene with the current gesture applied, and what the gesture would do."""

    scene: CanvasScene
    insert: Port | None = None
    snap: tuple[Port, Point] | None = None
    crossed: dict[Port, Point] = field(default_factory=dict[Port, Point])


def preview_gesture(scene: CanvasScene, gesture: Gesture) -> CanvasScene:
    """The scene with a gesture applied."""
    if isinstance(gesture, MoveGesture) and gesture.is_moving:
        return scene.move(gesture.keys, *gesture.offset)
    if isinstance(gesture, ResizeGesture):
        return scene.resize(gesture.key, gesture.rect)
    return scene
