"""Outlines that cross themselves or each other: their edge without what lies inside, by the nonzero winding rule.

Segments are cut where they meet. A run of them from one such place to the next has the same winding numbers on its
sides all along; it is part of the edge if one of the two is 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .outline_cells import split
from .outline_curves import Array, StraightSegments, spread_counts

_NEAR = 1e-9
"""Parts of a segment: what is nearer to its end is its end. Floats of 64 bits hold a thousandth of this."""

_CELL, _MOST_CELLS = 2.0, 4096
"""Pixels of a side of the cells in which neighbors are looked for, and the most of them side by side. Chosen by
judgement: they change how long it takes alone."""

_MOST_PAIRS = 2**22
"""Runs times segments that are compared at once: 32 MiB for each of a few arrays."""


class _Runs(NamedTuple):
    """Segments cut where they meet, and the number of the run that each is in."""

    segments: StraightSegments
    runs: Array


def keep_edges(segments: StraightSegments) -> StraightSegments:
    """The segments between inside and outside, with the inside on the same side of all; all, if none cross."""
    first, second = _find_neighbors(segments.ends)
    first, second, t, u = _find_crossings(segments.ends, first, second)
    if not len(first):
        return segments
    pieces = _cut(segments, np.concatenate([first, second]), np.concatenate([t, u]))
    is_edge, is_turned = _judge(segments.ends, pieces)
    ends, feathers = pieces.segments
    turned = is_turned[pieces.runs]
    ends = np.where(turned[:, None], ends[:, [2, 3, 0, 1]], ends)
    feathers = np.where(turned[:, None], feathers[:, ::-1], feathers)
    on_edge = is_edge[pieces.runs]
    return StraightSegments(ends[on_edge], feathers[on_edge])


def _find_neighbors(ends: Array) -> tuple[Array, Array]:
    """Pairs of segments that have parts in the same cell and do not follow each other."""
    corner = np.minimum(ends[:, :2].min(axis=0), ends[:, 2:].min(axis=0))
    moved = ends - np.tile(corner, 2)
    side = max(_CELL, moved.max() / _MOST_CELLS)
    count = int(moved.max() / side) + 1
    parts, row, index = split(moved, 1, side, count)
    _, column, inner = split(parts, 0, side, count)
    cell, index = row[inner] * (count + 1) + column, index[inner]
    order = np.argsort(cell, kind="stable")
    cell, index = cell[order], index[order]
    behind = np.searchsorted(cell, cell, side="right") - np.arange(len(cell)) - 1
    first, number = spread_counts(behind)
    a, b = index[first], index[first + number + 1]
    a, b = np.minimum(a, b), np.maximum(a, b)
    low, high = np.minimum(ends[:, :2], ends[:, 2:]), np.maximum(ends[:, :2], ends[:, 2:])
    for axis in (0, 1):
        touches = (low[a, axis] <= high[b, axis]) & (low[b, axis] <= high[a, axis]) & (a != b)
        a, b = a[touches], b[touches]
    follows = (ends[a, 2:] == ends[b, :2]).all(axis=1) | (ends[b, 2:] == ends[a, :2]).all(axis=1)
    keys = np.unique(a[~follows] * len(ends) + b[~follows])
    return keys // len(ends), keys % len(ends)


def _find_crossings(ends: Array, first: Array, second: Array) -> tuple[Array, Array, Array, Array]:
    """The pairs that meet, and where along both: parallel ones never do."""
    start, other = ends[first, :2], ends[second, :2]
    along, across = ends[first, 2:] - start, ends[second, 2:] - other
    to, area = other - start, _cross(along, across)
    with np.errstate(divide="ignore", invalid="ignore"):
        t, u = _cross(to, across) / area, _cross(to, along) / area
        meets = (t >= -_NEAR) & (t <= 1.0 + _NEAR) & (u >= -_NEAR) & (u <= 1.0 + _NEAR)
    return first[meets], second[meets], t[meets], u[meets]


def _cross(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _cut(segments: StraightSegments, index: Array, place: Array) -> _Runs:
    """Segments cut at places along them. A run ends at each such place, and where an outline does."""
    ends, feathers = segments
    place = np.where(place < _NEAR, 0.0, np.where(place > 1.0 - _NEAR, 1.0, place))
    number = np.arange(len(ends))
    is_cut = np.concatenate([np.zeros(len(ends), bool), np.ones(len(place), bool)])
    index, place = np.concatenate([number, index]), np.concatenate([np.zeros(len(ends)), place])
    order = np.lexsort((place, index))
    index, place, is_cut = index[order], place[order], is_cut[order]
    until = np.where(np.append(index[1:] == index[:-1], False), np.append(place[1:], 1.0), 1.0)
    follows = np.append(False, (ends[1:, :2] == ends[:-1, 2:]).all(axis=1))
    begins = is_cut | ((place == 0.0) & ~follows[index] & ~is_cut)
    runs = np.cumsum(begins)
    has_length = until > place
    index, place, until, runs = index[has_length], place[has_length, None], until[has_length, None], runs[has_length]
    start, along = ends[index, :2], ends[index, 2:] - ends[index, :2]
    widths = feathers[index, :1] + (feathers[index, 1:] - feathers[index, :1]) * np.hstack([place, until])
    cut = np.hstack([np.where(place == 0.0, start, start + place * along), start + until * along])
    return _Runs(StraightSegments(cut, widths), np.unique(runs, return_inverse=True)[1])


def _judge(ends: Array, pieces: _Runs) -> tuple[Array, Array]:
    """For each run whether it is an edge, and whether it has to be turned for the inside to be right of what runs down.

    The longest piece of a run is crossed by a level ray, or by an upright one if that is less slanted.
    """
    cut, runs = pieces.segments.ends, pieces.runs
    longest = np.lexsort((np.abs(cut[:, 2:] - cut[:, :2]).max(axis=1), runs))
    longest = longest[np.append(np.diff(runs[longest]) > 0, True)]
    piece = cut[longest]
    is_level = np.abs(piece[:, 2] - piece[:, 0]) > np.abs(piece[:, 3] - piece[:, 1])
    before, own = np.zeros(len(piece)), np.zeros(len(piece))
    for flipped in (False, True):
        axes = [1, 0, 3, 2] if flipped else [0, 1, 2, 3]
        chosen = np.nonzero(is_level == flipped)[0]
        for part in np.array_split(chosen, 1 + len(chosen) * len(ends) // _MOST_PAIRS):
            before[part], own[part] = _count_windings(piece[part][:, axes], ends[:, axes])
    is_edge = (before == 0.0) != (before + own == 0.0)
    inside = (before == 0.0) & is_edge
    return is_edge, (own > 0.0) != (inside ^ is_level)


def _count_windings(piece: Array, ends: Array) -> tuple[Array, Array]:
    """The winding number left of the middle of each piece, and what crossing it adds."""
    x, y = 0.5 * (piece[:, 0] + piece[:, 2])[:, None], 0.5 * (piece[:, 1] + piece[:, 3])[:, None]
    ax, ay, bx, by = (ends[:, number] for number in range(4))
    crossed = (ay <= y) != (by <= y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = ax + (y - ay) * (bx - ax) / (by - ay)
    signs = np.sign(by - ay)
    is_own = crossed & (np.abs(at - x) < 1e-7)
    before = np.where(crossed & ~is_own & (at < x), signs, 0.0).sum(axis=1)
    return before, np.where(is_own, signs, 0.0).sum(axis=1)
