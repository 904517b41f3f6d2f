"""Shapes on the canvas: rectangles, curves of links, distances and crossings. Canvas units."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from ...authoring.edits.link_curves import Curve
from .view import MAX_ZOOM, MIN_ZOOM

Point = tuple[float, float]
Rect = tuple[float, float, float, float]
"""Left, top, right, bottom."""

GRID = 8.0
"""The grid step; positions snap to a multiple of twice this step."""

SAMPLES = 24
"""The number of straight pieces that approximate a curve for distances and crossings."""

_MARGIN = 48.0
"""Pixels around what is shown as a whole; less in a small window."""


class CanvasTransform(Struct, frozen=True):
    """Canvas units to pixels of the screen: `scale` pixels per unit, the canvas origin at `x`, `y`."""

    x: float
    y: float
    scale: float

    def to_screen(self, x: float, y: float) -> Point:
        """Where a canvas position is on the screen."""
        return self.x + x * self.scale, self.y + y * self.scale

    def to_canvas(self, x: float, y: float) -> Point:
        """The canvas position under a point of the screen."""
        return (x - self.x) / self.scale, (y - self.y) / self.scale


def make_transform(panel: Rect, center: Point, scale: float) -> CanvasTransform:
    """The transform that shows `center` in the middle of a panel; whole pixels at rest keep edges sharp."""
    left, top, right, bottom = panel
    return CanvasTransform(
        round((left + right) / 2 - center[0] * scale), round((top + bottom) / 2 - center[1] * scale), scale
    )


def zoom_about(center: Point, zoom: float, about: Point, factor: float) -> tuple[Point, float]:
    """Center and zoom after zooming by `factor` with the canvas position `about` staying where it is."""
    new_zoom = min(max(zoom * factor, MIN_ZOOM), MAX_ZOOM)
    ratio = zoom / new_zoom
    return (about[0] + (center[0] - about[0]) * ratio, about[1] + (center[1] - about[1]) * ratio), new_zoom


def find_bounds(rects: Iterable[Rect]) -> Rect | None:
    """The smallest rectangle around all, or None around nothing."""
    all_rects = tuple(rects)
    if not all_rects:
        return None
    lefts, tops, rights, bottoms = zip(*all_rects, strict=True)
    return min(lefts), min(tops), max(rights), max(bottoms)


def fit_view(bounds: Rect, size: Point, least_zoom: float = MIN_ZOOM) -> tuple[Point, float]:
    """Center and zoom that show a rectangle with a margin in a panel of `size` (pixels at UI scale 1).

    Of a rectangle that is too large for `least_zoom` they show the upper left part.
    """
    left, top, right, bottom = bounds
    across, down = max(right - left, 1.0), max(bottom - top, 1.0)
    room = [max(side - 2 * min(_MARGIN, side * 0.1), 16.0) for side in size]
    zoom = max(min(room[0] / across, room[1] / down, 1.0), least_zoom)
    return reveal_rect(bounds, ((left + right) / 2, (top + bottom) / 2), zoom, size), zoom


def reveal_rect(rect: Rect, center: Point, zoom: float, size: Point) -> Point:
    """The center of the view, moved until a rectangle can be seen in a panel of `size`; its top left if it is larger.

    `size` is in pixels at UI scale 1.
    """
    moved: list[float] = []
    for low, high, middle, side in zip(rect[:2], rect[2:], center, size, strict=True):
        margin = min(_MARGIN, side * 0.1) / zoom
        half = side / zoom / 2
        middle = max(middle, high + margin - half)
        moved.append(min(middle, low - margin + half))
    return moved[0], moved[1]


def avoid_corner(rect: Rect, center: Point, zoom: float, size: Point, corner: Point) -> Point:
    """The center of the view, moved so that what lies in its lower right corner does not cover a rectangle.

    `size` of the panel and of the `corner` are in pixels at UI scale 1. The shorter way counts; where the rectangle
    would leave the panel on both, nothing moves.
    """
    halves = [side / zoom / 2 for side in size]
    covered = [
        high - (middle + half - side / zoom)
        for high, middle, half, side in zip(rect[2:], center, halves, corner, strict=True)
    ]
    if min(covered) <= 0.0:
        return center
    room = [low - (middle - half) for low, middle, half in zip(rect[:2], center, halves, strict=True)]
    ways = [axis for axis in (0, 1) if covered[axis] <= room[axis]]
    if not ways:
        return center
    axis = min(ways, key=covered.__getitem__)
    return (center[0] + covered[0], center[1]) if axis == 0 else (center[0], center[1] + covered[1])


def contains(rect: Rect, x: float, y: float, margin: float = 0.0) -> bool:
    """True if a point is in a rectangle, or at most `margin` outside."""
    return rect[0] - margin <= x <= rect[2] + margin and rect[1] - margin <= y <= rect[3] + margin


def overlaps(first: Rect, second: Rect) -> bool:
    """True if the rectangles share any point."""
    return first[0] <= second[2] and second[0] <= first[2] and first[1] <= second[3] and second[1] <= first[3]


def span_rect(start: Point, end: Point) -> Rect:
    """The rectangle between two corners."""
    return min(start[0], end[0]), min(start[1], end[1]), max(start[0], end[0]), max(start[1], end[1])


def snap_to_grid(number: float, step: float = GRID * 2) -> float:
    """The nearest line of the grid."""
    return math.floor(number / step + 0.5) * step


def sample_curves(curves: NDArray[np.float64], count: int = SAMPLES) -> NDArray[np.float64]:
    """Points along curves: [n, 8] to [n, count + 1, 2]."""
    handles = curves.reshape(-1, 4, 2)
    t = np.linspace(0.0, 1.0, count + 1)
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    return np.einsum("sk,nkd->nsd", weights, handles)


def measure_distances(lines: NDArray[np.float64], point: Point) -> NDArray[np.float64]:
    """The distance of each of n polylines [n, m, 2] from a point: [n]."""
    starts, ends = lines[:, :-1], lines[:, 1:]
    along, to = ends - starts, np.asarray(point) - starts
    length = np.maximum((along * along).sum(axis=-1), 1e-12)
    part = np.clip((to * along).sum(axis=-1) / length, 0.0, 1.0)
    gap = to - along * part[..., None]
    return np.sqrt((gap * gap).sum(axis=-1).min(axis=1))


def find_crossed(lines: NDArray[np.float64], start: Point, end: Point) -> NDArray[np.bool_]:
    """Which of n polylines [n, m, 2] a straight line crosses: [n]."""
    a, b = lines[:, :-1], lines[:, 1:]
    c, d = np.asarray(start), np.asarray(end)
    is_crossed = (_find_side(a, b, c) * _find_side(a, b, d) <= 0) & (_find_side(c, d, a) * _find_side(c, d, b) <= 0)
    return np.asarray(is_crossed.any(axis=1)) if start != end else np.zeros(len(lines), np.bool_)


def find_crossing(line: NDArray[np.float64], start: Point, end: Point) -> Point:
    """Where a straight line meets a polyline [m, 2] that it crosses: the point of the polyline nearest to it."""
    c, d = np.asarray(start), np.asarray(end)
    a, b = line[:-1], line[1:]
    first, second = _find_side(c, d, a), _find_side(c, d, b)
    hit = (_find_side(a, b, c) * _find_side(a, b, d) <= 0) & (first * second <= 0)
    at = int(np.argmax(hit))
    span = first[at] - second[at]
    part = float(first[at] / span) if abs(span) > 1e-12 else 0.5
    x, y = a[at] + (b[at] - a[at]) * part
    return float(x), float(y)


def find_midpoint(shape: Curve) -> Point:
    """The middle of a curve."""
    x0, y0, x1, y1, x2, y2, x3, y3 = shape
    return (x0 + 3 * x1 + 3 * x2 + x3) / 8, (y0 + 3 * y1 + 3 * y2 + y3) / 8


def find_pan_direction(panel: Rect, x: float, y: float, border: float) -> Point:
    """How to pan while something is dragged near the border of a panel: -1..1 per axis, growing outwards."""
    return _find_push(x, panel[0], panel[2], border), _find_push(y, panel[1], panel[3], border)


def _find_push(at: float, low: float, high: float, border: float) -> float:
    if at < low + border:
        return -min((low + border - at) / border, 1.0)
    if at > high - border:
        return min((at - high + border) / border, 1.0)
    return 0.0


def _find_side(start: NDArray[np.float64], end: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positive on one side of a line, negative on the other."""
    along, to = end - start, point - start
    return along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]
