"""All visible curves in a few arrays, so that one numpy call projects all of them. Nothing here draws."""

from __future__ import annotations

from collections.abc import Collection, Iterable

import numpy as np
from msgspec import Struct, field
from numpy.typing import NDArray

from ...graph import Interpolation, Keys, Port
from ..toolkit.plane import Plane
from .hits import KEYS_BEYOND, Mark, find_line
from .rows import CurveRow, Lane, Spot
from .shapes import (
    Pieces,
    flatten_curves,
    is_straight,
    make_all_pieces,
    make_outside_pieces,
    project_pieces,
    read_key_channel,
)

Floats = NDArray[np.float64]


class CurveShape(Struct, frozen=True):
    """A channel of keys: its pieces, and the frames, values, names and shapes of its keys."""

    keys: Keys
    pieces: Pieces
    frames: Floats
    values: Floats
    spots: tuple[frozenset[Spot], ...]
    looks: tuple[Interpolation, ...]


def make_shape(lane: Lane, keys: Keys, inner: Pieces) -> CurveShape:
    """The shape of a channel, from its pieces."""
    port, channel = lane
    return CurveShape(
        keys,
        inner,
        np.array(keys.frames),
        np.array([read_key_channel(key, channel) for key in keys.keys]),
        tuple(frozenset(((port, frame, channel),)) for frame in keys.frames),
        tuple(key.interpolation for key in keys.keys),
    )


class Bundle(Struct, frozen=True):
    """Channels one after the other; `piece_of` and `key_of` say which one a piece and a key belong to."""

    lanes: tuple[Lane, ...] = ()
    shapes: tuple[CurveShape, ...] = ()
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

    def project(self, plane: Plane) -> VisibleCurves:
        """The visible pieces and keys, in pixels."""
        view = plane.view
        inside = (self.pieces[:, 3, 0] >= view.first) & (self.pieces[:, 0, 0] <= view.last)
        screen, bent = project_pieces(self.pieces[inside], plane, self.straight[inside])
        cuts = np.searchsorted(self.piece_of[inside], np.arange(len(self.lanes) + 1))
        room = KEYS_BEYOND / plane.across
        visible_keys = np.nonzero((self.frames >= view.first - room) & (self.frames <= view.last + room))[0]
        xs = plane.rect[0] + (self.frames[visible_keys] - view.first) * plane.across
        ys = plane.rect[3] - (self.values[visible_keys] - view.low) * plane.up
        return VisibleCurves(self, plane, screen, bent, cuts.tolist(), visible_keys, xs, ys)

    def project_outside(self, plane: Plane) -> tuple[list[int], Pieces, NDArray[np.bool_], list[int]]:
        """The curves before the first and after the last keys, in pixels: channels, pieces, which are bent, ends."""
        view = plane.view
        first, low, last, high, holds = self.edges.T
        before = np.nonzero((holds > 0.0) & (first > view.first))[0]
        after = np.nonzero((holds > 0.0) & (last < view.last))[0]
        level_pieces = np.empty((len(before) + len(after), 4, 2))
        level_pieces[:, :2, 0] = np.concatenate([np.full(len(before), view.first), last[after]])[:, None]
        level_pieces[:, 2:, 0] = np.concatenate([first[before], np.full(len(after), view.last)])[:, None]
        level_pieces[..., 1] = np.concatenate([low[before], high[after]])[:, None]
        lane_indices: list[int] = [*before.tolist(), *after.tolist()]
        outside_pieces: list[Pieces] = [level_pieces[place : place + 1] for place in range(len(level_pieces))]
        for place in np.nonzero(holds == 0.0)[0].tolist():
            shape = self.shapes[place]
            both = make_outside_pieces(shape.keys, self.lanes[place][1], shape.pieces, view.first, view.last)
            outside = [pieces for pieces in both if len(pieces)]
            outside_pieces += outside
            lane_indices += [place] * len(outside)
        screen, bent = project_pieces(np.concatenate([np.empty((0, 4, 2)), *outside_pieces]), plane)
        return lane_indices, screen, bent, np.cumsum([0, *map(len, outside_pieces)]).tolist()


class VisibleCurves(Struct, frozen=True):
    """The pieces on the screen, `cuts` where those of every channel begin, and the keys: which, and where."""

    bundle: Bundle
    plane: Plane
    screen: Pieces
    bent: NDArray[np.bool_]
    cuts: list[int]
    key_indices: NDArray[np.int64]
    xs: Floats
    ys: Floats

    def make_mark(self, place: int) -> Mark:
        """The mark of a visible key."""
        key, bundle = int(self.key_indices[place]), self.bundle
        channel = bundle.lanes[bundle.key_of[key]][1]
        return Mark(float(self.xs[place]), float(self.ys[place]), bundle.spots[key], bundle.looks[key], channel)

    def list_marks(self) -> list[Mark]:
        """The marks of all visible keys."""
        return [self.make_mark(place) for place in range(len(self.key_indices))]

    def find_mark(self, x: float, y: float, reach: float, spots: Collection[Spot]) -> Mark | None:
        """The key that is closest to a point and within reach; where several lie at one place, a selected one."""
        away = (self.xs - x) ** 2 + (self.ys - y) ** 2
        close = np.nonzero(away <= reach * reach)[0]
        if not len(close):
            return None
        marks = [(float(away[place]), self.make_mark(int(place))) for place in close]
        return min(
            marks, key=lambda candidate: (round(candidate[0]), not any(spot in spots for spot in candidate[1].spots))
        )[1]

    def find_lane(self, x: float, y: float, reach: float) -> Lane | None:
        """The curve that passes closest to a point, within reach."""
        bundle, plane = self.bundle, self.plane
        first, last = plane.frame(x - reach), plane.frame(x + reach)
        near_pieces = np.nonzero((bundle.pieces[:, 3, 0] >= first) & (bundle.pieces[:, 0, 0] <= last))[0]
        lane_indices = np.unique(bundle.piece_of[near_pieces])
        lines = flatten_curves(
            [bundle.pieces[near_pieces[bundle.piece_of[near_pieces] == index]] for index in lane_indices], plane
        )
        return find_line(
            ((bundle.lanes[index], line) for index, line in zip(lane_indices, lines, strict=True)), x, y, reach
        )


class BundleBuilder:
    """Builds bundles. The shape of a channel is cached until its keys change."""

    def __init__(self) -> None:
        self._shapes: dict[Lane, CurveShape] = {}
        self._pieces: dict[Port, tuple[Keys, list[Pieces]]] = {}

    def make(self, rows: Iterable[CurveRow], hidden: Collection[Lane]) -> Bundle:
        """All channels of rows with keys, without the hidden ones.

        The curves are joined into single arrays, so that numpy projects and hits all of them at once: a loop over
        curves would be too slow for graphs with thousands.
        """
        lanes: list[Lane] = []
        shapes: list[CurveShape] = []
        for row in rows:
            for channel in range(len(row.channels) or 1) if row.port and row.keys else ():
                assert row.port and row.keys
                lane = row.port, channel
                if lane not in hidden:
                    lanes.append(lane)
                    shapes.append(self._find_shape(lane, row.keys))
        if not lanes:
            return Bundle()
        whole = np.concatenate([shape.pieces for shape in shapes])
        order = np.arange(len(lanes))
        piece_of = np.repeat(order, [len(shape.pieces) for shape in shapes])
        return Bundle(
            tuple(lanes),
            tuple(shapes),
            whole,
            is_straight(whole),
            piece_of,
            np.concatenate([shape.frames for shape in shapes]),
            np.concatenate([shape.values for shape in shapes]),
            np.repeat(order, [len(shape.frames) for shape in shapes]),
            tuple(spot for shape in shapes for spot in shape.spots),
            tuple(look for shape in shapes for look in shape.looks),
            np.array([_find_edges(shape) for shape in shapes]),
        )

    def _find_shape(self, lane: Lane, keys: Keys) -> CurveShape:
        shape = self._shapes.get(lane)
        if shape is None or shape.keys is not keys:
            channel_pieces = self._pieces.get(lane[0])
            if channel_pieces is None or channel_pieces[0] is not keys:
                channel_pieces = self._pieces[lane[0]] = keys, make_all_pieces(keys)
            shape = self._shapes[lane] = make_shape(lane, keys, channel_pieces[1][lane[1]])
        return shape


def _find_edges(shape: CurveShape) -> tuple[float, ...]:
    holds = shape.keys.outside == "hold" or len(shape.frames) == 1
    return shape.frames[0], shape.values[0], shape.frames[-1], shape.values[-1], float(holds)
