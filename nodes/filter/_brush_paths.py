"""Ways of a brush in pixels, as tables for `filter/paint.glsl`: segments between two discs, and stamps of a smear."""

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from .._declare import STROKE_ROWS, Draw, Drawn, PaintStroke, Pixels, Reach, Row, Size, Vector, simplify_stroke

TILE = 16
BITS = 24
"""Segments to a channel of a texel: as many as a float holds exactly."""

BLOCK = 16
"""Segments, or channels of them, side by side in the tables, so that no table is higher than a texture can be."""

GRID, MARGIN = 64, 16
"""The steps of the patches that are drawn, and how much larger they are, in pixels.

Mesa's rasterizer compiles a program anew where the size of a picture becomes a power of two, which takes a quarter of a
second: no patch has such a size, and all tables have.
"""

FINE = 0.005
"""How far in pixels a point may be from the simplified path, which leaves it out: few of the others then lie in one
pixel."""

STEP = 1.0 / 16.0
"""The distance of the stamps of a smear, as a part of the size of the brush: an eighth of its radius."""

MAX_STAMPS = 4096
"""The most stamps of a smear; those of a longer one are farther apart."""

_FAR = 1e6
"""A place that is exact enough in 32 bits: no picture is so large."""

Box = tuple[float, float, float, float]
Disc = tuple[float, float, float]


class BrushPath(NamedTuple):
    """The path of a brush: its discs as x, y and radius in pixels, and the box around them."""

    discs: tuple[Disc, ...]
    box: Box

    @property
    def segments(self) -> tuple[tuple[Disc, Disc], ...]:
        """Both ends of each part of the path; a single disc is a part from itself to itself."""
        return tuple(pairwise(self.discs if len(self.discs) > 1 else self.discs * 2))

    @property
    def channel_count(self) -> int:
        """The channels of its segments: each path starts with a new one."""
        return -(-max(len(self.discs) - 1, 1) // BITS)


class Patch(NamedTuple):
    """A part of the picture, in pixels: where its left top is, and its size."""

    origin: tuple[int, int]
    size: Size

    def read(self, across: int = 0, down: int = 0) -> Reach:
        """What a function that draws the patch reads of the picture: its own pixel, and some around it."""
        return Reach((1.0, 0.0, float(self.origin[0]), 0.0, 1.0, float(self.origin[1])), (across, down))

    def place(self) -> Reach:
        """What a function that draws the picture reads of the patch."""
        return Reach((1.0, 0.0, -float(self.origin[0]), 0.0, 1.0, -float(self.origin[1])), (0, 0), shows=True)


class PathTables(NamedTuple):
    """The paths of some strokes, and which of their segments matter in which tile of the picture."""

    segments: Drawn
    owners: Drawn
    words: Drawn
    digest: Drawn
    rows: int


def trace_brush(stroke: PaintStroke, size: Size) -> BrushPath:
    """The path of the brush of a stroke whose lengths are in pixels."""
    return _trace(stroke.points, stroke.position, stroke.size, size)


@lru_cache(maxsize=2048)
def _trace(points: Row, position: tuple[float, float], width: float, size: Size) -> BrushPath:
    """While a stroke is drawn, those before it stay: their paths are traced once."""
    discs = tuple(
        (_limit((x + position[0]) * size[0]), _limit((y + position[1]) * size[1]), 0.5 * width * max(pressure, 0.0))
        for x, y, pressure in STROKE_ROWS.split(points)
    )
    thinned = simplify_stroke(discs, (FINE, FINE, FINE))
    return BrushPath(tuple((x, y, r) for x, y, r in thinned), _surround(discs))


def _limit(place: float) -> float:
    return min(max(place, -_FAR), _FAR)


def _surround(discs: Sequence[Disc]) -> Box:
    """The box around discs, with room for the pixels at their rims."""
    return (
        min(x - r for x, _, r in discs) - 1.0,
        min(y - r for _, y, r in discs) - 1.0,
        max(x + r for x, _, r in discs) + 1.0,
        max(y + r for _, y, r in discs) + 1.0,
    )


def grow_box(box: Box, across: float, down: float) -> Box:
    """A box with more room on each side."""
    return box[0] - across, box[1] - down, box[2] + across, box[3] + down


def boxes_meet(first: Box, second: Box) -> bool:
    """True if two boxes have a place in common."""
    return first[0] <= second[2] and second[0] <= first[2] and first[1] <= second[3] and second[1] <= first[3]


def find_patch(paths: Sequence[BrushPath], size: Size, overscan: int) -> Patch | None:
    """The part of a picture that paths reach, in steps, so that it often stays while strokes grow; None for none.

    It may lie beyond the frame by as many pixels as the overscan has.
    """
    left, top = (max(math.floor(min(path.box[axis] for path in paths) / GRID) * GRID, -overscan) for axis in (0, 1))
    right, bottom = (
        min(math.ceil(max(path.box[axis + 2] for path in paths) / GRID) * GRID + MARGIN, size[axis] + overscan)
        for axis in (0, 1)
    )
    return Patch((left, top), (right - left, bottom - top)) if left < right and top < bottom else None


def make_rows(draw: Draw, numbers: Iterable[float], width: int) -> Drawn:
    """A table with a power of two of rows."""
    return draw.table(_fill_rows(numbers, width), width)


def _fill_rows(numbers: Iterable[float], width: int) -> tuple[float, ...]:
    """Numbers, and zeros after them up to a power of two of rows."""
    filled = tuple(numbers)
    rows = 1 << max(-(-len(filled) // (4 * width)) - 1, 0).bit_length()
    return filled + (0.0,) * (4 * width * rows - len(filled))


def draw_tables(draw: Draw, paths: Sequence[BrushPath], patch: Patch) -> PathTables:
    """Sort the segments of paths into the tiles of a patch."""
    across, down = -(-patch.size[0] // TILE), -(-patch.size[1] // TILE)
    channels = sum(path.channel_count for path in paths)
    rows, four = 1 << (-(-channels // 16) - 1).bit_length(), Vector(width=4)
    segments, owners = (draw.table(numbers, 2 * BLOCK) for numbers in _join(tuple(paths)))
    words = draw(
        "paint_words", segments=segments, owners=owners, size=(4 * across, rows * down), result=four,
        origin=patch.origin, rows=rows, channels=channels,
    )  # fmt: skip
    digest = draw("paint_digest", words=words, size=(across, down), result=four, rows=rows)
    return PathTables(segments, owners, words, digest, rows)


@lru_cache(maxsize=256)
def _join(paths: tuple[BrushPath, ...]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """The rows of all segments, and of the channels of the paths."""
    packed = [_pack(path) for path in paths]
    facts = (
        part
        for number, (_, boxes) in enumerate(packed)
        for count, box in boxes
        for part in (number, count, 0.0, 0.0, *box)
    )
    segments = (part for segments, _ in packed for part in segments)
    return _fill_rows(segments, 2 * BLOCK), _fill_rows(facts, 2 * BLOCK)


@lru_cache(maxsize=2048)
def _pack(path: BrushPath) -> tuple[tuple[float, ...], tuple[tuple[int, Box], ...]]:
    """Two texels for each segment, filled up to whole channels; the number of segments and the box of each channel."""
    segments, numbers, boxes = path.segments, list[float](), list[tuple[int, Box]]()
    for start, end in segments:
        numbers += (*start, 0.0, *end, 0.0)
    numbers += [0.0] * (8 * (path.channel_count * BITS - len(segments)))
    for first in range(0, len(segments), BITS):
        part = segments[first : first + BITS]
        boxes.append((len(part), _surround([disc for segment in part for disc in segment])))
    return tuple(numbers), tuple(boxes)


def stamp_path(path: BrushPath, width: float) -> tuple[Disc, ...]:
    """Discs along a path at equal distances, the first one at its start."""
    total = sum(math.dist(start[:2], end[:2]) for start, end in path.segments)
    count = min(math.ceil(total / max(STEP * width, 1e-6)), MAX_STAMPS - 1)
    if count < 1:
        return path.discs[:1]
    stamps, step, passed, stamp = [path.discs[0]], total / count, 0.0, 1
    for start, end in path.segments:
        length = math.dist(start[:2], end[:2])
        while stamp <= count and (stamp * step <= passed + length or (stamp == count and end is path.discs[-1])):
            t = min((stamp * step - passed) / max(length, 1e-9), 1.0)
            stamps.append(_mix(start, end, t))
            stamp += 1
        passed += length
    return tuple(stamps)


def _mix(start: Disc, end: Disc, t: float) -> Disc:
    x, y, r = (a + (b - a) * t for a, b in zip(start, end, strict=True))
    return x, y, r


def draw_smear(draw: Draw, base: Pixels, stroke: PaintStroke, path: BrushPath, patch: Patch) -> Drawn:
    """A patch with what is under a brush dragged along its path: warped by each stamp, the last one first."""
    stamps = stamp_path(path, stroke.size)
    moves = [(*new, new[0] - old[0], new[1] - old[1]) for old, new in pairwise(stamps)]
    numbers, hulls = list[float](), list[float]()
    for first in range(0, len(moves), BLOCK):
        part = moves[first : first + BLOCK]
        hulls += _surround([move[:3] for move in part])
        for x, y, r, dx, dy in part:
            numbers += (x, y, r, 0.0, dx, dy, 0.0, 0.0)
    left, top, right, bottom = path.box
    return draw(
        "paint_smear", base=base, stamps=make_rows(draw, numbers, 2 * BLOCK), hulls=make_rows(draw, hulls, BLOCK),
        overlap={"base": patch.read(math.ceil(right - left) + 1, math.ceil(bottom - top) + 1)}, size=patch.size,
        count=len(moves), origin=patch.origin, hardness=stroke.hardness, strength=stroke.opacity,
    )  # fmt: skip
