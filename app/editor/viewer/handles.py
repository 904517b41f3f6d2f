"""Which gizmos the active node has on the picture: every place, length, angle and frame of its values."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, cast

from halation.nodes import ItemSet, Plain, Value, is_length, unit_factor
from msgspec import Struct

from ...graph import Port, Unknown, signature
from ...graph.named_items import join_path
from .box_gizmos import RectangleGizmo, TransformGizmo
from .focus import is_idle
from .geometry import Point, Sight
from .gizmos import Gizmo, GizmoGrip, JoiningLines, PlaceGizmo, SizeGizmo, TurnGizmo, bend_through
from .grips import GRIP_REACH

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .context import ViewerContext
    from .state import ViewerState

_RECTANGLE = ("top_left", "bottom_right")
_FRAME = ("position", "rotation", "scale", "skew")
_GRID_POINT = re.compile("point_[1-9][1-9]")

_ARM = 64.0
"""Length of the arm of a dial in pixels at UI scale 1: clear of the ring around its center and of the size grips."""

_NEXT_ARM = 18.0
"""How much longer the arm of each further dial is."""

_LEAST = 28.0
"""How far from the center a length of 0 has its grip, in pixels at UI scale 1: clear of the grip of a place."""

_FIRST_DIRECTION, _NEXT_DIRECTION = 30.0, 40.0
"""Where lengths have their grips, in degrees clockwise from the right: below the level, where few dials point."""


class PictureFrame(Struct, frozen=True):
    """The picture that gizmos lie on."""

    size: Point
    """In pixels of the full picture."""
    pixel: float
    """How many of them a pixel of the screen at UI scale 1 is."""


class _ActiveNode(Struct, frozen=True):
    """The active node, with what gizmos need of it."""

    id: str
    values: dict[str, Value]
    """The values that can be dragged, those that a link drives aside."""
    numbers: dict[str, Plain]
    units: dict[str, str | None]
    frame: PictureFrame
    crops_view: bool
    """Whether the picture is what the node left of its frame."""

    def port(self, name: str) -> Port:
        """The port of a value."""
        return Port(self.id, name)

    def numbers_of(self, name: str) -> Point:
        """Two numbers of a value."""
        return cast("Point", self.numbers[name])


def list_gizmos(context: ViewerContext, sight: Sight, scale: float) -> tuple[Gizmo, ...]:
    """The gizmos of the active node, those on top last; none while they are hidden. `scale` is the UI scale."""
    active = _find_active(context, PictureFrame(_float(sight.picture), scale * sight.density / sight.zoom))
    if active is None:
        return ()
    gizmos = [*_list_frames(active), *_list_dials(active), *_list_lengths(active), *_list_places(active)]
    return (*_list_lines(active), *gizmos)


def find_grip(gizmos: tuple[Gizmo, ...], sight: Sight, at: Point, scale: float) -> tuple[Gizmo, GizmoGrip] | None:
    """The grip on top at a point of the screen."""
    for gizmo in reversed(gizmos):
        for grip in reversed(gizmo.grips):
            if math.dist(place_grip(sight, grip.at, scale), at) <= GRIP_REACH * scale:
                return gizmo, grip
    return None


def place_grip(sight: Sight, at: Point, scale: float) -> Point:
    """Where a grip is on the screen: at the very edge of the panel it is moved in, as half of it could not be hit."""
    near = GRIP_REACH * scale
    x, y = (
        min(max(part, low + near), high - near) if low - near <= part <= high + near else part
        for part, low, high in zip(sight.screen(at), sight.origin, _find_end(sight), strict=True)
    )
    return x, y


def _find_end(sight: Sight) -> Point:
    """The right bottom corner of the panel."""
    return sight.origin[0] + sight.panel[0] / sight.density, sight.origin[1] + sight.panel[1] / sight.density


def takes_position(session: Session, port: Port) -> bool:
    """True if the eyedropper picks a position for a value, not a color."""
    item = session.graph.nodes.get(port.node)
    value = None if item is None or isinstance(item, Unknown) else signature(item).values.get(port.socket)
    return value is not None and value.handle


def pixel_place(viewer: ViewerState) -> Point:
    """The middle of the pixel under the pointer, as a fraction of the picture."""
    assert viewer.pixel is not None
    (x, y), (width, height) = viewer.pixel, viewer.picture
    return round((x + 0.5) / max(width, 1), 5), round((y + 0.5) / max(height, 1), 5)


def _find_active(context: ViewerContext, frame: PictureFrame) -> _ActiveNode | None:
    session = context.session
    item = session.graph.nodes.get(session.active)
    if not context.viewer.has_gizmos or item is None or isinstance(item, Unknown):
        return None
    ports = [Port(session.active, name) for name in _list_paths(signature(item).values.values())]
    values = {
        port.socket: session.graph.declaration(port)
        for port in ports
        if session.graph.links.get(port) is None and not is_idle(session, port)
    }
    numbers = {port.socket: session.time.evaluated_graph.value(port) for port in ports}
    viewed = session.views.find_port("A")
    behind = viewed is not None and session.active in session.graph.upstream(viewed.node) | {viewed.node}
    crops = numbers.get("resize") is True and set(_RECTANGLE) <= numbers.keys()
    units = {name: value.unit for name, value in values.items()}
    return _ActiveNode(session.active, values, numbers, units, frame, crops and behind)


def _list_paths(values: Iterable[Value]) -> Iterator[str]:
    """The values of a node, and the positions of their items; splines have tools of their own."""
    for value in values:
        yield value.name
        if value.items and isinstance(value.default, ItemSet):
            for name, item in value.default.items():
                fields = value.items.by_name[item.kind].declarations
                if not any(field.type == "spline" for field in fields):
                    yield from (join_path(value.name, name, field.name) for field in fields if field.handle)


def _list_places(active: _ActiveNode) -> list[Gizmo]:
    """Positions, but corners of rectangles."""
    corners = _RECTANGLE if _has_rectangle(active) else ()
    return [
        PlaceGizmo(active.port(name), active.numbers_of(name), active.frame.size)
        for name, value in active.values.items()
        if value.handle and name not in corners
    ]


def _list_lines(active: _ActiveNode) -> list[Gizmo]:
    """The lines of a grid of points `point_11`, `point_12`, ... by row and column; curves by start, middle and end."""
    names = sorted(name for name in active.numbers if _GRID_POINT.fullmatch(name))
    rows = [[name for name in names if name[-2] == digit] for digit in sorted({name[-2] for name in names})]
    columns = [[name for name in names if name[-1] == digit] for digit in sorted({name[-1] for name in names})]
    lines = [tuple(_place(active, name) for name in line) for line in (*rows, *columns)]
    for name in active.values:
        if name.endswith("_middle"):
            ends = (name.replace("_middle", end) for end in ("_start", "_middle", "_end"))
            lines.append(bend_through(*(_place(active, end) for end in ends)))
    return [JoiningLines(tuple(lines))] if lines else []


def _place(active: _ActiveNode, name: str) -> Point:
    """A position in pixels."""
    x, y = active.numbers_of(name)
    return x * active.frame.size[0], y * active.frame.size[1]


def _has_rectangle(active: _ActiveNode) -> bool:
    return all(name in active.values and active.values[name].handle for name in _RECTANGLE)


def _list_frames(active: _ActiveNode) -> list[Gizmo]:
    """The rectangle of a node with two opposite corners; the frame of one that moves and scales about a pivot."""
    if _has_rectangle(active):
        (x0, y0), (x1, y1) = map(active.numbers_of, _RECTANGLE)
        box = min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
        origin, size = (0.0, 0.0), active.frame.size
        if active.crops_view:
            across, down = max(box[2] - box[0], 1e-4), max(box[3] - box[1], 1e-4)
            size = size[0] / across, size[1] / down
            origin = -box[0] * size[0], -box[1] * size[1]
        top_left, bottom_right = map(active.port, _RECTANGLE)
        return [RectangleGizmo(top_left, bottom_right, box, origin, size, is_deferred=active.crops_view)]
    if not _is_transform(active) or active.numbers.get("direction") == "inverse":
        return []
    pivot = tuple(active.numbers_of("pivot")[i] * active.frame.size[i] for i in (0, 1))
    return [
        TransformGizmo(
            active.id,
            active.frame.size,
            active.numbers_of("position"),
            cast("float", active.numbers["rotation"]),
            active.numbers_of("scale"),
            active.numbers_of("skew"),
            (pivot[0], pivot[1]),
            0.5 * _ARM * active.frame.pixel,
            frozenset(name for name in _FRAME if name in active.values),
            unit_factor(active.units.get("position"), 1.0, active.frame.size[1]),
        )
    ]


def _is_transform(active: _ActiveNode) -> bool:
    return {*_FRAME, "pivot"} <= active.numbers.keys()


def _list_dials(active: _ActiveNode) -> list[Gizmo]:
    """Angles in the plane of the picture."""
    dials = [(name, value) for name, value in active.values.items() if value.turns]
    return [
        TurnGizmo(
            active.port(name),
            cast("float", active.numbers[name]),
            _find_center(active),
            (_ARM + index * _NEXT_ARM) * active.frame.pixel,
            value.turns == "clockwise",
            max(value.minimum, min(value.low, -180.0)),
            min(value.maximum, max(value.high, 180.0)),
        )
        for index, (name, value) in enumerate(dials)
    ]


def _list_lengths(active: _ActiveNode) -> list[Gizmo]:
    """Lengths in the picture: circles; pairs of them across and down."""
    frame_names = _FRAME if _is_transform(active) else ()
    center, gizmos = _find_center(active), list[Gizmo]()
    for name, value in active.values.items():
        if not _is_length(value) or name in frame_names or value.type not in ("float", "vector"):
            continue
        unit, numbers = unit_factor(value.unit, 1.0, active.frame.size[1]), active.numbers[name]
        if not isinstance(numbers, int | float):
            if isinstance(numbers, tuple) and len(numbers) == 2:
                place = (numbers[0], numbers[1])
                limits = value.minimum, value.maximum
                gizmos.append(PlaceGizmo(active.port(name), place, (unit, unit), center, *limits, "size"))
            continue
        direction = _FIRST_DIRECTION + _NEXT_DIRECTION * len(gizmos)
        least, limits = _LEAST * active.frame.pixel, (value.minimum, value.maximum)
        gizmos.append(SizeGizmo(active.port(name), float(numbers), unit, center, direction, least, *limits))
    return gizmos


def _is_length(value: Value) -> bool:
    """True for a length, in whatever unit the graph gives it."""
    return is_length(value) or (value.unit or "").startswith("px@")


def _find_center(active: _ActiveNode) -> Point:
    """The point around which lengths and angles are: the only position of the node, or the middle of the picture."""
    places = [name for name, numbers in active.numbers.items() if name in _CENTERS and isinstance(numbers, tuple)]
    return _place(active, places[0]) if places else (0.5 * active.frame.size[0], 0.5 * active.frame.size[1])


_CENTERS = ("center", "anchor", "source", "focus_point", "start")
"""What nodes call the point that everything is around."""


def _float(size: tuple[int, int]) -> Point:
    return float(size[0]), float(size[1])
