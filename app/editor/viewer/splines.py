"""Splines of the active node on the picture: what is under the mouse, and edits of points and tangents.

Points are drawn where the shape's transform puts them, and what the mouse does is taken back through it. So the points
in the file stay those of the shape before it is moved.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, cast

from halation.nodes import (
    ROTO_SHAPES,
    Affine,
    ItemSet,
    Node,
    Row,
    curve_point,
    list_curves,
    place_roto_shapes,
    split_points,
)
from msgspec import Struct

from ...graph import Port
from ...graph.named_items import join_path
from ..fields.item_facts import choose_item
from .geometry import Point, Sight
from .item_lists import find_item_list

if TYPE_CHECKING:
    from .context import ViewerContext

SplinePart = Literal["point", "in", "out", "feather", "curve", "new", "close"]
"""What is under the mouse: a point, the end of a tangent, the grip of a feather, a curve, or with the pen a new
point or the first one."""

STEPS = 24
"""The lines that a curve is drawn with: on a curve of 400 pixels they are a third of a pixel from it."""

REACH = 9.0
"""The distance at which a point is hit, in pixels at UI scale 1: as that of other grips."""

FEATHER_ARM = 22.0
"""How far from its point the grip of a feather of 0 is: clear of the point."""

_NEAR_CURVE = 5.0
"""The distance at which a curve is hit."""


class SplineOutline(Struct, frozen=True):
    """A spline of the active node, on a picture of a size in pixels: a shape among others, or a value of its own."""

    points_port: Port
    """The value with its points."""
    name: str
    """The name of the shape, or of the node."""
    numbers: Row
    affine: Affine
    """From its points to pixels."""
    size: tuple[int, int]
    chosen: bool
    items: Port | None = None
    """The value that holds it, if it is a shape among others."""

    @property
    def points(self) -> tuple[Row, ...]:
        """The numbers of its points."""
        return split_points(self.numbers)

    @property
    def places(self) -> tuple[Point, ...]:
        """Where its points are, as fractions of the picture."""
        return tuple(self.to_picture((point[0], point[1])) for point in self.points)

    @property
    def token(self) -> str:
        """The merge token of a drag."""
        return f"spline {self.points_port}"

    def to_picture(self, place: Point) -> Point:
        """Where a place of the shape is, as a fraction of the picture."""
        a, b, c, d, e, f = self.affine
        x, y = place
        return (a * x + b * y + c) / self.size[0], (d * x + e * y + f) / self.size[1]

    def from_picture(self, place: Point) -> Point | None:
        """The place of the shape at a fraction of the picture; None if it has no size."""
        a, b, c, d, e, f = self.affine
        x, y, area = place[0] * self.size[0] - c, place[1] * self.size[1] - f, a * e - b * d
        if abs(area) < 1e-9:
            return None
        return round((e * x - b * y) / area, 6), round((a * y - d * x) / area, 6)

    def trace_curve(self, index: int) -> list[Point]:
        """Places along the curve that leaves a point, as fractions of the picture."""
        curve = list_curves(self.points)[index]
        return [self.to_picture(curve_point(curve, step / STEPS)) for step in range(STEPS + 1)]


class SplineTarget(Struct, frozen=True):
    """A part of a shape under the mouse."""

    outline: SplineOutline
    part: SplinePart
    index: int
    t: float = 0.0
    """Where on the curve."""


def find_list(context: ViewerContext) -> Port | None:
    """The value of the active node that holds splines; None while handles are hidden."""
    return find_item_list(context, ROTO_SHAPES)


def list_outlines(context: ViewerContext) -> tuple[SplineOutline, ...]:
    """The splines of the active node at the current frame, the selected one last."""
    outlines = (*_list_own_outlines(context), *_list_shapes(context))
    return tuple(sorted(outlines, key=lambda outline: outline.chosen))


def _list_shapes(context: ViewerContext) -> Iterator[SplineOutline]:
    """The named shapes of the active node, where they and their parents put them."""
    session, size, port = context.session, context.viewer.picture, find_list(context)
    node = session.time.evaluated_graph.nodes.get(port.node) if port else None
    if port is None or not isinstance(node, Node):
        return
    items = cast(
        "ItemSet", node.to_working_units(1.0, size[1], session.graph.settings.reference_height).setting(port.socket)
    )
    chosen = choose_item(context.items, str(port), items)
    for name, (shape, affine) in place_roto_shapes(items, size).items():
        points_port = Port(port.node, join_path(port.socket, name, "points"))
        yield SplineOutline(points_port, name, shape.points, affine, size, name == chosen, port)


def _list_own_outlines(context: ViewerContext) -> Iterator[SplineOutline]:
    """The splines that are values of the active node, as far as they have an effect."""
    session, size = context.session, context.viewer.picture
    node = session.time.evaluated_graph.nodes.get(session.active)
    if not isinstance(node, Node) or not context.viewer.has_gizmos:
        return
    names = [name for name, value in node.values.items() if value.type == "spline"]
    if not names:
        return
    placed = node.to_working_units(1.0, size[1], session.graph.settings.reference_height)
    for number, name in enumerate(names):
        affine, port = placed.place_spline(name, size), Port(session.active, name)
        if affine is not None:
            yield SplineOutline(port, session.active, placed.setting(name), affine, size, number == 0)


def find_own_outline(context: ViewerContext) -> SplineOutline | None:
    """The spline that is a value of the active node: the pen draws it anew."""
    return next(_list_own_outlines(context), None)


def find_spline(context: ViewerContext, sight: Sight, at: Point, scale: float) -> SplineTarget | None:
    """The part of a shape under the mouse: points of the selected shape first, then its tangents, then curves."""
    outlines = list_outlines(context)
    for outline in reversed(outlines):
        selected = find_selected(context, outline)
        if outline.chosen and len(selected) == 1:
            (number,) = selected
            for part, place in list_tangents(outline, number):
                if math.dist(at, sight.place(place)) <= REACH * scale:
                    return SplineTarget(outline, part, number)
            if math.dist(at, place_feather(outline, sight, number, scale)) <= REACH * scale:
                return SplineTarget(outline, "feather", number)
        for index, place in enumerate(outline.places if outline.chosen else ()):
            if math.dist(at, sight.place(place)) <= REACH * scale:
                return SplineTarget(outline, "point", index)
    curves = (_find_curve(outline, sight, at, _NEAR_CURVE * scale) for outline in reversed(outlines))
    return next((target for target in curves if target), None)


def list_tangents(outline: SplineOutline, index: int) -> list[tuple[Literal["in", "out"], Point]]:
    """The ends of the tangents of a point, as fractions of the picture; corners have none."""
    x, y, *arms = outline.points[index][:6]
    ends: list[tuple[Literal["in", "out"], Point]] = [("in", (arms[0], arms[1])), ("out", (arms[2], arms[3]))]
    return [(part, outline.to_picture((x + arm[0], y + arm[1]))) for part, arm in ends if arm != (0.0, 0.0)]


def find_normal(outline: SplineOutline, sight: Sight, index: int) -> Point:
    """The direction on the screen that leads out of a shape at a point."""
    count = len(outline.points)
    before = sight.place(outline.trace_curve((index - 1) % count)[-2])
    after = sight.place(outline.trace_curve(index)[1])
    across, down = after[0] - before[0], after[1] - before[1]
    length = math.hypot(across, down) or 1.0
    corners = [sight.place(place) for place in outline.places]
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise([*corners, corners[0]]))
    outward = -1.0 if area < 0.0 else 1.0
    return outward * down / length, -outward * across / length


def place_feather(outline: SplineOutline, sight: Sight, index: int, scale: float) -> Point:
    """Where on the screen the grip of a point's feather is: at the outer end of the soft edge, and a little farther."""
    (x, y), (across, down) = sight.place(outline.places[index]), find_normal(outline, sight, index)
    away = FEATHER_ARM * scale + 0.5 * outline.points[index][6] * measure_height(sight)
    return x + across * away, y + down * away


def measure_height(sight: Sight) -> float:
    """How high the picture is on the screen."""
    return sight.picture[1] * sight.zoom / sight.density


def _find_curve(outline: SplineOutline, sight: Sight, at: Point, reach: float) -> SplineTarget | None:
    """The curve of an outline under the mouse."""
    nearest, target = reach, None
    for index in range(len(outline.points)):
        places = [sight.place(place) for place in outline.trace_curve(index)]
        for step, (start, end) in enumerate(pairwise(places)):
            away, along = _measure_segment(at, start, end)
            if away <= nearest:
                nearest, target = away, SplineTarget(outline, "curve", index, (step + along) / STEPS)
    return target


def _measure_segment(at: Point, start: Point, end: Point) -> tuple[float, float]:
    """The distance from a point to a line between two others, and where along it the nearest place is."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    along = ((at[0] - start[0]) * dx + (at[1] - start[1]) * dy) / max(dx * dx + dy * dy, 1e-12)
    along = min(max(along, 0.0), 1.0)
    return math.dist(at, (start[0] + along * dx, start[1] + along * dy)), along


def find_selected(context: ViewerContext, outline: SplineOutline) -> list[int]:
    """The numbers of the selected points of an outline, in order."""
    numbers = context.viewer.pen.find_points(str(outline.points_port))
    return sorted(number for number in numbers if number < len(outline.points))


def list_keyed(context: ViewerContext, outline: SplineOutline) -> Mapping[int, bool]:
    """The points of an outline with keys of their own, by number: whether there is one at this frame."""
    points = context.session.graph.keyed_points.get(outline.points_port, {})
    return {number: context.session.time.find_key(port) is not None for number, port in points.items()}


def select_points(context: ViewerContext, outline: SplineOutline, numbers: Iterable[int]) -> None:
    """Select points of an outline."""
    context.viewer.pen.selection = str(outline.points_port), frozenset(numbers)


def find_chosen(context: ViewerContext) -> SplineOutline | None:
    """The selected shape of the active node."""
    return next((outline for outline in list_outlines(context) if outline.chosen), None)
