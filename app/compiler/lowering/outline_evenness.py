"""Where the distance to an outline does not change evenly, so that soft edges are looked at in parts of a pixel.

Elsewhere the mean over a pixel is that across an even edge. Steps of the distance's slope come from corners, from sharp
bends, from feathers that grow fast, and from places between two parts of an outline.
"""

from __future__ import annotations

import numpy as np

from .outline_chords import NearChords
from .outline_curves import Array, StraightSegments, measure_slack

_TOLERANCE = 7e-4
"""What coverage may be off by where this is left to the even edge: a third of 2e-3, as chords take two thirds."""

_STEEP = 1.5
"""The largest slope of a soft edge that is 1 wide."""

_NARROW = 1.5
"""Pixels: narrower edges have ends within a pixel, which are not the same across and along a diagonal."""

_WIDE = 32.0
"""Pixels: wider edges are taken as even, which coverage is off by 0.012 at most, on the ridge of the sharpest tips,
and by less than 2e-3 elsewhere. To look at them in parts would double their cost."""

_MOST = 256
"""Tiles of an outline with corners, bends or two parts that are looked at in parts, or a part of all (`_SHARE`) if that
is more: each takes a software rasterizer with two cores 0.2 to 0.9 ms, so all of them about as much as a blur of the
picture with a sigma of 10. An outline with more, such as one of 500 points that each turn sharply, is taken as even:
coverage is off by 0.04 at most, at its tips."""

_SHARE = 1.0 / 32.0
"""The part of a large picture's tiles that take as long as its blur: 256 of those of 1920x1080."""


def find_uneven(chords: StraightSegments, near: NearChords, feather: float) -> Array:
    """By tile: the least width of the edge near it, 1 at least, if the distance may change unevenly; 0 elsewhere.

    Half a step of slope, times the mean distance from the middle of a pixel, is what a mean is off by.
    """
    uneven = np.zeros(near.counts.shape)
    if not len(chords.ends) or feather + chords.feathers.min() >= _WIDE:
        return uneven
    row, column = np.nonzero(near.counts)
    order = np.argsort(near.starts[row, column])
    row, column = row[order], column[order]
    if not len(row):
        return uneven
    starts, widths = near.starts[row, column], feather + chords.feathers
    narrowest = np.minimum.reduceat(widths.min(axis=1)[near.chords], starts)
    is_uneven = np.logical_or.reduceat(_are_uneven(chords, widths)[near.chords], starts)
    way = chords.ends[:, 2:] - chords.ends[:, :2]
    way = (way / np.maximum(np.hypot(*way.T), 1e-12)[:, None])[near.chords]
    sizes = near.counts[row, column]
    spread = np.hypot(*(way - np.repeat(way[starts], sizes, axis=0)).T)
    follows = np.append(True, np.diff(near.chords) == 1)
    follows[starts] = True
    is_parted = ~np.logical_and.reduceat(follows, starts)
    steps = 2.0 * np.maximum.reduceat(spread, starts) * _STEEP / (8.0 * np.maximum(narrowest, 1.0))
    is_uneven |= is_parted & (steps > _TOLERANCE)
    is_uneven &= narrowest < _WIDE
    if np.count_nonzero(is_uneven) <= max(_MOST, _SHARE * uneven.size):
        is_looked_at = is_uneven | (narrowest < _NARROW)
        uneven[row, column] = np.where(is_looked_at, np.maximum(narrowest, 1.0), 0.0)
    return uneven


def _are_uneven(chords: StraightSegments, widths: Array) -> Array:
    """Whether the slope of the distance changes too fast at one end of each chord, or along it.

    Where chords are as flat as a smooth curve makes them, their angle is spread over their length.
    """
    way = chords.ends[:, 2:] - chords.ends[:, :2]
    length = np.maximum(np.hypot(*way.T), 1e-12)
    after = np.roll(np.arange(len(length)), -1)
    turn = np.hypot(*(way[after] / length[after, None] - way / length[:, None]).T)
    both = 0.5 * (length + length[after])
    narrow, wide = np.minimum(widths.min(axis=1), widths[after].min(axis=1)), widths.max(axis=1)
    slope = _STEEP / np.maximum(narrow, 1.0)
    bend = turn / both
    growth = (widths[:, 1] - widths[:, 0]) / length
    is_sharp = (bend * (0.5 * wide + 1.0) > 0.5) | (bend * slope / 12.0 > _TOLERANCE)
    is_corner = (both * turn / 8.0 > 1.5 * measure_slack(narrow)) & (turn * slope / 8.0 > _TOLERANCE)
    is_corner |= 0.5 * np.abs(growth[after] - growth) * slope / 8.0 > _TOLERANCE
    grows_fast = growth * growth * _STEEP / (24.0 * np.maximum(narrow, 1.0) ** 2) > _TOLERANCE
    is_uneven = is_sharp | is_corner | grows_fast
    is_uneven |= (chords.ends[:, 2:] != chords.ends[after, :2]).any(axis=1) & (np.arange(len(after)) < len(after) - 1)
    return is_uneven | np.roll(is_uneven, 1)
