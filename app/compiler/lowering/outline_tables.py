"""The tables that `lib/paths.glsl` reads: what each tile of a picture needs of outlines.

A tile is a texel of `tiles`: the number of its first entry and how many it has, one for each outline that matters
there, then what the mask below is multiplied by and what is added, if it has none. An entry has ten texels: the number
of its outline, the first texel of the chords near the tile and how many there are, how narrow its edge is where it has
to be looked at in parts of a pixel; the tile; then for each of four
strips of four rows the first segment and how many, and what lies left of the strip in each row.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from halation.nodes import OutlineFill
from msgspec.structs import replace

from ...errors import DeviceError
from .outline_cells import STRIP, TILE, SegmentCells, TileGrid, sort_into_cells
from .outline_chords import NearChords, find_candidates
from .outline_curves import Array, PlacedCurves, StraightSegments, flatten, list_chords
from .outline_evenness import find_uneven
from .outline_union import keep_edges

ENTRY = 10
"""Texels of an entry: two, and two for each of four strips."""

_MODES = "union", "subtract", "intersect", "max", "min", "difference", "plus"
"""In the order of the numbers that `path_combine` knows them by."""
_LINEAR = _MODES[:3]
_KEEPING = "intersect", "min"
_STRIPS = TILE // STRIP

MOST_TILES = 1 << 23
"""Of all outlines together: each takes some 250 bytes while tables are made, so 2 GiB. 1,000 outlines have so many in a
picture of 1920x1080, 250 in one of 3840x2160."""


class _SortedOutline(NamedTuple):
    """An outline in tables: its cells, the chords near it, and by tile whether a pixel has to look at them."""

    fill: OutlineFill
    cells: SegmentCells
    chords: Array
    """Two rows for each: both ends, then the feathers there and nothing."""
    near: NearChords
    uneven: Array
    """By tile: 0, or the least width of its edge where the distance does not change evenly there."""
    matters: Array
    level: Array
    """By tile: its coverage where it does not matter."""


def build_tables(fills: Sequence[OutlineFill], size: tuple[int, int], beyond: int) -> Mapping[str, Array]:
    """The tables of outlines by their names, as rows of four numbers in 32 bits.

    Raises DeviceError for so many outlines in so large a picture that memory could not hold them.
    """
    fills = [_share_feather(fill) for fill in fills]
    across, down = (-(-side // TILE) + 2 * beyond for side in size)
    if across * down * len(fills) > MOST_TILES:
        outlines = "an outline" if len(fills) == 1 else f"{len(fills)} outlines"
        raise DeviceError(
            f"{outlines} in {size[0]}x{size[1]} pixels would take too much memory; "
            "render smaller with --scale or --size"
        )
    grid = TileGrid(across, down, beyond)
    prepared = [_prepare(fill, grid) for fill in fills]
    scale, offset, is_listed = _combine_levels(prepared, grid)
    tiles = np.zeros((down, across, 4))
    tiles[..., 2], tiles[..., 3] = scale, offset
    entries = _list_entries(prepared, is_listed, tiles)
    shapes = [_describe_shape(item) for item in prepared]
    tables = {
        "shapes": np.array(shapes),
        "tiles": tiles,
        "entries": entries,
        "segments": np.concatenate([np.zeros((0, 4)), *(item.cells.parts for item in prepared)]),
        "chords": np.concatenate([np.zeros((0, 4)), *(item.chords for item in prepared)]),
        "nearest": _pack_candidates(prepared),
    }
    return {name: np.ascontiguousarray(table, np.float32).reshape(-1, 4) for name, table in tables.items()}


def _share_feather(fill: OutlineFill) -> OutlineFill:
    """The same outline; a feather that all points have is that of the outline."""
    if len(set(fill.feathers)) != 1:
        return fill
    return replace(fill, feather=fill.feather + fill.feathers[0], feathers=())


def _describe_shape(item: _SortedOutline) -> tuple[float, ...]:
    """Two texels: the mode, the opacity, whether it is inverted, the feather; then the growth, whether points have more
    feather, and 1 or -1 for the side of chords that is inside.
    """
    fill, ends = item.fill, item.chords[::2]
    mode = _MODES.index(fill.mode)
    turn = 1.0 if (ends[:, 0] * ends[:, 3] - ends[:, 2] * ends[:, 1]).sum() >= 0.0 else -1.0
    return mode, fill.opacity, fill.invert, fill.feather, fill.growth, any(fill.feathers), turn, 0.0


def _prepare(fill: OutlineFill, grid: TileGrid) -> _SortedOutline:
    curves = PlacedCurves.of(fill)
    feather, narrowest = (
        fill.feather + curves.feathers.max(initial=0.0),
        fill.feather + curves.feathers.min(initial=0.0),
    )
    is_hard = feather <= 0.0 and fill.growth <= 0.0
    chords = StraightSegments.none() if is_hard else keep_edges(list_chords(curves, fill.feather))
    # Of edges that are all wider than a pixel, coverage only says which side is inside.
    is_soft = fill.growth <= 0.0 and narrowest >= 1.0
    cells = sort_into_cells(chords.ends if is_soft else keep_edges(flatten(curves)).ends, grid)
    level = np.minimum(np.abs(cells.backdrops[::_STRIPS, :, 0]), 1.0)
    if is_hard:
        is_crossed = cells.are_crossed
        nothing = np.zeros(is_crossed.shape, np.intp)
        near = NearChords(np.zeros(0, np.intp), nothing, nothing)
        return _SortedOutline(fill, cells, np.zeros((0, 4)), near, np.zeros(nothing.shape), is_crossed, level)
    widths = np.maximum(fill.feather + chords.feathers, 1.0) if curves.feathers.any() else None
    near = find_candidates(chords.ends, 0.5 * feather + fill.growth + 1.0, grid, widths)
    pairs = np.stack([chords.ends, np.pad(chords.feathers, ((0, 0), (0, 2)))], axis=1).reshape(-1, 4)
    return _SortedOutline(fill, cells, pairs, near, find_uneven(chords, near, fill.feather), near.counts > 0, level)


def _combine_levels(prepared: Sequence[_SortedOutline], grid: TileGrid) -> tuple[Array, Array, list[Array]]:
    """What the outlines make of a mask in tiles where none matters, and the tiles in which each has an entry.

    In a tile that one matters in, all that change the mask have one; so have those that do more than scale and add.
    """
    ends = np.zeros((2, grid.down, grid.across))  # what becomes of a mask of 0 and of 1
    ends[1] = 1.0
    is_mixed = np.zeros((grid.down, grid.across), bool)
    for item in prepared:
        ends = _combine(ends, item.level, item.fill)
        is_mixed |= item.matters | ~_is_linear(item.level, item.fill)
    is_listed = [
        is_mixed & (item.matters | ~_is_idle(1.0 - item.level if item.fill.invert else item.level, item.fill))
        for item in prepared
    ]
    return ends[1] - ends[0], ends[0], is_listed


def _combine(below: Array, cover: Array, fill: OutlineFill) -> Array:
    """A mask with one more outline, as `path_combine` has it."""
    cover = 1.0 - cover if fill.invert else cover
    amount, remaining = cover * fill.opacity, 1.0 - fill.opacity * (1.0 - cover)
    match fill.mode:
        case "union":
            return below + amount * (1.0 - below)
        case "subtract":
            return below * (1.0 - amount)
        case "intersect":
            return below * remaining
        case "max":
            return np.maximum(below, amount)
        case "min":
            return np.minimum(below, remaining)
        case "difference":
            return np.abs(below - amount)
        case "plus":
            return np.minimum(below + amount, 1.0)


def _is_linear(cover: Array, fill: OutlineFill) -> Array:
    """True where a mask of 0..1 becomes itself times a number, plus another one."""
    if fill.mode in _LINEAR or fill.opacity == 0.0:
        return np.ones(cover.shape, bool)
    return (fill.opacity == 1.0) & ((cover == 0.0) | (cover == 1.0))


def _is_idle(cover: Array, fill: OutlineFill) -> Array:
    """True where an outline leaves all masks of 0..1 as they are."""
    return cover == (1.0 if fill.mode in _KEEPING else 0.0)


def _list_entries(prepared: Sequence[_SortedOutline], is_listed: Sequence[Array], tiles: Array) -> Array:
    """The entries of all tiles; `tiles` gets the first one of each tile, and how many there are."""
    counts = sum((listed.astype(np.intp) for listed in is_listed), np.zeros(tiles.shape[:2], np.intp))
    first = np.cumsum(counts).reshape(counts.shape) - counts
    tiles[..., 0], tiles[..., 1] = first, counts
    entries, place = np.zeros((int(counts.sum()), ENTRY, 4)), np.zeros_like(counts)
    segment = texel = 0
    for number, (item, listed) in enumerate(zip(prepared, is_listed, strict=True)):
        row, column = np.nonzero(listed)
        lengths = -(-item.near.counts // 4)
        texels = texel + np.cumsum(lengths).reshape(lengths.shape) - lengths
        at = first[row, column] + place[row, column]
        entries[at, 0, 0] = number
        entries[at, 0, 1], entries[at, 0, 2] = texels[row, column], lengths[row, column]
        entries[at, 0, 3] = item.uneven[row, column]
        entries[at, 1, 0], entries[at, 1, 1] = column, row
        for strip in range(_STRIPS):
            cell = _STRIPS * row + strip, column
            entries[at, 2 + 2 * strip, 0] = segment + item.cells.starts[cell]
            entries[at, 2 + 2 * strip, 1] = item.cells.counts[cell]
            entries[at, 3 + 2 * strip] = item.cells.backdrops[cell]
        place[row, column] += 1
        segment, texel = segment + len(item.cells.parts), texel + int(lengths.sum())
    return entries


def _pack_candidates(prepared: Sequence[_SortedOutline]) -> Array:
    """The numbers of chords near each tile of each outline, four to a texel; the last one is repeated."""
    packed, first = [np.zeros((0, 4))], 0
    for item in prepared:
        counts = item.near.counts.reshape(-1)
        starts = item.near.starts.reshape(-1)
        lengths = -(-counts // 4)
        tile = np.repeat(np.arange(len(counts)), lengths)
        number = np.arange(len(tile)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
        places = np.minimum(4 * number[:, None] + np.arange(4), counts[tile][:, None] - 1)
        packed.append(first + item.near.chords[starts[tile][:, None] + places] if len(tile) else np.zeros((0, 4)))
        first += len(item.chords) // 2
    return np.concatenate(packed)
