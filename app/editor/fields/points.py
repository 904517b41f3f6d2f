"""Edits of curves and color ramps. Nothing here draws."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from halation.nodes import MAX_POINTS, curve_at, ramp_at

from ...language.translation import mark

Numbers = tuple[float, ...]

NEAREST = 1e-3
"""The least distance between two points of a curve."""

CURVES: Mapping[str, Numbers] = MappingProxyType(
    {
        mark("Linear"): (0.0, 0.0, 1.0, 1.0),
        mark("S curve"): (0.0, 0.0, 0.25, 0.15, 0.75, 0.85, 1.0, 1.0),
        mark("Ease in"): (0.0, 0.0, 0.5, 0.2, 1.0, 1.0),
        mark("Ease out"): (0.0, 0.0, 0.5, 0.8, 1.0, 1.0),
        mark("Inverted"): (0.0, 1.0, 1.0, 0.0),
    }
)

RAMPS: Mapping[str, Numbers] = MappingProxyType(
    {
        mark("Black to white"): (0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0),
        mark("Fire"): (
            0.0,
            0.0,
            0.0,
            0.0,
            1.0,
            0.4,
            0.8,
            0.05,
            0.0,
            1.0,
            0.75,
            1.0,
            0.5,
            0.05,
            1.0,
            1.0,
            1.0,
            1.0,
            0.8,
            1.0,
        ),
        mark("Cold to warm"): (0.0, 0.02, 0.1, 0.6, 1.0, 0.5, 0.8, 0.8, 0.8, 1.0, 1.0, 0.7, 0.1, 0.02, 1.0),
        mark("Spectrum"): (
            0.0,
            1.0,
            0.0,
            0.0,
            1.0,
            0.17,
            1.0,
            1.0,
            0.0,
            1.0,
            0.33,
            0.0,
            1.0,
            0.0,
            1.0,
            0.5,
            0.0,
            1.0,
            1.0,
            1.0,
            0.67,
            0.0,
            0.0,
            1.0,
            1.0,
            0.83,
            1.0,
            0.0,
            1.0,
            1.0,
            1.0,
            1.0,
            0.0,
            0.0,
            1.0,
        ),
    }
)


def split_points(numbers: Numbers, width: int) -> list[Numbers]:
    """The points, `width` numbers each."""
    return [numbers[at : at + width] for at in range(0, len(numbers), width)]


def join_points(points: list[Numbers]) -> Numbers:
    """The flat list of points."""
    return tuple(part for point in points for part in point)


def move_point(numbers: Numbers, width: int, index: int, point: Numbers) -> Numbers:
    """Move a point; it stays between its neighbors and within 0 to 1."""
    points = split_points(numbers, width)
    gap = NEAREST if width == 2 else 0.0
    low = points[index - 1][0] + gap if index > 0 else 0.0
    high = points[index + 1][0] - gap if index + 1 < len(points) else 1.0
    place = min(max(point[0], low), max(high, low))
    points[index] = (place, *point[1:])
    return join_points(points)


def insert_point(numbers: Numbers, width: int, point: Numbers) -> tuple[Numbers, int]:
    """Insert a point; returns the points and its index. If there is one at that place already, only its index is new.

    Where there are as many as there may be, the nearest one's.
    """
    points = split_points(numbers, width)
    if len(points) >= MAX_POINTS:
        return numbers, min(range(len(points)), key=lambda index: abs(points[index][0] - point[0]))
    for index, existing in enumerate(points):
        if width == 2 and abs(existing[0] - point[0]) < NEAREST:
            return numbers, index
    at = sum(existing[0] <= point[0] for existing in points)
    points.insert(at, (min(max(point[0], 0.0), 1.0), *point[1:]))
    return join_points(points), at


def remove_point(numbers: Numbers, width: int, index: int) -> Numbers:
    """Remove a point, unless only two are left."""
    points = split_points(numbers, width)
    if len(points) > 2:
        del points[index]
    return join_points(points)


def invert(numbers: Numbers, width: int, low: float = 0.0, high: float = 1.0) -> Numbers:
    """Invert a curve within its soft range; reverse a ramp."""
    if width == 2:
        return join_points([(x, low + high - y) for x, y in split_points(numbers, 2)])
    return join_points([(1.0 - stop[0], *stop[1:]) for stop in reversed(split_points(numbers, width))])


def scale_curve(preset: Numbers, low: float, high: float) -> Numbers:
    """A preset curve, scaled to a soft range."""
    return join_points([(x, low + y * (high - low)) for x, y in split_points(preset, 2)])


def curve_line(numbers: Numbers, count: int) -> list[tuple[float, float]]:
    """Points of the drawn curve from x = 0 to 1."""
    return [(index / (count - 1), curve_at(numbers, index / (count - 1))) for index in range(count)]


def ramp_color(numbers: Numbers, t: float) -> tuple[float, float, float, float]:
    """The display color of a ramp at a position."""
    return ramp_at(numbers, t)


def find_nearest(numbers: Numbers, width: int, x: float, y: float | None, reach: tuple[float, float]) -> int:
    """The index of the point within `reach` of a position (only x for a ramp), -1 if there is none."""
    best, nearest_index = 1.0, -1
    for index, point in enumerate(split_points(numbers, width)):
        away = ((point[0] - x) / reach[0]) ** 2 + (0.0 if y is None else ((point[1] - y) / reach[1]) ** 2)
        if away <= best:
            best, nearest_index = away, index
    return nearest_index
