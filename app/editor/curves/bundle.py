"""All curves that are shown, in a few arrays: what of it depends on the view is made in one go. Nothing here draws."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...graph import Interpolation, Keys, Port
from ..toolkit.plane import Plane
from .hits import Mark, line_at
from .rows import CurveRow, Lane, Spot
from .shapes import Pieces, all_pieces, is_straight, level, on_screen, outside, points

Floats = NDArray[np.float64]
_BEYOND = 12.0
"""Pixels beyond the border at which keys are still drawn."""


@dataclass(frozen=True)
class Shape:
    """A channel of keys: its pieces, and the frames, values, names and shapes of its keys."""

    keys: Keys
    pieces: Pieces
    frames: Floats
    values: Floats
    spots: tuple[frozenset[Spot], ...]
    looks: tuple[Interpolation, ...]


def shape(lane: Lane, keys: Keys, inner: Pieces) -> Shape:
    """What a channel looks like, its pieces given."""
    port, channel = lane
    return Shape(
        keys,
        inner,
        np.array(keys.frames),
        np.array([level(key, channel) for key in keys.keys]),
        tuple(frozenset(((port, frame, channel),)) for frame in keys.frames),
        tuple(key.interpolation for key in keys.keys),
    )


@dataclass(frozen=True)
class Bundle:
    """Channels one after the other; `piece_of` and `key_of` say which one a piece and a key belong to."""

    lanes: tuple[Lane, ...] = ()
    shapes: tuple[Shape, ...] = ()
    pieces: Pieces = field(default_factory=lambda: np.empty((0, 4, 2)))
    straight: NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, np.bool_))
    piece_of: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))
    frames: Floats = field(default_factory=lambda: np.empty(0))
    values: Floats = field(default_factory=lambda: np.empty(0))
    key_of: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))
    spots: tuple[frozenset[Spot], ...] = ()
    looks: tuple[Interpolation, ...] = ()
    edges: Floats = field(default_factory=lambda: np.empty((0, 5)))
    """Frame and value of the first and the last key of every channel, and 1 where they hold beyond."""

    def seen(self, plane: Plane) -> Seen:
        """What of it is on the screen."""
        view = plane.view
        inside = (self.pieces[:, 3, 0] >= view.first) & (self.pieces[:, 0, 0] <= view.last)
        screen, bent = on_screen(self.pieces[inside], plane, self.straight[inside])
        cuts = np.searchsorted(self.piece_of[inside], np.arange(len(self.lanes) + 1))
        room = _BEYOND / plane.across
        shown = np.nonzero((self.frames >= view.first - room) & (self.frames <= view.last + room))[0]
        xs = plane.rect[0] + (self.frames[shown] - view.first) * plane.across
        ys = plane.rect[3] - (self.values[shown] - view.low) * plane.up
        return Seen(self, plane, screen, bent, cuts.tolist(), shown, xs, ys)

    def ends(self, plane: Plane) -> tuple[list[int], Pieces, NDArray[np.bool_], list[int]]:
        """What lies beyond the keys, on the screen: channels of ways, their pieces, which are bent, where ways end."""
        view = plane.view
        first, low, last, high, holds = self.edges.T
        before = np.nonzero((holds > 0.0) & (first > view.first))[0]
        after = np.nonzero((holds > 0.0) & (last < view.last))[0]
        level = np.empty((len(before) + len(after), 4, 2))
        level[:, :2, 0] = np.concatenate([np.full(len(before), view.first), last[after]])[:, None]
        level[:, 2:, 0] = np.concatenate([first[before], np.full(len(after), view.last)])[:, None]
        level[..., 1] = np.concatenate([low[before], high[after]])[:, None]
        of: list[int] = [*before.tolist(), *after.tolist()]
        found: list[Pieces] = [level[place : place + 1] for place in range(len(level))]
        for place in np.nonzero(holds == 0.0)[0].tolist():
            one = self.shapes[place]
            both = outside(one.keys, self.lanes[place][1], one.pieces, view.first, view.last)
            ways = [way for way in both if len(way)]
            found += ways
            of += [place] * len(ways)
        screen, bent = on_screen(np.concatenate([np.empty((0, 4, 2)), *found]), plane)
        return of, screen, bent, np.cumsum([0, *map(len, found)]).tolist()


@dataclass(frozen=True)
class Seen:
    """The pieces on the screen, `cuts` where those of every channel begin, and the keys: which, and where."""

    bundle: Bundle
    plane: Plane
    screen: Pieces
    bent: NDArray[np.bool_]
    cuts: list[int]
    shown: NDArray[np.int64]
    xs: Floats
    ys: Floats

    def mark(self, place: int) -> Mark:
        """A key that is seen."""
        key, bundle = int(self.shown[place]), self.bundle
        channel = bundle.lanes[bundle.key_of[key]][1]
        return Mark(float(self.xs[place]), float(self.ys[place]), bundle.spots[key], bundle.looks[key], channel)

    def marks(self) -> list[Mark]:
        """All keys that are seen."""
        return [self.mark(place) for place in range(len(self.shown))]

    def near(self, x: float, y: float, reach: float, spots: Collection[Spot]) -> Mark | None:
        """The key that is closest to a point and within reach; of several at one place one that is chosen."""
        away = (self.xs - x) ** 2 + (self.ys - y) ** 2
        close = np.nonzero(away <= reach * reach)[0]
        if not len(close):
            return None
        marks = [(float(away[place]), self.mark(int(place))) for place in close]
        return min(marks, key=lambda one: (round(one[0]), not any(spot in spots for spot in one[1].spots)))[1]

    def lane_at(self, x: float, y: float, reach: float) -> Lane | None:
        """The curve that passes closest to a point, within reach."""
        bundle, plane = self.bundle, self.plane
        first, last = plane.frame(x - reach), plane.frame(x + reach)
        near = np.nonzero((bundle.pieces[:, 3, 0] >= first) & (bundle.pieces[:, 0, 0] <= last))[0]
        of = np.unique(bundle.piece_of[near])
        lines = points([bundle.pieces[near[bundle.piece_of[near] == one]] for one in of], plane)
        return line_at(((bundle.lanes[one], line) for one, line in zip(of, lines, strict=True)), x, y, reach)


class Bundles:
    """Makes bundles; what belongs to a channel is made once for its keys."""

    def __init__(self) -> None:
        self._known: dict[Lane, Shape] = {}
        self._made: dict[Port, tuple[Keys, list[Pieces]]] = {}

    def make(self, rows: Iterable[CurveRow], hidden: Collection[Lane]) -> Bundle:
        """All channels of rows with keys but hidden ones."""
        lanes: list[Lane] = []
        shapes: list[Shape] = []
        for row in rows:
            for channel in range(len(row.channels) or 1) if row.port and row.keys else ():
                assert row.port and row.keys
                lane = row.port, channel
                if lane not in hidden:
                    lanes.append(lane)
                    shapes.append(self._shape(lane, row.keys))
        if not lanes:
            return Bundle()
        whole = np.concatenate([one.pieces for one in shapes])
        order = np.arange(len(lanes))
        piece_of = np.repeat(order, [len(one.pieces) for one in shapes])
        return Bundle(
            tuple(lanes),
            tuple(shapes),
            whole,
            is_straight(whole),
            piece_of,
            np.concatenate([one.frames for one in shapes]),
            np.concatenate([one.values for one in shapes]),
            np.repeat(order, [len(one.frames) for one in shapes]),
            tuple(spot for one in shapes for spot in one.spots),
            tuple(look for one in shapes for look in one.looks),
            np.array([_edges(one) for one in shapes]),
        )

    def _shape(self, lane: Lane, keys: Keys) -> Shape:
        known = self._known.get(lane)
        if known is None or known.keys is not keys:
            before = self._made.get(lane[0])
            if before is None or before[0] is not keys:
                before = self._made[lane[0]] = keys, all_pieces(keys)
            known = self._known[lane] = shape(lane, keys, before[1][lane[1]])
        return known


def _edges(one: Shape) -> tuple[float, ...]:
    holds = one.keys.outside == "hold" or len(one.frames) == 1
    return one.frames[0], one.values[0], one.frames[-1], one.values[-1], float(holds)
