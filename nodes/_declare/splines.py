"""Closed splines: cubic Bezier curves through points with tangents, as flat numbers and as rows of a file.

A point has seven numbers: x and y, the offsets to the ends of its two tangents (that of the curve which arrives, then
that of the one which leaves), and its feather. Positions and offsets are fractions of the picture, the feather of its
height. A file has a row for each point, without the zeros at its end: a corner is `[x, y]`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, cast

POINT_LENGTH = 7
"""The numbers of a point."""

MAX_SPLINE_POINTS = 4096
"""The most points of one spline: eight times the 500 of an outline that is traced by hand point by point."""

Row = tuple[float, ...]
Place = tuple[float, float]
CubicCurve = tuple[Place, Place, Place, Place]
"""The four control points of a cubic Bezier curve."""


def list_rows(numbers: Row) -> tuple[Row, ...]:
    """The rows of a spline, one for each point, without zeros at their end."""
    return tuple(_trim_row(point) for point in split_points(numbers))


def _trim_row(point: Row) -> Row:
    length = len(point)
    while length > 2 and point[length - 1] == 0.0:
        length -= 1
    return point[:length]


def split_points(numbers: Row) -> tuple[Row, ...]:
    """The seven numbers of each point."""
    return tuple(numbers[at : at + POINT_LENGTH] for at in range(0, len(numbers), POINT_LENGTH))


def join_points(points: Iterable[Row]) -> Row:
    """The flat numbers of a spline from rows of two to seven numbers."""
    return tuple(part for point in points for part in (*point, *(0.0,) * (POINT_LENGTH - len(point))))


def read_rows(setting: object) -> Row | None:
    """The flat numbers of a spline from the rows of a file, or from numbers that are flat already; None for others."""
    if not isinstance(setting, list | tuple) or not setting:
        return None
    parts = cast("tuple[Any, ...]", tuple(setting))  # pyright: ignore[reportUnknownArgumentType]
    if _are_numbers(parts):
        return tuple(map(float, parts)) if len(parts) % POINT_LENGTH == 0 else None
    if not all(isinstance(row, list | tuple) for row in parts):
        return None
    rows = [tuple(row) for row in cast("tuple[list[Any], ...]", parts)]
    if not all(2 <= len(row) <= POINT_LENGTH and _are_numbers(row) for row in rows):
        return None
    return join_points(tuple(map(float, row)) for row in rows)


def _are_numbers(parts: Iterable[object]) -> bool:
    return all(isinstance(part, int | float) and not isinstance(part, bool) for part in parts)


def list_curves(points: tuple[Row, ...]) -> tuple[CubicCurve, ...]:
    """The cubic curves of a closed spline, one from each point to the next."""
    return tuple(
        (
            (start[0], start[1]),
            (start[0] + start[4], start[1] + start[5]),
            (end[0] + end[2], end[1] + end[3]),
            (end[0], end[1]),
        )
        for start, end in zip(points, (*points[1:], *points[:1]), strict=True)
    )


def split_curve(curve: CubicCurve, t: float) -> tuple[CubicCurve, CubicCurve]:
    """The two parts of a cubic curve before and after `t` (de Casteljau)."""
    first, second, third, last = curve
    a, b, c = _mix(first, second, t), _mix(second, third, t), _mix(third, last, t)
    d, e = _mix(a, b, t), _mix(b, c, t)
    middle = _mix(d, e, t)
    return (first, a, d, middle), (middle, e, c, last)


def curve_point(curve: CubicCurve, t: float) -> Place:
    """The point of a cubic curve at `t`."""
    return split_curve(curve, t)[0][3]


def insert_point(points: tuple[Row, ...], index: int, t: float) -> tuple[Row, ...]:
    """The points with one more on the curve that leaves point `index`, at `t`: the outline stays as it is."""
    after = (index + 1) % len(points)
    before, behind = split_curve(list_curves(points)[index], t)
    start, end = list(points[index]), list(points[after])
    x, y = before[3]
    start[4:6] = before[1][0] - before[0][0], before[1][1] - before[0][1]
    if after == index:
        end = start
    end[2:4] = behind[2][0] - behind[3][0], behind[2][1] - behind[3][1]
    feather = points[index][6] + (points[after][6] - points[index][6]) * t
    middle = (x, y, before[2][0] - x, before[2][1] - y, behind[1][0] - x, behind[1][1] - y, feather)
    changed = {index: tuple(start), after: tuple(end)}
    whole = [changed.get(place, point) for place, point in enumerate(points)]
    return (*whole[: index + 1], middle, *whole[index + 1 :])


def _mix(a: Place, b: Place, t: float) -> Place:
    return a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t
