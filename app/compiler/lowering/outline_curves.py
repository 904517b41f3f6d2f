"""Closed cubic curves as straight segments, in 64 bits. All lengths are pixels."""

from typing import NamedTuple, Self

import numpy as np
from halation.nodes import OutlineFill

Array = np.ndarray

_FARTHEST = 1e6
"""Pixels from the corner of the picture: no picture is so large, and what lies beyond is the same within it."""

_FINE = 0.002
"""How far in pixels a segment may be from its curve: keeps coverage within 2e-3 of exact areas, as the polygon is on
both sides of the curve, by two thirds of this at most."""

_CUT = 0.4
"""What the area of a polygon is off by where sides of a pixel cut it, as a part of the deviation times the length of a
segment: 0.13, as all that the middle of a segment has too much its ends lack, and a third at a corner."""

_MOST = 512
"""The most segments of a curve: as many as a quarter of a circle needs that is 3000 pixels high."""

_STRAIGHT = 1e-4
"""Pixels: how far control points of a straight line may lie beside it."""

_LOOSE = 1.0 / 750.0
"""How far a chord may be from its curve where it stands for the distance, as a part of the least feather there: 2e-3 of
coverage in the middle of the edge, where it changes most."""

_LEAST_SLACK = 0.002
"""The least such distance in pixels: 2e-3 of coverage in an edge of 1.5 pixels; narrower ones are mostly exact."""


class PlacedCurves(NamedTuple):
    """Closed contours of cubic curves."""

    curves: Array
    """A row for each curve: x and y of its four points."""
    following: Array
    """For each curve the number of the one that starts where it ends."""
    feathers: Array
    """The feather of the point where each curve starts."""

    @classmethod
    def of(cls, fill: OutlineFill) -> Self:
        """The outline of a fill in pixels. What lies farther away than any picture is moved nearer."""
        sources = [[np.array(contour).reshape(-1, 2) for contour in contours] for contours in fill.contours]
        matrices = [(place.number, np.array(place.matrix).reshape(2, 3)) for place in fill.places]
        placed = [
            contour @ matrix[:, :2].T + matrix[:, 2] for number, matrix in matrices for contour in sources[number]
        ]
        contours = [contour.reshape(-1, 8) for contour in placed if len(contour)]
        curves = np.clip(np.concatenate([np.zeros((0, 8)), *contours]), -_FARTHEST, _FARTHEST)
        counts = np.array([len(contour) for contour in contours], np.intp)
        following = np.arange(1, len(curves) + 1)
        following[np.cumsum(counts) - 1] = np.cumsum(counts) - counts
        return cls(curves, following, np.array(fill.feathers) if fill.feathers else np.zeros(len(curves)))

    @property
    def bends(self) -> Array:
        """The largest second difference of the control points of each curve; 0 of straight lines, however they run."""
        a, b, c, d = (self.curves[:, at : at + 2] for at in range(0, 8, 2))
        chord = d - a
        square = np.maximum((chord * chord).sum(axis=1), 1e-30)
        is_straight = np.ones(len(a), bool)
        for place in (b - a, c - a):
            along = (place * chord).sum(axis=1) / square
            aside = np.abs(place[:, 0] * chord[:, 1] - place[:, 1] * chord[:, 0]) / np.sqrt(square)
            is_straight &= (along >= -1e-9) & (along <= 1.0 + 1e-9) & (aside < _STRAIGHT)
        return np.where(is_straight, 0.0, np.maximum(_measure(a - 2.0 * b + c), _measure(b - 2.0 * c + d)))

    @property
    def lengths(self) -> Array:
        """The lengths of the control polygons."""
        a, b, c, d = (self.curves[:, at : at + 2] for at in range(0, 8, 2))
        return _measure(b - a) + _measure(c - b) + _measure(d - c)


class StraightSegments(NamedTuple):
    """Straight segments: a row of x and y of both ends for each, and the feather at both ends."""

    ends: Array
    feathers: Array

    @classmethod
    def none(cls) -> Self:
        """No segments."""
        return cls(np.zeros((0, 4)), np.zeros((0, 2)))


def flatten(outline: PlacedCurves) -> StraightSegments:
    """Polygons with the areas of the contours.

    Chords lie inside of a curve by two thirds of their sagitta, on average, which is the second derivative times
    dt^2 / 8. So their ends are moved outward by as much, by the mean of both where two curves meet. Coverage is a mean
    over a pixel: it is wrong by the deviation itself, or by less if segments are short.
    """
    bends = outline.bends
    short = np.cbrt(0.75 * _CUT * bends * outline.lengths / _FINE)
    return _divide(outline, np.clip(np.minimum(np.sqrt(0.75 * bends / _FINE), short), 1, _MOST), 1.0 / 12.0)


def measure_slack(feathers: Array) -> Array:
    """How far chords may be from their curve where edges are as wide as feathers."""
    return np.maximum(_LOOSE * feathers, _LEAST_SLACK)


def list_chords(outline: PlacedCurves, feather: float) -> StraightSegments:
    """Chords that stand for the distance to an outline, where an edge is as wide as a feather.

    Points may have more than this feather. Parts of equal times are as short as the sharpest bend wants them, so most
    of them are joined again: as many as lie beside one chord, by the places of twice as many points.
    """
    narrowest = feather + np.minimum(outline.feathers, outline.feathers[outline.following])
    slack = measure_slack(narrowest)
    bends = outline.bends
    wanted = np.ceil(np.minimum(np.sqrt(0.75 * bends / slack), _MOST))
    counts = np.where(wanted > 1.0, 4.0 * np.ceil(0.5 * wanted), 1.0).astype(np.intp)
    parts = _divide(outline, counts, 0.0)
    allowed = np.maximum(slack - 0.75 * bends / counts**2, 0.0)
    curve, number = spread_counts(counts)
    is_first, length = number % 2 == 0, 2
    while length < counts.max(initial=0):
        length *= 2
        starts = np.nonzero(number % length == 0)[0]
        joins = np.maximum.reduceat(_measure_aside(parts, starts), starts) <= allowed[curve[starts]]
        if not joins.any():
            break
        is_first &= ~np.repeat(joins, np.diff(starts, append=len(curve))) | (number % length == 0)
    return _join(parts, np.nonzero(is_first)[0])


def _measure_aside(parts: StraightSegments, starts: Array) -> Array:
    """How far each part begins beside the chord of the parts from one of `starts` to the next, in place or feather."""
    sizes, joined = np.diff(starts, append=len(parts.ends)), _join(parts, starts)
    (x, y, end_x, end_y), (width, end_width) = joined.ends.T, joined.feathers.T
    way_x, way_y, growth = end_x - x, end_y - y, end_width - width
    square = np.maximum(way_x * way_x + way_y * way_y, 1e-30)
    to_x, to_y = parts.ends[:, 0] - np.repeat(x, sizes), parts.ends[:, 1] - np.repeat(y, sizes)
    t = to_x * np.repeat(way_x / square, sizes) + to_y * np.repeat(way_y / square, sizes)
    t = np.clip(t, 0.0, 1.0)
    aside = np.hypot(to_x - t * np.repeat(way_x, sizes), to_y - t * np.repeat(way_y, sizes))
    if not parts.feathers.any():
        return aside
    return np.maximum(aside, np.abs(np.repeat(width, sizes) + t * np.repeat(growth, sizes) - parts.feathers[:, 0]))


def _join(parts: StraightSegments, starts: Array) -> StraightSegments:
    """The chords of the parts from each of `starts` to the one before the next."""
    last = np.append(starts[1:], len(parts.ends)) - 1
    ends = np.hstack([parts.ends[starts, :2], parts.ends[last, 2:]])
    return StraightSegments(ends, np.stack([parts.feathers[starts, 0], parts.feathers[last, 1]], axis=1))


def _divide(outline: PlacedCurves, part_counts: Array, push: float) -> StraightSegments:
    """Curves in as many parts as wanted. n parts are at most 3 / 4 of the bend / n^2 away from their curve."""
    counts = np.ceil(part_counts).astype(np.intp)
    curve, number = spread_counts(counts)
    t = (number / counts[curve])[:, None]
    u = 1.0 - t
    a, b, c, d = (outline.curves[curve, at : at + 2] for at in range(0, 8, 2))
    places = u * u * u * a + 3.0 * u * u * t * b + 3.0 * u * t * t * c + t * t * t * d
    first = np.cumsum(counts) - counts
    if push:
        places -= _find_shifts(outline, counts, curve, t) * push
    after = np.arange(1, len(places) + 1)
    after[first + counts - 1] = first[outline.following]
    widths = outline.feathers[:, None]
    widths = (widths[curve] * u + widths[outline.following[curve]] * t)[:, 0]
    return StraightSegments(np.hstack([places, places[after]]), np.stack([widths, widths[after]], axis=1))


def _find_shifts(outline: PlacedCurves, counts: Array, curve: Array, t: Array) -> Array:
    """The second derivative times dt^2 across the curve at each point; between two curves the mean of both."""
    first = np.cumsum(counts) - counts
    shifts = _bend_across(outline.curves[curve], t) / (counts[curve] ** 2)[:, None]
    ends = _bend_across(outline.curves, np.ones((len(counts), 1))) / (counts**2)[:, None]
    starts = first[outline.following]
    shifts[starts] = 0.5 * (shifts[starts] + ends)
    return shifts


def _bend_across(curves: Array, t: Array) -> Array:
    """The part of the second derivative of curves at t that is across their way."""
    a, b, c, d = (curves[:, at : at + 2] for at in range(0, 8, 2))
    u = 1.0 - t
    tangent = u * u * (b - a) + 2.0 * u * t * (c - b) + t * t * (d - c)
    tangent = np.where(_measure(tangent)[:, None] < 1e-9, d - a, tangent)
    bend = 6.0 * (u * (a - 2.0 * b + c) + t * (b - 2.0 * c + d))
    return bend - tangent * ((bend * tangent).sum(axis=1) / np.maximum((tangent * tangent).sum(axis=1), 1e-30))[:, None]


def spread_counts(counts: Array) -> tuple[Array, Array]:
    """For things of which there are several, one after the other: which thing it is, and its number among its like."""
    index = np.repeat(np.arange(len(counts)), counts)
    return index, np.arange(len(index)) - np.repeat(np.cumsum(counts) - counts, counts)


def _measure(ways: Array) -> Array:
    return np.hypot(ways[:, 0], ways[:, 1])
