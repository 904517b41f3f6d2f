"""A piece of a Bezier curve that is a function: cubic in (frame, channels), frames never going back.

With the frames of both handles inside the segment, frame(t) is monotone, so every frame has one t (as in CSS Easing
Functions, cubic-bezier, and in Blender and After Effects, which limit handles in the same way).
"""

from __future__ import annotations

from itertools import pairwise

Point = tuple[float, ...]
"""A frame, and then every channel."""

Segment = tuple[Point, Point, Point, Point]

_STEPS = 100


def limit_handles(first: Point, last: Point, right: Point, left: Point) -> Segment:
    """The segment from `first` to `last` with handles as offsets: shortened to end inside, their directions kept.

    A handle that points away from the segment stands upright.
    """
    width = last[0] - first[0]
    reach = min(1.0, width / right[0]) if right[0] > 0.0 else 1.0
    back = min(1.0, -width / left[0]) if left[0] < 0.0 else 1.0
    one = (first[0] + min(max(right[0], 0.0), width), *_along(first, right, reach))
    two = (last[0] - min(max(-left[0], 0.0), width), *_along(last, left, back))
    return first, one, two, last


def at(first: Point, one: Point, two: Point, last: Point, frame: float) -> Point:
    """The channels at a frame inside the segment."""
    t = _t(first, one, two, last, frame)
    v = 1.0 - t
    weights = (v * v * v, 3.0 * v * v * t, 3.0 * v * t * t, t * t * t)
    points = zip(first[1:], one[1:], two[1:], last[1:], strict=True)
    return tuple(sum(w * part for w, part in zip(weights, parts, strict=True)) for parts in points)


def split(first: Point, one: Point, two: Point, last: Point, frame: float) -> tuple[Point, ...]:
    """The segment cut at a frame (de Casteljau): what the five handles and channels of its two halves are.

    That is the right handle of the start, the left handle, channels and right handle of the new key, and the left
    handle of the end. Handles are offsets.
    """
    t = _t(first, one, two, last, frame)
    row: list[Point] = [first, one, two, last]
    starts, ends = [first], [last]
    while len(row) > 1:
        row = [tuple(a + (b - a) * t for a, b in zip(*pair, strict=True)) for pair in pairwise(row)]
        starts.append(row[0])
        ends.append(row[-1])
    middle = (frame, *row[0][1:])
    return (
        _offset(first, starts[1]),
        _offset(middle, starts[2]),
        middle[1:],
        _offset(middle, ends[2]),
        _offset(last, ends[1]),
    )


def end_slopes(first: Point, one: Point, two: Point, last: Point, *, last_end: bool) -> Point:
    """The slopes with which the curve leaves the segment; of an upright end, those towards the next point."""
    points = (last, two, one, first) if last_end else (first, one, two, last)
    here = points[0]
    other = next((point for point in points[1:] if abs(point[0] - here[0]) > 1e-9 * abs(last[0] - first[0])), points[3])
    return tuple(part / (other[0] - here[0]) for part in _offset(here, other)[1:])


def _t(first: Point, one: Point, two: Point, last: Point, frame: float) -> float:
    """Where along the curve a frame lies, 0 to 1: Newton's method, inside a bracket that halves where it fails."""
    width = last[0] - first[0]
    u, a, b = (frame - first[0]) / width, (one[0] - first[0]) / width, (two[0] - first[0]) / width
    cubic, square, line = 1.0 + 3.0 * (a - b), 3.0 * (b - 2.0 * a), 3.0 * a
    low, high, t = 0.0, 1.0, u
    for _ in range(_STEPS):
        error = ((cubic * t + square) * t + line) * t - u
        low, high = (low, t) if error > 0.0 else (t, high)
        slope = (3.0 * cubic * t + 2.0 * square) * t + line
        step = t - error / slope if slope > 1e-12 else -1.0
        if error == 0.0 or abs(step - t) < 1e-15 or high - low < 1e-16:
            return t
        t = step if low < step < high else 0.5 * (low + high)
    return t


def _along(point: Point, offset: Point, share: float) -> Point:
    return tuple(part + more * share for part, more in zip(point[1:], offset[1:], strict=True))


def _offset(point: Point, other: Point) -> Point:
    return tuple(b - a for a, b in zip(point, other, strict=True))
