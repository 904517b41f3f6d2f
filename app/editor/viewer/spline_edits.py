"""Edits of splines by mouse and actions: points are moved, inserted, removed and copied, and drawn by the pen."""

from __future__ import annotations

import math
from collections.abc import Iterable
from types import MappingProxyType
from typing import TYPE_CHECKING

from halation.nodes import Node, Row, insert_point

from ...authoring.commands import AddItem, ChangePoints, DropPointKeys, KeyPoints, MovePoints, SplineEdit
from ...language.translation import mark, translate
from .geometry import Point, Sight
from .splines import (
    FEATHER_ARM,
    REACH,
    SplineOutline,
    SplinePart,
    SplineTarget,
    find_chosen,
    find_list,
    find_normal,
    find_own_outline,
    find_selected,
    list_keyed,
    list_outlines,
    measure_height,
    select_points,
)

if TYPE_CHECKING:
    from .context import ViewerContext


def begin_move(context: ViewerContext, target: SplineTarget, *, adds: bool) -> None:
    """Select what a drag moves: a point, or with `adds` one more or one less; selected ones stay together."""
    outline = target.outline
    if outline.items is not None:
        context.items[str(outline.items)] = outline.name
    if target.part == "curve":
        select_points(context, outline, ())
        return
    selected = set(find_selected(context, outline))
    if adds:
        selected ^= {target.index}
    elif target.index not in selected:
        selected = {target.index}
    select_points(context, outline, selected)


def select_alone(context: ViewerContext, target: SplineTarget) -> None:
    """Select a point that was clicked, and no others."""
    if target.part == "point":
        select_points(context, target.outline, (target.index,))


def move_part(
    context: ViewerContext, target: SplineTarget, by: Point, to: Point, *, is_broken: bool, pulls_tangents: bool
) -> None:
    """Move the selected points `by` fractions of the picture, with their tangents, or a tangent's end `to` a place.

    The other tangent follows as a mirror image of a smooth point, unless it `is_broken`. A point that
    `pulls_tangents` stays, and gets tangents to both sides.
    """
    outline, points = target.outline, [*target.outline.points]
    if target.part == "point" and not pulls_tangents:
        for index in {target.index, *find_selected(context, outline)}:
            points[index] = _move_point(outline, index, by)
    elif (place := outline.from_picture(to)) is not None:
        point = points[target.index]
        x, y = round(place[0] - point[0], 6), round(place[1] - point[1], 6)
        if target.part == "in":
            points[target.index] = (*point[:2], x, y, *(point[4:6] if is_broken else (-x, -y)), point[6])
        else:
            keeps_other = is_broken and target.part == "out"
            points[target.index] = (*point[:2], *(point[2:4] if keeps_other else (-x, -y)), x, y, point[6])
    context.interface.dragging = True
    _set_points(context, outline, points, mark("Move a point of {shape}"), merge=outline.token)


def drag_feather(context: ViewerContext, target: SplineTarget, sight: Sight, at: Point, scale: float) -> None:
    """Set the feather of a point by the place on the screen to which its grip is dragged."""
    outline, points = target.outline, [*target.outline.points]
    (x, y), (across, down) = sight.place(outline.places[target.index]), find_normal(outline, sight, target.index)
    away = (at[0] - x) * across + (at[1] - y) * down - FEATHER_ARM * scale
    feather = round(max(2.0 * away / measure_height(sight), 0.0), 5)
    points[target.index] = (*points[target.index][:6], feather)
    context.interface.dragging = True
    _set_points(context, outline, points, mark("Feather a point of {shape}"), merge=outline.token)


def _move_point(outline: SplineOutline, index: int, by: Point) -> Row:
    """A point that is moved by fractions of the picture."""
    x, y = outline.places[index]
    place = outline.from_picture((x + by[0], y + by[1]))
    return (*(place or outline.points[index][:2]), *outline.points[index][2:])


def nudge_points(context: ViewerContext, by: Point) -> None:
    """Move the selected points by pixels of the picture."""
    outline = find_chosen(context)
    if outline is None:
        return
    points, (width, height) = [*outline.points], outline.size
    for index in find_selected(context, outline):
        points[index] = _move_point(outline, index, (by[0] / width, by[1] / height))
    _set_points(context, outline, points, mark("Nudge points of {shape}"), merge=f"nudge {outline.points_port}")


def insert_on_curve(context: ViewerContext, target: SplineTarget) -> None:
    """Insert a point on a curve, which keeps its form."""
    _change_points(
        context,
        target.outline,
        lambda points: insert_point(points, target.index, target.t),
        mark("Insert a point in {shape}"),
        (*range(target.index + 1), None, *range(target.index + 1, len(target.outline.points))),
    )
    select_points(context, target.outline, (target.index + 1,))


def has_selected_points(context: ViewerContext) -> bool:
    """True if points of a shape are selected."""
    outline = find_chosen(context)
    return outline is not None and bool(find_selected(context, outline))


def can_remove_points(context: ViewerContext) -> bool:
    """True if points of a shape are selected that has others."""
    outline = find_chosen(context)
    return outline is not None and 0 < len(find_selected(context, outline)) < len(outline.points)


def remove_points(context: ViewerContext) -> None:
    """Remove the selected points of the selected shape."""
    outline = find_chosen(context)
    assert outline is not None
    removed = find_selected(context, outline)
    kept = tuple(number for number in range(len(outline.points)) if number not in removed)

    def remove(points: tuple[Row, ...]) -> Iterable[Row]:
        return (point for number, point in enumerate(points) if number not in removed)

    _change_points(context, outline, remove, mark("Remove points of {shape}"), kept)
    select_points(context, outline, ())


def select_all_points(context: ViewerContext) -> None:
    """Select all points of the selected shape."""
    if (outline := find_chosen(context)) is not None:
        select_points(context, outline, range(len(outline.points)))


def select_in_lasso(context: ViewerContext) -> None:
    """Add the points within the lasso to the selected ones; a lasso of no size selects none."""
    lasso, context.viewer.pen.lasso = context.viewer.pen.lasso, []
    outline = find_chosen(context)
    if outline is None:
        return
    inside = {number for number, place in enumerate(outline.places) if _is_inside(place, lasso)}
    select_points(context, outline, inside.union(find_selected(context, outline)) if inside else ())


def _is_inside(place: Point, lasso: list[Point]) -> bool:
    """True if a line from a place to the right crosses a closed line an odd number of times."""
    x, y = place
    crossings = 0
    for (ax, ay), (bx, by) in zip(lasso, (*lasso[1:], *lasso[:1]), strict=True):
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            crossings += 1
    return crossings % 2 == 1


def copy_points(context: ViewerContext) -> None:
    """Copy the selected points of the selected shape, or all of them, as they are at this frame."""
    outline = find_chosen(context)
    if outline is not None:
        numbers = find_selected(context, outline) or range(len(outline.points))
        context.viewer.pen.copied = MappingProxyType({number: outline.points[number] for number in numbers})


def can_paste_points(context: ViewerContext) -> bool:
    """True if points were copied, and a shape is selected that has one of their numbers."""
    outline = find_chosen(context)
    return outline is not None and any(number < len(outline.points) for number in context.viewer.pen.copied)


def paste_points(context: ViewerContext) -> None:
    """Set the points of the copied numbers as they were copied, at this frame."""
    outline, copied = find_chosen(context), context.viewer.pen.copied
    if outline is not None:
        points = [copied.get(number, point) for number, point in enumerate(outline.points)]
        _set_points(context, outline, points, mark("Paste points into {shape}"))


def toggle_ripple(context: ViewerContext) -> None:
    """Edit the points at all of their keys, or only at this frame."""
    context.viewer.pen.ripples = not context.viewer.pen.ripples


def toggle_singly(context: ViewerContext) -> None:
    """Give points that are edited keys of their own, or key all points together."""
    context.viewer.pen.singly = not context.viewer.pen.singly


def key_selected_points(context: ViewerContext) -> None:
    """Set keys of the selected points at this frame, which the others do not get."""
    if (outline := find_chosen(context)) is not None:
        label = translate("Key points of {shape}", shape=outline.name)
        command = KeyPoints(outline.points_port, tuple(find_selected(context, outline)), label)
        context.log.attempt(lambda: context.session.apply(command))


def can_drop_keys(context: ViewerContext) -> bool:
    """True if one of the selected points has keys of its own."""
    outline = find_chosen(context)
    return outline is not None and not list_keyed(context, outline).keys().isdisjoint(find_selected(context, outline))


def drop_keys(context: ViewerContext) -> None:
    """Key the selected points together with the others again."""
    if (outline := find_chosen(context)) is not None:
        label = translate("Key points of {shape} together", shape=outline.name)
        command = DropPointKeys(outline.points_port, tuple(find_selected(context, outline)), label)
        context.log.attempt(lambda: context.session.apply(command))


def _set_points(context: ViewerContext, outline: SplineOutline, points: list[Row], label: str, merge: str = "") -> None:
    """Set the points of a shape, those of the key at this frame, or with ripple those of all keys."""
    named = translate(label, shape=outline.name)
    pen = context.viewer.pen
    command = MovePoints(outline.points_port, tuple(points), named, merge, pen.ripples, pen.singly)
    context.log.attempt(lambda: context.session.apply(command))


def _change_points(
    context: ViewerContext,
    outline: SplineOutline,
    change: SplineEdit,
    label: str,
    origins: tuple[int | None, ...],
) -> None:
    """Change which points a shape has, in all keys. `origins` are the numbers that they had, None of new ones."""
    command = ChangePoints(outline.points_port, change, translate(label, shape=outline.name), origins=origins)
    context.log.attempt(lambda: context.session.apply(command))


def _round(point: Row) -> Row:
    return tuple(round(part, 6) for part in point)


# --- the pen -------------------------------------------------------------------------------------------------------


def can_draw(context: ViewerContext) -> bool:
    """True if the active node holds splines."""
    return find_list(context) is not None or find_own_outline(context) is not None


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
    return "close" if math.dist(at, first) <= REACH * scale else "new"


def find_drawn(context: ViewerContext) -> SplineOutline | None:
    """The shape that the pen draws."""
    return next(
        (outline for outline in list_outlines(context) if str(outline.points_port) == context.viewer.pen.shape), None
    )


def find_pen_frame(context: ViewerContext) -> SplineOutline | None:
    """The shape in whose coordinates the pen sets the next point; None for a new one, which has not moved yet."""
    return find_drawn(context) or _find_replaced(context)


def _find_replaced(context: ViewerContext) -> SplineOutline | None:
    """The shape that the pen draws anew: the only one of a node, or the one of a list that nobody has changed."""
    port = find_list(context)
    if port is None:
        return find_own_outline(context)
    item = context.session.graph.nodes.get(port.node)
    if not isinstance(item, Node) or item.setting(port.socket) != item.values[port.socket].default:
        return None
    outlines = list_outlines(context)
    return outlines[0] if len(outlines) == 1 else None


def aim_pen(context: ViewerContext, start: Point, to: Point | None) -> None:
    """Keep the point that the pen sets when it is lifted: a corner, or with a drag a point with tangents."""
    outline = find_pen_frame(context)
    places = (outline.from_picture(place) if outline else place for place in (start, to or start))
    place, end = places
    if place is None or end is None:
        return
    x, y = end[0] - place[0], end[1] - place[1]
    context.viewer.pen.pending = _round((*place, -x, -y, x, y, 0.0))


def lift_pen(context: ViewerContext) -> None:
    """Add the pending point to the shape, or a new shape with it: one step of undo for each point.

    Of a node with one spline of its own, and of the shape that a new list begins with, the first point takes the place
    of all there are.
    """
    pen, port = context.viewer.pen, find_list(context)
    point, pen.pending = pen.pending, None
    if point is None:
        return
    outline = find_drawn(context)
    if outline is not None:
        origins = (*range(len(outline.points)), None)
        _change_points(context, outline, lambda points: (*points, point), mark("Add a point to {shape}"), origins)
        select_points(context, outline, (len(outline.points),))
        return

    if (replaced := _find_replaced(context)) is not None:
        _change_points(context, replaced, lambda _: (point,), mark("Draw {shape}"), (None,))
        pen.shape = str(replaced.points_port)
        select_points(context, replaced, (0,))
        return

    if port is None:
        return

    def add() -> None:
        name = context.session.apply(AddItem(port, "spline", {"points": point}, f"shape_{_count(context) + 1}"))
        context.items[str(port)], pen.shape = name, f"{port}.{name}.points"
        pen.selection = pen.shape, frozenset((0,))

    context.log.attempt(add)


def _count(context: ViewerContext) -> int:
    """The highest number of a name such as `shape_3`."""
    numbers = (outline.name.removeprefix("shape_") for outline in list_outlines(context))
    return max((int(number) for number in numbers if number.isdecimal()), default=0)
