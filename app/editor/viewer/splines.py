"""Splines of the active node on the picture: what is under the mouse, and edits of points and tangents.

Points are drawn where the shape's transform puts them, and what the mouse does is taken back through it. So the points
in the file stay those of the shape before it is moved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

from halation.nodes import (
    ROTO_SHAPES,
    ItemSet,
    RotoShape,
    Row,
    curve_point,
    insert_point,
    join_points,
    list_curves,
    split_points,
)

from ...authoring.commands import AddItem, SetValues
from ...graph import Port
from ...graph.named_items import join_path
from ...language.translation import mark, translate
from ..fields.item_facts import choose_item
from .geometry import Point, Sight
from .item_lists import find_item_list

if TYPE_CHECKING:
    from .context import ViewerContext

SplinePart = Literal["point", "in", "out", "curve", "new", "close"]
"""What is under the mouse: a point, the end of a tangent, a curve, or with the pen a new point or the first one."""

STEPS = 24
"""The lines that a curve is drawn with: on a curve of 400 pixels they are a third of a pixel from it."""

_REACH = 9.0
"""The distance at which a point is hit, in pixels at UI scale 1: as that of other grips."""

_NEAR_CURVE = 5.0
"""The distance at which a curve is hit."""


@dataclass(frozen=True)
class SplineOutline:
    """A shape of the active node, on a picture of a size in pixels."""

    port: Port
    """The value that holds it."""
    name: str
    shape: RotoShape
    size: tuple[int, int]
    chosen: bool

    @property
    def points(self) -> tuple[Row, ...]:
        """The numbers of its points."""
        return split_points(self.shape.points)

    @property
    def places(self) -> tuple[Point, ...]:
        """Where its points are, as fractions of the picture."""
        return tuple(self.to_picture((point[0], point[1])) for point in self.points)

    @property
    def points_port(self) -> Port:
        """The field with its points."""
        return Port(self.port.node, join_path(self.port.socket, self.name, "points"))

    @property
    def token(self) -> str:
        """The merge token of a drag."""
        return f"spline {self.points_port}"

    def to_picture(self, place: Point) -> Point:
        """Where a place of the shape is, as a fraction of the picture."""
        a, b, c, d, e, f = self.shape.find_affine(self.size, math.radians(self.shape.rotation))
        x, y = place
        return (a * x + b * y + c) / self.size[0], (d * x + e * y + f) / self.size[1]

    def from_picture(self, place: Point) -> Point | None:
        """The place of the shape at a fraction of the picture; None if it has no size."""
        a, b, c, d, e, f = self.shape.find_affine(self.size, math.radians(self.shape.rotation))
        x, y, area = place[0] * self.size[0] - c, place[1] * self.size[1] - f, a * e - b * d
        if abs(area) < 1e-9:
            return None
        return round((e * x - b * y) / area, 6), round((a * y - d * x) / area, 6)

    def trace_curve(self, index: int) -> list[Point]:
        """Places along the curve that leaves a point, as fractions of the picture."""
        curve = list_curves(self.points)[index]
        return [self.to_picture(curve_point(curve, step / STEPS)) for step in range(STEPS + 1)]


@dataclass(frozen=True)
class SplineTarget:
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
    """The shapes of the active node at the current frame, the selected one last."""
    port = find_list(context)
    items = context.session.time.evaluated_graph.value(port) if port else None
    if port is None or not isinstance(items, ItemSet):
        return ()
    chosen = choose_item(context.items, str(port), items)
    outlines = (
        SplineOutline(port, name, RotoShape(**ROTO_SHAPES.settings(item)), context.viewer.picture, name == chosen)
        for name, item in items.items()
    )
    return tuple(sorted(outlines, key=lambda outline: outline.chosen))


def find_spline(context: ViewerContext, sight: Sight, at: Point, scale: float) -> SplineTarget | None:
    """The part of a shape under the mouse: points of the selected shape first, then its tangents, then curves."""
    outlines = list_outlines(context)
    for outline in reversed(outlines):
        selected = find_selected(context, outline)
        if outline.chosen and selected >= 0:
            for part, place in list_tangents(outline, selected):
                if math.dist(at, sight.place(place)) <= _REACH * scale:
                    return SplineTarget(outline, part, selected)
        for index, place in enumerate(outline.places if outline.chosen else ()):
            if math.dist(at, sight.place(place)) <= _REACH * scale:
                return SplineTarget(outline, "point", index)
    curves = (_find_curve(outline, sight, at, _NEAR_CURVE * scale) for outline in reversed(outlines))
    return next((target for target in curves if target), None)


def list_tangents(outline: SplineOutline, index: int) -> list[tuple[Literal["in", "out"], Point]]:
    """The ends of the tangents of a point, as fractions of the picture; corners have none."""
    x, y, *arms = outline.points[index][:6]
    ends: list[tuple[Literal["in", "out"], Point]] = [("in", (arms[0], arms[1])), ("out", (arms[2], arms[3]))]
    return [(part, outline.to_picture((x + arm[0], y + arm[1]))) for part, arm in ends if arm != (0.0, 0.0)]


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


def find_selected(context: ViewerContext, outline: SplineOutline) -> int:
    """The number of the selected point of an outline; -1 if none is."""
    number = context.viewer.pen.find_point(str(outline.points_port))
    return number if number < len(outline.points) else -1


def select_point(context: ViewerContext, outline: SplineOutline, number: int) -> None:
    """Select a point of an outline; none for -1."""
    context.viewer.pen.selection = str(outline.points_port), number


# --- edits ---------------------------------------------------------------------------------------------------------


def move_part(
    context: ViewerContext, target: SplineTarget, to: Point, *, is_broken: bool, pulls_tangents: bool
) -> None:
    """Move a point, with its tangents, or the end of a tangent, to a fraction of the picture.

    The other tangent follows as a mirror image of a smooth point, unless it `is_broken`. A point that
    `pulls_tangents` stays, and gets tangents to both sides.
    """
    place = target.outline.from_picture(to)
    if place is None:
        return
    point = target.outline.points[target.index]
    x, y = round(place[0] - point[0], 6), round(place[1] - point[1], 6)
    if target.part == "point" and not pulls_tangents:
        changed = (*place, *point[2:])
    elif target.part == "in":
        changed = (*point[:2], x, y, *(point[4:6] if is_broken else (-x, -y)), point[6])
    else:
        changed = (*point[:2], *(point[2:4] if is_broken and target.part == "out" else (-x, -y)), x, y, point[6])
    points = [*target.outline.points]
    points[target.index] = changed
    context.interface.dragging = True
    _set_points(context, target.outline, points, mark("Move a point of {shape}"), merge=target.outline.token)


def insert_on_curve(context: ViewerContext, target: SplineTarget) -> None:
    """Insert a point on a curve, which keeps its form."""
    points = insert_point(target.outline.points, target.index, target.t)
    _set_points(context, target.outline, [_round(point) for point in points], mark("Insert a point in {shape}"))
    select_point(context, target.outline, target.index + 1)


def can_remove_point(context: ViewerContext) -> bool:
    """True if a point of a shape is selected that has others."""
    outline = next(iter(reversed(list_outlines(context))), None)
    return outline is not None and find_selected(context, outline) >= 0 and len(outline.points) > 1


def remove_point(context: ViewerContext) -> None:
    """Remove the selected point of the selected shape."""
    outline = list_outlines(context)[-1]
    index = find_selected(context, outline)
    points = [point for number, point in enumerate(outline.points) if number != index]
    _set_points(context, outline, points, mark("Remove a point of {shape}"))
    select_point(context, outline, -1)


def _set_points(context: ViewerContext, outline: SplineOutline, points: list[Row], label: str, merge: str = "") -> None:
    """Set the points of a shape, or those of the key at this frame."""
    command = SetValues({outline.points_port: join_points(points)}, translate(label, shape=outline.name), merge=merge)
    context.log.attempt(lambda: context.session.apply(command))


def _round(point: Row) -> Row:
    return tuple(round(part, 6) for part in point)


# --- the pen -------------------------------------------------------------------------------------------------------


def can_draw(context: ViewerContext) -> bool:
    """True if the active node holds splines."""
    return find_list(context) is not None


def toggle_pen(context: ViewerContext) -> None:
    """Start to draw a new shape, or stop."""
    pen = context.viewer.pen
    if pen.is_drawing:
        pen.end()
    else:
        pen.begin()


def find_pen(context: ViewerContext, sight: Sight, at: Point, scale: float) -> SplinePart:
    """What a press of the pen does: close the shape at its first point, or add a point."""
    outline = find_drawn(context)
    if outline is None or len(outline.points) < 2:
        return "new"
    first = sight.place(outline.places[0])
    return "close" if math.dist(at, first) <= _REACH * scale else "new"


def find_drawn(context: ViewerContext) -> SplineOutline | None:
    """The shape that the pen draws."""
    return next(
        (outline for outline in list_outlines(context) if str(outline.points_port) == context.viewer.pen.shape), None
    )


def aim_pen(context: ViewerContext, start: Point, to: Point | None) -> None:
    """Keep the point that the pen sets when it is lifted: a corner, or with a drag a point with tangents."""
    outline = find_drawn(context)
    places = (outline.from_picture(place) if outline else place for place in (start, to or start))
    place, end = places
    if place is None or end is None:
        return
    x, y = end[0] - place[0], end[1] - place[1]
    context.viewer.pen.pending = _round((*place, -x, -y, x, y, 0.0))


def lift_pen(context: ViewerContext) -> None:
    """Add the pending point to the shape, or a new shape with it: one step of undo for each point."""
    pen, port = context.viewer.pen, find_list(context)
    point, pen.pending = pen.pending, None
    if point is None or port is None:
        return
    outline = find_drawn(context)
    if outline is not None:
        _set_points(context, outline, [*outline.points, point], mark("Add a point to {shape}"))
        select_point(context, outline, len(outline.points))
        return

    def add() -> None:
        name = context.session.apply(AddItem(port, "spline", {"points": point}, f"shape_{_count(context) + 1}"))
        context.items[str(port)], pen.shape = name, f"{port}.{name}.points"
        pen.selection = pen.shape, 0

    context.log.attempt(add)


def _count(context: ViewerContext) -> int:
    """The highest number of a name such as `shape_3`."""
    numbers = (outline.name.removeprefix("shape_") for outline in list_outlines(context))
    return max((int(number) for number in numbers if number.isdecimal()), default=0)
