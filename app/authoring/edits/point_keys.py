"""Keys of the points of splines: a key holds all points, or a point has keys of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import cast

from halation.nodes import SPLINE_ROWS, Row, join_points, split_points
from msgspec import structs

from ...graph import Graph, Key, Keys, Port, value_at
from ...graph.spline_points import name_point, pick_point, put_points

SplineEdit = Callable[[tuple[Row, ...]], Iterable[Row]]
"""What an edit makes of the points of a spline."""


def points_at(graph: Graph, spline: Port, frame: float) -> tuple[Row, ...]:
    """The points of a spline at a frame."""
    return split_points(cast("Row", value_at(graph, spline, frame)))


def key_all_points(graph: Graph, spline: Port, points: Sequence[Row], frame: float) -> Graph:
    """Set all points: those of a key at a frame, or where they have none, as they are.

    Points with keys of their own get one as well where the others do, and else if they moved.
    """
    before, keys = points_at(graph, spline, frame), graph.animation.get(spline)
    own = _list_own_keys(graph, spline)
    if isinstance(keys, Keys):
        graph = graph.animate(spline, keys.set(frame, join_points(points)))
    else:
        numbers, still = join_points(points), graph.animation
        resting = {number: pick_point(_read(graph, spline), number) for number in own}
        graph = replace(graph.set(spline, put_points(numbers, resting)), animation=still)
    for number, item in own.items():
        if isinstance(keys, Keys) or points[number] != before[number]:
            graph = graph.animate(name_point(spline, number), item.set(frame, points[number]))
    return graph


def key_moved_points(graph: Graph, spline: Port, points: Sequence[Row], frame: float) -> Graph:
    """Set the points that moved, each in keys of its own; where there are no keys at all, as they are."""
    before = points_at(graph, spline, frame)
    moved = {number: point for number, point in enumerate(points) if point != before[number]}
    for number in [number for number in moved if find_point_keys(graph, spline, number).keys]:
        keys = find_point_keys(graph, spline, number).set(frame, moved.pop(number))
        graph = set_point_keys(graph, spline, number, keys)
    if not moved:
        return graph
    numbers = put_points(_read(graph, spline), moved)
    return replace(graph.set(spline, numbers), animation=graph.animation)


def find_point_keys(graph: Graph, spline: Port, number: int) -> Keys:
    """The keys of a point: its own, else those of all points as far as they are about it."""
    own, keys = graph.animation.get(name_point(spline, number)), graph.animation.get(spline)
    if isinstance(own, Keys):
        return own
    return _pick_keys(keys, number) if isinstance(keys, Keys) else Keys()


def set_point_keys(graph: Graph, spline: Port, number: int, keys: Keys) -> Graph:
    """The graph where a point has keys of its own."""
    all_keys = graph.animation.get(spline)
    if isinstance(all_keys, Keys):
        graph = _fit_count(graph, spline, split_points(cast("Row", all_keys.keys[0].value)))
    return graph.animate(name_point(spline, number), keys)


def drop_point_keys(graph: Graph, spline: Port, number: int, frame: float) -> Graph:
    """The graph where a point has no keys of its own: it follows those of all points, or stays as it is at a frame."""
    point, port = points_at(graph, spline, frame)[number], name_point(spline, number)
    if port not in graph.animation:
        return graph
    graph = graph.animate(port, None)
    if spline in graph.animation:
        return graph
    return replace(graph.put(spline, put_points(_read(graph, spline), {number: point})), animation=graph.animation)


def change_points(graph: Graph, spline: Port, change: SplineEdit, origins: Sequence[int | None] | None) -> Graph:
    """Change the points of a spline in the same way in all keys, those of single points too, or where it has none.

    `origins` says which point each one was before, None of one that is new. Without it they are the same ones. A new
    point beside one with keys of its own gets such keys too, so that the outline stays as the edit made it.
    """
    own, keys, rows = _list_own_keys(graph, spline), graph.animation.get(spline), split_points(_read(graph, spline))
    ports = {name_point(spline, number) for number in own}
    after = replace(graph, animation={port: item for port, item in graph.animation.items() if port not in ports})
    if isinstance(keys, Keys):
        after = after.animate(spline, structs.replace(keys, keys=tuple(_change_key(key, change) for key in keys.keys)))
    else:
        after = after.set(spline, join_points(_round(change(rows))))
    places = range(len(rows)) if origins is None else origins
    for number, origin in enumerate(places) if own else ():
        beside = [places[number - 1], places[(number + 1) % len(places)]] if origin is None else [origin]
        changed = _change_own(graph, spline, change, number, [own[place] for place in beside if place in own])
        if changed.keys and (origin is not None or not _follows(after, spline, number, changed)):
            after = set_point_keys(after, spline, number, changed)
    return after


def _change_own(graph: Graph, spline: Port, change: SplineEdit, number: int, own: Sequence[Keys]) -> Keys:
    """The keys of a point after an edit, at the frames of others: those that it had, or its neighbors have."""
    if not own:
        return Keys()
    keys = Keys(tuple(key for item in own for key in item.keys), own[0].outside)
    changed = (
        structs.replace(key, value=_round(change(points_at(graph, spline, key.frame)))[number]) for key in keys.keys
    )
    return structs.replace(keys, keys=tuple(changed))


def _follows(graph: Graph, spline: Port, number: int, keys: Keys) -> bool:
    """True if a point is where keys put it, without them."""
    return all(points_at(graph, spline, key.frame)[number] == key.value for key in keys.keys)


def _list_own_keys(graph: Graph, spline: Port) -> dict[int, Keys]:
    """The keys that points have of their own, by number, as far as there are such points."""
    ports = graph.keyed_points.get(spline, {})
    count = len(split_points(_read(graph, spline)))
    return {
        number: item
        for number, port in ports.items()
        if number < count and isinstance(item := graph.animation[port], Keys)
    }


def _read(graph: Graph, spline: Port) -> Row:
    """The points as they are set, before keys."""
    return cast("Row", graph.value(spline))


def _pick_keys(keys: Keys, number: int) -> Keys:
    """The keys of all points, as far as they are about one."""
    at = number * SPLINE_ROWS.length

    def pick(handle: Row) -> Row:
        return (handle[0], *handle[at + 1 : at + 1 + SPLINE_ROWS.length]) if handle else ()

    picked = (
        structs.replace(key, value=point, left=pick(key.left), right=pick(key.right))
        for key in keys.keys
        if (point := pick_point(key.value, number))
    )
    return structs.replace(keys, keys=tuple(picked))


def _fit_count(graph: Graph, spline: Port, points: Sequence[Row]) -> Graph:
    """The graph where a spline has as many points without its keys as with them, so that each point has a name."""
    if len(split_points(_read(graph, spline))) == len(points):
        return graph
    return replace(graph.set(spline, join_points(points)), animation=graph.animation)


def _change_key(key: Key, change: SplineEdit) -> Key:
    points = join_points(_round(change(split_points(cast("Row", key.value)))))
    if len(points) != len(cast("Row", key.value)):
        return structs.replace(key, value=points, left=(), right=())  # handles have a number for each channel
    return structs.replace(key, value=points)


def _round(points: Iterable[Row]) -> tuple[Row, ...]:
    return tuple(tuple(round(part, 6) for part in point) for point in points)
