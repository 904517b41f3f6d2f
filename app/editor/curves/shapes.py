"""Shapes of curves: keys as cubic pieces, pieces as points no finer than the screen. Nothing here draws.

Every segment between two keys is a cubic in (frame, value), so its pieces are exact: `Keys.at` lies on them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...errors import GraphError
from ...graph import Graph, Key, Keys, Port, Settings, value_at
from ..toolkit.plane import Plane

Pieces = NDArray[np.float64]
"""Cubic pieces [n, 4, 2]: start, two handles and end as (frame, value)."""

Line = NDArray[np.float64]
"""Points [n, 2]."""

TOLERANCE = 0.15
"""The largest error of a drawn curve, in pixels."""

_MOST, _REPEATS, _SAMPLES = 1024, 64, 240
"""The most points of a piece, repeats of a curve to each side, and samples of an expression that are drawn. Chosen by
judgement, only to bound the work of a frame."""


def read_key_channel(key: Key, channel: int) -> float:
    """A channel of a key as a number: of a switch, 0 or 1."""
    return key.channels[channel] if channel < len(key.channels) else float(bool(key.value))


def is_interpolated(keys: Keys, place: int) -> bool:
    """True if the value goes from the key of that place to the next one, rather than being held."""
    key = keys.keys[place]
    return (
        place + 1 < len(keys.keys)
        and key.interpolation != "constant"
        and 0 < len(key.channels) == len(keys.keys[place + 1].channels)
    )


def make_pieces(keys: Keys, channel: int) -> Pieces:
    """A channel between the first and the last key."""
    return make_all_pieces(keys)[channel]


def make_all_pieces(keys: Keys) -> list[Pieces]:
    """Every channel between the first and the last key, as cubic Bezier curves.

    Steps and straight lines are cubics with two equal points at each end, so that everything after this knows one kind
    of piece.
    """
    count = max((len(key.channels) for key in keys.keys), default=0) or 1
    cubics: list[tuple[tuple[float, ...], ...]] = []
    key_points = [(key.frame, *(read_key_channel(key, channel) for channel in range(count))) for key in keys.keys]
    interpolated = [is_interpolated(keys, place) for place in range(len(key_points))]
    bezier = [on and keys.keys[place].interpolation == "bezier" for place, on in enumerate(interpolated)]
    smooth = [on and keys.keys[place].interpolation == "smooth" for place, on in enumerate(interpolated)]
    handles = [
        keys.handles(frame) if bezier[place] or (place and bezier[place - 1]) else ((), ())
        for place, frame in enumerate(keys.frames)
    ]
    slopes = [
        keys.slopes(frame) if smooth[place] or (place and smooth[place - 1]) else ()
        for place, frame in enumerate(keys.frames)
    ]
    for place, (a, b) in enumerate(pairwise(key_points)):
        if not interpolated[place]:
            corner = b[0], *a[1:]
            cubics += [(a, a, corner, corner), (corner, corner, b, b)]
        elif bezier[place]:
            cubics.append((a, _add(a, handles[place][1]), _add(b, handles[place + 1][0]), b))
        elif smooth[place]:
            third = (b[0] - a[0]) / 3.0
            out = third, *(third * slope for slope in slopes[place])
            back = -third, *(-third * slope for slope in slopes[place + 1])
            cubics.append((a, _add(a, out), _add(b, back), b))
        else:
            cubics.append((a, a, b, b))
    whole = np.array(cubics, np.float64).reshape(-1, 4, 1 + count)
    return [np.ascontiguousarray(whole[..., (0, 1 + channel)]) for channel in range(count)]


def make_outside_pieces(keys: Keys, channel: int, inner: Pieces, first: float, last: float) -> tuple[Pieces, Pieces]:
    """A channel before the first key, from the frame `first`, and after the last one, to the frame `last`."""
    start, end = keys.frames[0], keys.frames[-1]
    if keys.outside in ("loop", "mirror") and end > start:
        return _repeat_pieces(keys, inner, first, last)
    before, after = np.empty((0, 4, 2)), np.empty((0, 4, 2))
    if first < start:
        before = _make_straight(
            (first, read_channel(keys.evaluate(first), channel)), (start, read_key_channel(keys.keys[0], channel))
        )
    if last > end:
        after = _make_straight(
            (end, read_key_channel(keys.keys[-1], channel)), (last, read_channel(keys.evaluate(last), channel))
        )
    return before, after


def read_channel(value: object, channel: int) -> float:
    """A channel of a value."""
    part = value[channel] if isinstance(value, tuple) else value
    return float(part) if isinstance(part, int | float) else 0.0


def is_straight(curve: Pieces) -> NDArray[np.bool_]:
    """Which pieces have both handles at their ends."""
    return (curve[:, 0] == curve[:, 1]).all(axis=1) & (curve[:, 2] == curve[:, 3]).all(axis=1)


def project_pieces(
    curve: Pieces, plane: Plane, straight: NDArray[np.bool_] | None = None
) -> tuple[Pieces, NDArray[np.bool_]]:
    """Pieces in pixels, and which of them are bent where they can be seen."""
    screen = np.empty_like(curve)
    screen[..., 0] = plane.rect[0] + (curve[..., 0] - plane.view.first) * plane.across
    screen[..., 1] = np.clip(plane.rect[3] - (curve[..., 1] - plane.view.low) * plane.up, -1e6, 1e6)
    tops, bottoms = screen[..., 1].min(axis=1, initial=np.inf), screen[..., 1].max(axis=1, initial=-np.inf)
    unseen = (bottoms < plane.rect[1]) | (tops > plane.rect[3])
    return screen, ~(unseen | (is_straight(curve) if straight is None else straight))


def flatten_curves(curves: Sequence[Pieces], plane: Plane) -> list[Line]:
    """Every curve as points on the screen, as far as it is seen: none where nothing of it is.

    The number of lines of a piece follows from how far it bends: `sqrt(3/4 bend / tolerance)` keeps the lines within
    the tolerance (Wang's formula for cubics). All pieces of all curves are computed in one go by numpy.
    """
    view = plane.view
    visible_curves = [curve[(curve[:, 3, 0] >= view.first) & (curve[:, 0, 0] <= view.last)] for curve in curves]
    screen, bent = project_pieces(np.concatenate([np.empty((0, 4, 2)), *visible_curves]), plane)
    if not len(screen):
        return [np.empty((0, 2)) for _ in visible_curves]
    p0, p1, p2, p3 = (screen[:, place] for place in range(4))
    bend = np.maximum(np.hypot(*(p0 - 2.0 * p1 + p2).T), np.hypot(*(p1 - 2.0 * p2 + p3).T)) * bent
    count = np.clip(np.ceil(np.sqrt(0.75 * bend / TOLERANCE)), 1, _MOST).astype(np.int64)
    ends = np.cumsum(count)
    piece_of = np.repeat(np.arange(len(count)), count)
    t = ((np.arange(ends[-1]) - (ends - count)[piece_of] + 1) / count[piece_of])[:, None]
    v = 1.0 - t
    curve_points = (
        v**3 * p0[piece_of] + 3.0 * v * v * t * p1[piece_of] + 3.0 * v * t * t * p2[piece_of] + t**3 * p3[piece_of]
    )
    lines: list[Line] = []
    place = 0
    for curve in visible_curves:
        if len(curve):
            begin = ends[place] - count[place]
            lines.append(np.concatenate([p0[place : place + 1], curve_points[begin : ends[place + len(curve) - 1]]]))
        else:
            lines.append(np.empty((0, 2)))
        place += len(curve)
    return lines


class ExpressionSamples:
    """An expression at whole frames, each computed once until the graph changes."""

    def __init__(self) -> None:
        self._inputs: tuple[object, ...] = ()
        self._graph = Graph()
        self._values: dict[tuple[Port, int], object] = {}

    def sample_lines(
        self, graph: Graph, settings: Settings, port: Port, channel: int, first: float, last: float
    ) -> list[Line]:
        """Points (frame, value), one line for each run of frames that has a value; fewer where there are many."""
        inputs = graph.nodes, graph.animation, graph.controls, settings
        if len(inputs) != len(self._inputs) or any(a is not b for a, b in zip(inputs, self._inputs, strict=True)):
            self._inputs, self._values, self._graph = inputs, {}, replace(graph, settings=settings)
        stride = 1
        while (last - first) / stride > _SAMPLES:
            stride *= 2
        runs: list[list[tuple[float, float]]] = [[]]
        for frame in range(int(first // stride) * stride, int(last) + stride + 1, stride):
            value = self._evaluate(port, frame)
            if value is not None:
                runs[-1].append((float(frame), read_channel(value, channel)))
            elif runs[-1]:
                runs.append([])
        return [np.array(run, np.float64) for run in runs if run]

    def _evaluate(self, port: Port, frame: int) -> object:
        if (port, frame) not in self._values:
            try:
                self._values[port, frame] = value_at(self._graph, port, frame)
            except GraphError:
                self._values[port, frame] = None
        return self._values[port, frame]


def cut_dashes(line: Line, on: float, off: float) -> list[Line]:
    """A line cut into dashes, on the screen."""
    if len(line) < 2:
        return []
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    dash_lines: list[Line] = []
    for begin in np.arange(0.0, along[-1], on + off)[:2000]:
        end = min(begin + on, along[-1])
        a, b = np.searchsorted(along, begin, "right"), np.searchsorted(along, end)
        corners = [begin, *along[a:b], end]
        dash_lines.append(np.stack([np.interp(corners, along, line[:, axis]) for axis in (0, 1)], axis=1))
    return dash_lines


def find_value_range(
    keys: Keys, channel: int, at: Callable[[Key], bool] = lambda key: True
) -> tuple[float, float] | None:
    """The lowest and the highest value of a channel, over the keys for which `at` is true."""
    chosen_keys = [key for key in keys.keys if at(key)]
    if not chosen_keys:
        return None
    numbers = [read_key_channel(key, channel) for key in chosen_keys]
    inner = make_pieces(keys, channel)
    frames = {key.frame for key in chosen_keys}
    near = [piece for piece in inner if piece[0, 0] < piece[3, 0] and {piece[0, 0], piece[3, 0]} <= frames]
    numbers += [float(part) for piece in near for part in piece[1:3, 1]]
    return min(numbers), max(numbers)


def _make_straight(start: tuple[float, float], end: tuple[float, float]) -> Pieces:
    return np.array([(start, start, end, end)], np.float64)


def _repeat_pieces(keys: Keys, inner: Pieces, first: float, last: float) -> tuple[Pieces, Pieces]:
    """The pieces between the ends, repeated forwards or to and fro over the visible frames.

    A loop jumps from its last value to its first one: `jump` is the upright line between them.
    """
    start, end = keys.frames[0], keys.frames[-1]
    span = end - start
    back = inner[::-1, ::-1].copy()
    back[..., 0] = start + end - back[..., 0]
    before = min(int(max(start - first, 0.0) // span) + 1, _REPEATS) if first < start else 0
    after = min(int(max(last - end, 0.0) // span) + 1, _REPEATS) if last > end else 0

    jump = _make_straight((start, inner[-1, 3, 1]), (start, inner[0, 0, 1]))

    def repeat(turns: range) -> list[Pieces]:
        repeats: list[Pieces] = []
        for repeat_number in turns:
            later = np.array((repeat_number * span, 0.0))
            if keys.outside == "loop":
                repeats.append(jump + later)
            repeats.append((back if keys.outside == "mirror" and repeat_number % 2 else inner) + later)
        return repeats

    ahead, behind = repeat(range(1, after + 1)), repeat(range(-before, 0))
    if behind and keys.outside == "loop":
        behind.append(jump)
    none = np.empty((0, 4, 2))
    return np.concatenate([none, *behind]), np.concatenate([none, *ahead])


def _add(point: tuple[float, ...], offset: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(a + b for a, b in zip(point, offset, strict=True))
