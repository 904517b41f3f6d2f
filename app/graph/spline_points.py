"""Single points of a spline as values: `mask.shapes.face.points.3` is the fourth point of a shape.

A point may have keys of its own. Then it is where these put it, whatever keys of all points say.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

from halation.nodes import SPLINE_ROWS, Plain, Row, Value
from msgspec import structs

from .model import Port

_DIGITS = 4
"""Digits of the highest number that a point can have."""


def split_point(socket: str) -> tuple[str, int] | None:
    """The socket with the points and the number of a point, counted from 0; None if a socket ends with no number."""
    head, _, number = socket.rpartition(".")
    is_number = number.isascii() and number.isdecimal() and len(number) <= _DIGITS
    return (head, int(number)) if head and is_number and str(int(number)) == number else None


def name_point(points: Port, number: int) -> Port:
    """The port of a point of a spline."""
    return Port(points.node, f"{points.socket}.{number}")


def find_point(socket: str, find: Callable[[str], Value | None]) -> Value | None:
    """The point of a spline that a socket names, with its setting as default; None if it names none.

    `find` gives a value by its socket.
    """
    point = split_point(socket)
    points = find(point[0]) if point else None
    if point is None or points is None or points.type != "spline":
        return None
    row = pick_point(points.default, point[1])
    return structs.replace(points, type="point", default=row) if row else None


def explain_missing_point(socket: str, node: str, find: Callable[[str], Value | None]) -> str:
    """Why a spline has no point that a socket names; "" for a socket that names no point of a spline."""
    point = split_point(socket)
    points = find(point[0]) if point else None
    if point is None or points is None or not isinstance(points.default, tuple) or points.type != "spline":
        return ""
    count = len(points.default) // points.length
    return f"'{node}.{point[0]}' has {count} points, counted from 0: there is no point {point[1]}"


class KeyedPoints:
    """A graph's points that have keys of their own."""

    animation: Mapping[Port, Any]

    @cached_property
    def keyed_points(self) -> Mapping[Port, Mapping[int, Port]]:
        """The points with keys of their own: by spline and number."""
        groups: dict[Port, dict[int, Port]] = {}
        for port in self.animation:
            if point := split_point(port.socket):
                groups.setdefault(Port(port.node, point[0]), {})[point[1]] = port
        return groups


def put_points(numbers: Row, points: Mapping[int, Any]) -> Row:
    """The numbers of a spline with other ones for some of its points; those that do not exist change nothing."""
    length = SPLINE_ROWS.length
    changed = list(numbers)
    for number, point in points.items():
        if (number + 1) * length <= len(numbers):
            changed[number * length : (number + 1) * length] = point
    return tuple(changed)


def pick_point(numbers: Plain, number: int) -> Row | None:
    """The numbers of a point; None if there is none."""
    length = SPLINE_ROWS.length
    if not isinstance(numbers, tuple) or (number + 1) * length > len(numbers):
        return None
    return numbers[number * length : (number + 1) * length]
