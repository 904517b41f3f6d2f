"""What curves and color ramps are between their points."""

from __future__ import annotations

from bisect import bisect_right
from itertools import pairwise

MAX_POINTS = 17
"""The points that a curve or a ramp has at most: what GLSL is handed is an array of fixed length, of 16 spans."""

_NEVER = 1e30
"""A place that no number reaches: of the points that GLSL must not find."""


def curve_knots(points: tuple[float, ...]) -> tuple[float, ...]:
    """What `curve_at` in lib/curve.glsl takes: x, y, slope, 0 of every point, and points out of reach to the end."""
    xs, ys = points[0::2], points[1::2]
    knots = [part for knot in zip(xs, ys, _slopes(xs, ys), strict=True) for part in (*knot, 0.0)]
    return (*knots, *(_NEVER, ys[-1], 0.0, 0.0) * (MAX_POINTS - len(xs)))


def ramp_knots(stops: tuple[float, ...]) -> tuple[float, ...]:
    """What `ramp_at` in lib/curve.glsl takes: t, 1 / (next t - t), 0, 0, then the color of every stop, and so on."""
    ts = stops[0::5]
    widths = [*(right - left for left, right in pairwise(ts)), 0.0]
    knots = [
        part
        for at, (t, width) in enumerate(zip(ts, widths, strict=True))
        for part in (t, 1.0 / width if width > 0.0 else 0.0, 0.0, 0.0, *_stop(stops, at))
    ]
    return (*knots, *(_NEVER, 0.0, 0.0, 0.0, *_stop(stops, len(ts) - 1)) * (MAX_POINTS - len(ts)))


def curve_at(points: tuple[float, ...], x: float) -> float:
    """The height at `x` of the curve through `x0, y0, x1, y1, ...`; level beyond its ends.

    Between two points it neither rises above the higher nor falls below the lower one: a monotone piecewise cubic with
    the slopes of Fritsch and Butland (1984), as scipy's PchipInterpolator.
    """
    xs, ys = points[0::2], points[1::2]
    if x <= xs[0]:
        return ys[0]
    if x >= xs[-1]:
        return ys[-1]
    at = bisect_right(xs, x) - 1
    width = xs[at + 1] - xs[at]
    slopes = _slopes(xs, ys)
    t = (x - xs[at]) / width
    start, end, lift, fall = ys[at], ys[at + 1], width * slopes[at], width * slopes[at + 1]
    return (
        (2 * t**3 - 3 * t**2 + 1) * start
        + (t**3 - 2 * t**2 + t) * lift
        + (3 * t**2 - 2 * t**3) * end
        + (t**3 - t**2) * fall
    )


def ramp_at(stops: tuple[float, ...], t: float, smooth: bool = False) -> tuple[float, float, float, float]:
    """The color at `t` of the ramp `t, r, g, b, a, ...`; level beyond its ends, the later of two stops at one place.

    Between stops it changes evenly, or eases in and out (3u^2 - 2u^3) if `smooth`.
    """
    ts = stops[0::5]
    after = bisect_right(ts, t)
    first, second = _stop(stops, max(after - 1, 0)), _stop(stops, min(after, len(ts) - 1))
    if after in (0, len(ts)):
        return first
    u = (t - ts[after - 1]) / (ts[after] - ts[after - 1])
    u = u * u * (3.0 - 2.0 * u) if smooth else u
    red, green, blue, alpha = (a + (b - a) * u for a, b in zip(first, second, strict=True))
    return red, green, blue, alpha


def _stop(stops: tuple[float, ...], index: int) -> tuple[float, float, float, float]:
    _, red, green, blue, alpha = stops[index * 5 : index * 5 + 5]
    return red, green, blue, alpha


def _slopes(xs: tuple[float, ...], ys: tuple[float, ...]) -> list[float]:
    """The slope at every point: the weighted harmonic mean of those beside it, 0 at a peak."""
    widths = [end - start for start, end in pairwise(xs)]
    rises = [(right - left) / width for (left, right), width in zip(pairwise(ys), widths, strict=True)]
    if len(rises) == 1:
        return [rises[0], rises[0]]
    inner = [
        _between(before, after, wide, narrow)
        for (before, after), (wide, narrow) in zip(pairwise(rises), pairwise(widths), strict=True)
    ]
    first = _at_end(rises[0], rises[1], widths[0], widths[1])
    return [first, *inner, _at_end(rises[-1], rises[-2], widths[-1], widths[-2])]


def _between(before: float, after: float, width_before: float, width_after: float) -> float:
    if before * after <= 0.0:
        return 0.0
    first, second = 2 * width_after + width_before, width_after + 2 * width_before
    return (first + second) / (first / before + second / after)


def _at_end(near: float, far: float, width: float, next_width: float) -> float:
    """The slope at an end, by three points, limited so that the curve stays monotone."""
    slope = ((2 * width + next_width) * near - width * far) / (width + next_width)
    if slope * near <= 0.0:
        return 0.0
    if near * far <= 0.0 and abs(slope) > 3 * abs(near):
        return 3 * near
    return slope
