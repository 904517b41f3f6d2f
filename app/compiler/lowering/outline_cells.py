"""Segments sorted into the cells of a picture: what the exact area of an outline in a pixel is summed from.

Coverage is the area right of each segment, with its sign, summed over the segments of a row: exact for polygons, as in
Levien's font-rs. A cell holds the parts of segments within it; for what lies left of it, it has a number for each row.
"""

from typing import NamedTuple

import numpy as np

from .outline_curves import Array, spread_counts

TILE, STRIP = 16, 4
"""Pixels of a side of a tile, and of the height of a cell, of which a tile has four. Chosen by judgement: halves of
both need more numbers than they save."""


_ROUNDING = 1e-6
"""Of sums of heights in 64 bits, and of fewer than a million numbers."""


class TileGrid(NamedTuple):
    """The tiles of a picture with those beyond its frame."""

    across: int
    down: int
    beyond: int
    """How many tiles there are on each side of the frame."""

    @property
    def corner(self) -> float:
        """How far left and above the frame the tiles begin."""
        return float(self.beyond * TILE)


class SegmentCells(NamedTuple):
    """The parts of segments in cells, sorted by cell, where the left top corner of each is 0."""

    parts: Array
    """A row for each part: x and y of its ends."""
    starts: Array
    """The number of the first part of each cell, by strip and column; then how many there are."""
    counts: Array
    backdrops: Array
    """By strip, column and row of the cell: how far down segments left of the cell go in that row."""

    @property
    def are_crossed(self) -> Array:
        """By row and column: whether an edge is in a tile. Of a level one only the rows tell."""
        strips, across = self.counts.shape
        rows = self.backdrops.reshape(strips * STRIP // TILE, TILE // STRIP, across, STRIP)
        first = rows[:, 0, :, 0]
        highest, lowest = rows.max(axis=(1, 3)), rows.min(axis=(1, 3))  # no number for each row of a large picture
        is_stepped = (highest - first > _ROUNDING) | (first - lowest > _ROUNDING)
        return np.logical_or(is_stepped, self.counts.reshape(rows.shape[:3]).any(axis=1))


def sort_into_cells(ends: Array, grid: TileGrid) -> SegmentCells:
    """The parts of segments in the cells of a grid. What lies left of it counts as if it ran down its left edge."""
    across, strips = grid.across, grid.down * TILE // STRIP
    ends = _keep_rows(ends + grid.corner, float(strips * STRIP))
    parts, strip, _ = split(ends, 1, float(STRIP), strips)
    parts, column, index = split(parts, 0, float(TILE), across)
    strip = strip[index]
    is_left = column < 0
    parts[is_left, 0] = parts[is_left, 2] = 0.0
    column[is_left] = 0
    is_inside = (column < across) & (parts[:, 1] != parts[:, 3])
    parts, strip, column = parts[is_inside], strip[is_inside], column[is_inside]
    cell = strip * across + column
    order = np.argsort(cell, kind="stable")
    parts, cell = parts[order], cell[order]
    parts = parts - np.stack([cell % across * TILE, cell // across * STRIP] * 2, axis=1)
    counts = np.bincount(cell, minlength=strips * across)
    shape = strips, across
    return SegmentCells(
        parts, (np.cumsum(counts) - counts).reshape(shape), counts.reshape(shape), _sum_backdrops(parts, cell, shape)
    )


def _keep_rows(ends: Array, height: float) -> Array:
    """The segments between the top and the bottom of a grid. What is level has no area beside it."""
    low, high = np.minimum(ends[:, 1], ends[:, 3]), np.maximum(ends[:, 1], ends[:, 3])
    ends = ends[(high > 0.0) & (low < height) & (low != high)]
    ax, ay, bx, by = (ends[:, number] for number in range(4))
    slope = (bx - ax) / (by - ay)
    top, bottom = np.clip(ay, 0.0, height), np.clip(by, 0.0, height)
    start = np.where(top == ay, ax, ax + (top - ay) * slope)
    return np.stack([start, top, np.where(bottom == by, bx, ax + (bottom - ay) * slope), bottom], axis=1)


def split(ends: Array, axis: int, step: float, count: int) -> tuple[Array, Array, Array]:
    """Segments cut where they cross lines of an axis, `step` apart from 0 on.

    Returns the parts, the gap between lines that each is in, and the number of its segment. Gap -1 is all that lies
    before the first line, and gap `count` all that lies behind as many gaps.
    """
    a, b = ends[:, axis], ends[:, axis + 2]
    first = np.clip(np.floor(np.minimum(a, b) / step), -1, count).astype(np.intp)
    last = np.clip(np.ceil(np.maximum(a, b) / step) - 1, first, count).astype(np.intp)
    index, number = spread_counts(last - first + 1)
    gap = first[index] + number
    whole, parts = ends[index], ends[index]
    low = np.where(gap < 0, -np.inf, gap * step)
    high = np.where(gap == count, np.inf, (gap + 1) * step)
    for end in (0, 2):
        places = np.clip(whole[:, axis + end], low, high)
        moved = np.nonzero(places != whole[:, axis + end])[0]
        cut = whole[moved]
        slope = (cut[:, 3 - axis] - cut[:, 1 - axis]) / (cut[:, axis + 2] - cut[:, axis])
        parts[:, axis + end] = places
        parts[moved, 1 - axis + end] = cut[:, 1 - axis] + (places[moved] - cut[:, axis]) * slope
    return parts, gap, index


def _sum_backdrops(parts: Array, cell: Array, shape: tuple[int, int]) -> Array:
    """For each row of each cell how far down the parts in cells left of it go."""
    sums = np.zeros((*shape, STRIP))
    for row in range(STRIP):
        rises = np.clip(parts[:, 3], row, row + 1) - np.clip(parts[:, 1], row, row + 1)
        steps = np.bincount(cell, rises, shape[0] * shape[1]).reshape(shape)
        sums[:, 1:, row] = np.cumsum(steps, axis=1)[:, :-1]
    return sums
