"""The chords that can be nearest to a pixel of a tile: what the distance to an outline is found from.

Where the feather differs from point to point, near is what is near for its feather.
"""

from typing import NamedTuple

import numpy as np

from .outline_cells import TILE, TileGrid
from .outline_curves import Array

_ROUNDING = 0.01
"""Pixels: places in 32 bits are exact to this up to 131,072 pixels."""

_NEAR = 8192.0
"""Pixels up to which distances in 32 bits are exact to a third of `_ROUNDING`: those take half the time of 64 bits."""


class NearChords(NamedTuple):
    """Numbers of chords by tile, those of a tile after each other."""

    chords: Array
    starts: Array
    """The place of the first one of each tile, by row and column; then how many there are."""
    counts: Array


def find_candidates(ends: Array, reach: float, grid: TileGrid, widths: Array | None = None) -> NearChords:
    """The chords that can be nearest to a pixel of a tile, within reach; relative to `widths` at both ends, if any.

    Squares are cut into four again and again. The chords of a square are those that are no farther from its middle than
    the nearest one and twice the way to its corners.
    """
    side = TILE
    while side < TILE * max(grid.across, grid.down):
        side *= 2
    squares, chord, sizes = np.zeros((1, 2), np.intp), np.arange(len(ends)), np.array([len(ends)])
    ends = ends + grid.corner
    is_near = side <= _NEAR and np.abs(ends).max(initial=0.0) <= _NEAR
    ends = np.ascontiguousarray(ends.T, np.float32 if is_near else np.float64)
    spans = None if widths is None else np.stack([widths.min(axis=1), widths.max(axis=1)]).astype(ends.dtype)
    while True:
        squares, chord, sizes = _keep_near(ends, spans, squares, chord, sizes, side, reach)
        if side == TILE or not len(chord):
            break
        side //= 2
        squares, chord, sizes = _cut_squares(squares, chord, sizes, (grid.across * TILE, grid.down * TILE), side)
    starts, counts = np.zeros((grid.down, grid.across), np.intp), np.zeros((grid.down, grid.across), np.intp)
    if len(chord):
        starts[squares[:, 1], squares[:, 0]] = np.cumsum(sizes) - sizes
        counts[squares[:, 1], squares[:, 0]] = sizes
    return NearChords(chord, starts, counts)


def _cut_squares(
    squares: Array, chord: Array, sizes: Array, extent: tuple[int, int], side: int
) -> tuple[Array, Array, Array]:
    """Squares of half the side, each with the chords of the whole one, as far as they lie in the grid."""
    chords, quarters, counts = list[Array](), list[Array](), list[Array]()
    for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
        quarter = 2 * squares + corner
        is_inside = (quarter * side < extent).all(axis=1)
        quarters.append(quarter[is_inside])
        counts.append(sizes[is_inside])
        chords.append(chord[np.repeat(is_inside, sizes)])
    return np.concatenate(quarters), np.concatenate(chords), np.concatenate(counts)


def _keep_near(
    ends: Array, spans: Array | None, squares: Array, chord: Array, sizes: Array, side: int, reach: float
) -> tuple[Array, Array, Array]:
    """The chords that can be nearest within each square; squares that no chord reaches are left out.

    `spans` are the least and the largest width of each chord, if distances are relative to them.
    """
    if not len(chord):
        return squares[:0], chord, sizes[:0]
    starts = np.cumsum(sizes) - sizes
    middle_x, middle_y = (np.repeat(((squares[:, axis] + 0.5) * side).astype(ends.dtype), sizes) for axis in (0, 1))
    away = _measure_distance(ends[:, chord], middle_x, middle_y)
    radius = side * 0.5**0.5 + _ROUNDING
    if spans is None:
        limit = np.minimum(np.minimum.reduceat(away, starts) + 2.0 * radius, reach + radius)
        is_near = away <= np.repeat(limit, sizes)
    else:
        narrow, wide = spans[:, chord]
        limit = np.minimum.reduceat((away + radius) / narrow, starts)
        is_near = (away - radius <= np.repeat(limit, sizes) * wide) & (away <= reach + radius)
    sizes = np.add.reduceat(is_near, starts, dtype=np.intp)
    return squares[sizes > 0], chord[is_near], sizes[sizes > 0]


def _measure_distance(ends: Array, x: Array, y: Array) -> Array:
    """The distance of each place to its chord, of ends as [4, chords]: numpy is slow on rows of few numbers."""
    start_x, start_y, end_x, end_y = ends
    edge_x, edge_y, to_x, to_y = end_x - start_x, end_y - start_y, x - start_x, y - start_y
    length = np.maximum(edge_x * edge_x + edge_y * edge_y, 1e-12)
    t = np.clip((to_x * edge_x + to_y * edge_y) / length, 0.0, 1.0)
    away_x, away_y = to_x - t * edge_x, to_y - t * edge_y
    return np.sqrt(away_x * away_x + away_y * away_y)
