"""Bezier segments between two keys: cubics in (frame, channels).

The handles are limited so that their frames lie inside the segment. Then frame(t) is monotone and every frame has
exactly one t, as in CSS Easing Functions (cubic-bezier), Blender and After Effects.
"""

from __future__ import annotations

from itertools import pairwise

Point = tuple[float, ...]
"""A frame, and then every channel."""

Segment = tuple[Point, Point, Point, Point]

_SAME_FRAME = 1e-9
"""A handle is vertical if it is nearer to its key than this part of the segment, where its slope has no meaning."""

_LEVEL = 1e-12
"""Slopes below this are 0 but for rounding: Newton's method would leave the segment."""

_LEAST_STEP, _LEAST_BRACKET = 1e-15, 1e-16
"""Steps of t and brackets that doubles near 1 do not tell from 0 (2e-16)."""

_MAX_STEPS = 100
"""More than bisection needs for all bits of a double; Newton's method needs 3 to 6."""


def limit_handles(first: Point, last: Point, right: Point, left: Point) -> Segment:
    """The four points of a segment whose handles are given as offsets.

    A handle that ends outside of the segment is shortened and keeps its direction. One that points away from the
    segment becomes vertical.
    """
    width = last[0] - first[0]
    right_share = min(1.0, width / right[0]) if right[0] > 0.0 else 1.0
    left_share = min(1.0, -width / left[0]) if left[0] < 0.0 else 1.0
    right_handle = (first[0] + min(max(right[0], 0.0), width), *_add_scaled(first, right, right_share))
    left_handle = (last[0] - min(max(-left[0], 0.0), width), *_add_scaled(last, left, left_share))
    return first, right_handle, left_handle, last


def evaluate(first: Point, right_handle: Point, left_handle: Point, last: Point, frame: float) -> Point:
    """The channels at a frame inside a segment."""
    t = _solve_parameter(first, right_handle, left_handle, last, frame)
    v = 1.0 - t
    weights = (v * v * v, 3.0 * v * v * t, 3.0 * v * t * t, t * t * t)
    points = zip(first[1:], right_handle[1:], left_handle[1:], last[1:], strict=True)
    return tuple(sum(w * part for w, part in zip(weights, parts, strict=True)) for parts in points)


def split(first: Point, right_handle: Point, left_handle: Point, last: Point, frame: float) -> tuple[Point, ...]:
    """Split a segment at a frame (de Casteljau), so that its shape stays.

    Returns the right handle of the start; left handle, channels and right handle of the new key; and the left handle
    of the end. Handles are offsets.
    """
    t = _solve_parameter(first, right_handle, left_handle, last, frame)
    row: list[Point] = [first, right_handle, left_handle, last]
    starts, ends = [first], [last]
    while len(row) > 1:
        row = [tuple(a + (b - a) * t for a, b in zip(*pair, strict=True)) for pair in pairwise(row)]
        starts.append(row[0])
        ends.append(row[-1])
    middle = (frame, *row[0][1:])
    return (
        _subtract(first, starts[1]),
        _subtract(middle, starts[2]),
        middle[1:],
        _subtract(middle, ends[2]),
        _subtract(last, ends[1]),
    )


def end_slopes(first: Point, right_handle: Point, left_handle: Point, last: Point, *, last_end: bool) -> Point:
    """The slopes of the curve at one end of a segment; for a vertical handle, the slopes towards the next point."""
    points = (last, left_handle, right_handle, first) if last_end else (first, right_handle, left_handle, last)
    end_point = points[0]
    next_point = next(
        (point for point in points[1:] if abs(point[0] - end_point[0]) > _SAME_FRAME * abs(last[0] - first[0])),
        points[3],
    )
    return tuple(part / (next_point[0] - end_point[0]) for part in _subtract(end_point, next_point)[1:])


def _solve_parameter(first: Point, right_handle: Point, left_handle: Point, last: Point, frame: float) -> float:
    """The parameter t (0 to 1) of a frame: by Newton's method, with bisection where it leaves the bracket."""
    width = last[0] - first[0]
    target, a, b = (frame - first[0]) / width, (right_handle[0] - first[0]) / width, (left_handle[0] - first[0]) / width
    cubic, square, line = 1.0 + 3.0 * (a - b), 3.0 * (b - 2.0 * a), 3.0 * a
    low, high, t = 0.0, 1.0, target
    for _ in range(_MAX_STEPS):
        error = ((cubic * t + square) * t + line) * t - target
        low, high = (low, t) if error > 0.0 else (t, high)
        slope = (3.0 * cubic * t + 2.0 * square) * t + line
        step = t - error / slope if slope > _LEVEL else -1.0
        if error == 0.0 or abs(step - t) < _LEAST_STEP or high - low < _LEAST_BRACKET:
            return t
        t = step if low < step < high else 0.5 * (low + high)
    return t


def _add_scaled(point: Point, offset: Point, share: float) -> Point:
    return tuple(part + more * share for part, more in zip(point[1:], offset[1:], strict=True))


def _subtract(point: Point, end: Point) -> Point:
    return tuple(b - a for a, b in zip(point, end, strict=True))
