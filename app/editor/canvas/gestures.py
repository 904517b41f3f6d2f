"""What the mouse is doing on the canvas, as values. Nothing here draws or changes a document."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace

from ...authoring.edits import routes
from ...authoring.edits.wiring import splice_chain
from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Port
from .geometry import Point, Rect, overlap, snapped, spanned
from .scene import CanvasScene

SMALLEST = (96.0, 64.0)
"""The least size of frames; comments may be as low as their text."""


@dataclass(frozen=True)
class Idle:
    """Nothing."""


@dataclass(frozen=True)
class PanGesture:
    """The view follows the mouse."""

    center: Point
    mouse: Point
    """Where the mouse went down, in pixels of the screen."""


@dataclass(frozen=True)
class Band:
    """A rectangle that selects."""

    start: Point
    mode: str = "replace"


@dataclass(frozen=True)
class MoveGesture:
    """Elements follow the mouse; until it has gone far enough this is a click on `key`."""

    key: str
    start: Point
    keys: frozenset[str] = frozenset()
    by: Point = (0.0, 0.0)
    alone: bool = False
    """True selects only `key` if it stays a click."""
    merge: str = ""
    """What makes one step of it with what was done when it began: nodes taken out of their chains."""

    @property
    def going(self) -> bool:
        """True once elements move."""
        return bool(self.keys)


@dataclass(frozen=True)
class ResizeGesture:
    """An edge of a frame or comment follows the mouse."""

    key: str
    edges: str
    start: Point
    before: Rect
    rect: Rect


@dataclass(frozen=True)
class BandGesture:
    """A line across links, to cut them or to put dots on them."""

    start: Point
    dots: bool = False


@dataclass(frozen=True)
class Link:
    """A link in the hand. `port` is the end that stays, `detached` the target that it was taken from, if any."""

    port: Port
    output: bool
    detached: Port | None = None
    targets: frozenset[Port] = frozenset()
    """Pins of the other side that it fits."""


Gesture = Idle | PanGesture | Band | MoveGesture | ResizeGesture | BandGesture | Link
IDLE = Idle()


def touched(scene: CanvasScene, rect: Rect) -> tuple[str, ...]:
    """What a selecting rectangle takes: what it touches, but frames only by their title or whole."""
    left, top, right, bottom = rect
    found: list[str] = []
    for key, box in scene.boxes.items():
        if box.sort == "frame":
            if left <= box.x and right >= box.x + box.w and top <= box.y and bottom >= box.y + box.h:
                found.append(key)
        elif overlap(box.rect, rect):
            found.append(key)
    return tuple(found)


def moved(move: MoveGesture, scene: CanvasScene, to: Point, snap: bool) -> MoveGesture:
    """The move with the mouse elsewhere; `snap` puts what was grabbed on the grid."""
    dx, dy = to[0] - move.start[0], to[1] - move.start[1]
    if snap and move.key in scene.boxes:
        box = scene.boxes[move.key]
        dx, dy = snapped(box.x + dx) - box.x, snapped(box.y + dy) - box.y
    return replace(move, by=(dx, dy))


def resized(resize: ResizeGesture, to: Point, snap: bool) -> ResizeGesture:
    """The resizing with the mouse elsewhere."""
    left, top, right, bottom = resize.before
    dx, dy = to[0] - resize.start[0], to[1] - resize.start[1]
    grid = snapped if snap else float
    if "l" in resize.edges:
        left = min(grid(left + dx), right - SMALLEST[0])
    if "r" in resize.edges:
        right = max(grid(right + dx), left + SMALLEST[0])
    if "t" in resize.edges:
        top = min(grid(top + dy), bottom - SMALLEST[1])
    if "b" in resize.edges:
        bottom = max(grid(bottom + dy), top + SMALLEST[1])
    return replace(resize, rect=(left, top, right, bottom))


def with_members(keys: Collection[str], scene: CanvasScene, members: Collection[frozenset[str]]) -> frozenset[str]:
    """What moves together: the elements and all that lie on frames among them."""
    return frozenset(keys).union(*members) & scene.boxes.keys()


def fitting(graph: Graph, scene: CanvasScene, port: Port, output: bool) -> frozenset[Port]:
    """The pins of the other side that a link from (or, if not `output`, to) `port` could join without a loop."""
    if output:
        closed = frozenset[str]() if port.node == INPUTS else graph.upstream(port.node) | {port.node}
    else:
        closed = frozenset[str]() if port.node == OUTPUTS else graph.downstream(port.node) | {port.node}
    found: set[Port] = set()
    for other, _, _ in scene.pins(not output):
        source, target = (port, other) if output else (other, port)
        if other.node not in closed and graph.link_fault(source, target) is None:
            found.add(other)
    return frozenset(found)


def nearest(scene: CanvasScene, link: Link, at: Point, reach: float) -> tuple[Port, Point] | None:
    """The pin that a dragged link would snap to: one within reach, else the first that fits on the node below."""
    best: tuple[float, Port, Point] | None = None
    body = scene.node_at(*at)
    body_first: tuple[bool, Port, Point] | None = None
    for port, box, pin in scene.pins(not link.output):
        if port not in link.targets:
            continue
        place = box.x + pin.x, box.y + pin.y
        gap = ((place[0] - at[0]) ** 2 + (place[1] - at[1]) ** 2) ** 0.5
        if gap <= reach and (best is None or gap < best[0]):
            best = gap, port, place
        if box.key == body and not pin.value:
            taken = not link.output or port not in scene.by_target
            if body_first is None or (taken and not body_first[0]):
                body_first = taken, port, place
    if best:
        return best[1], best[2]
    return (body_first[1], body_first[2]) if body_first else None


def refused(scene: CanvasScene, link: Link, at: Point, reach: float) -> Port | None:
    """The pin under the pointer that a dragged link does not fit."""
    for port, box, pin in scene.pins(not link.output):
        near = abs(box.x + pin.x - at[0]) <= reach and abs(box.y + pin.y - at[1]) <= reach
        if near and port not in link.targets:
            return port
    return None


def insertable(graph: Graph, scene: CanvasScene, keys: Collection[str], at: Point, reach: float) -> Port | None:
    """The target of the link that moved nodes would be put into: they are a chain without other links, and fit."""
    ids = [key for key in keys if key in graph.nodes]
    if not ids or any(key not in graph.nodes and not key.startswith("dots.") for key in keys):
        return None
    if any(wire.leaves(keys) for wire in scene.wires):
        return None
    spots = [(box.x + box.w / 2, box.y + min(box.h / 2, 24.0)) for box in map(scene.boxes.__getitem__, ids)]
    wire = next((found for spot in (at, *spots) if (found := scene.net.at(*spot, reach, keys))), None)
    if wire is None:
        return None
    try:
        splice_chain(graph, ids, wire.target)
    except GraphError:
        return None
    return wire.target


def dotted(graph: Graph, crossings: dict[Port, Point]) -> tuple[Graph, tuple[str, ...]]:
    """A graph with a dot where each link was crossed; links from the same source share one. Also the new keys."""
    shared: dict[Port, str] = {}
    for target, at in sorted(crossings.items()):
        source = graph.links[target]
        if source in shared:
            graph = routes.join_dot(graph, shared[source], target)
        else:
            graph, shared[source] = routes.add_dot(graph, target, at)
    return graph, tuple(f"dots.{dot}" for dot in shared.values())


def band_rect(band: Band, to: Point) -> Rect:
    """The rectangle between where it began and where the mouse is."""
    return spanned(band.start, to)


@dataclass
class Dragged:
    """What a gesture makes of the scene in this frame."""

    scene: CanvasScene
    insert: Port | None = None
    snap: tuple[Port, Point] | None = None
    crossed: dict[Port, Point] = field(default_factory=dict[Port, Point])


def shown(scene: CanvasScene, gesture: Gesture) -> CanvasScene:
    """The scene as a gesture has it for now."""
    if isinstance(gesture, MoveGesture) and gesture.going:
        return scene.moved(gesture.keys, *gesture.by)
    if isinstance(gesture, ResizeGesture):
        return scene.resized(gesture.key, gesture.rect)
    return scene
