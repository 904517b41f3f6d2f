"""Closed splines: cubic Bezier curves through points with tangents, as flat numbers and as rows of a file.

A point has seven numbers: x and y, the offsets to the ends of its two tangents (that of the curve which arrives, then
that of the one which leaves), and its feather. Positions and offsets are fractions of the picture, the feather of its
height. A file has a row for each point, without the zeros at its end: a corner is `[x, y]`.
"""

from __future__ import annotations

from collections.abc import Iterable

from .lettering import Contour
from .rows import SPLINE_ROWS, Row

Place = tuple[float, float]
CubicCurve = tuple[Place, Place, Place, Place]
"""The four control points of a cubic Bezier curve."""


def list_rows(numbers: Row) -> tuple[Row, ...]:
    """The rows of a spline, one for each point, without zeros at their end."""
    return SPLINE_ROWS.list(numbers)


def split_points(numbers: Row) -> tuple[Row, ...]:
    """The seven numbers of each point."""
    return SPLINE_ROWS.split(numbers)


def join_points(points: Iterable[Row]) -> Row:
    """The flat numbers of a spline from rows of two to seven numbers."""
    return SPLINE_ROWS.join(points)


def read_rows(setting: object) -> Row | None:
    """The flat numbers of a spline from the rows of a file, or from numbers that are flat already; None for others."""
    return SPLINE_ROWS.read(setting)


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


def trace_spline(numbers: Row, height: float) -> tuple[Contour, tuple[float, ...]]:
    """A spline as an outline to fill, and the feathers of its points in pixels of a picture of this height."""
    points = split_points(numbers)
    contour = tuple((*a, *b, *c, *d) for a, b, c, d in list_curves(points))
    return contour, tuple(max(point[6], 0.0) * height for point in points)


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
