"""Closed outlines of straight segments as coverage, and the distance to them: `lib/paths.glsl` from Python.

Segments come in *spans* of eight. For each tile of the picture a table says which spans matter there. So a pixel looks
at a few segments only, however many there are.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self

from .._declare import Draw, Drawn, Field, Size, Vector

TILE = 16
"""Pixels of a side of a tile. Chosen by judgement: smaller ones need larger tables, larger ones hold more spans."""
SEGMENTS = 8
"""Segments of a span."""

BITS = 24
"""Spans to a channel of a texel: as many as a float holds exactly."""

BLOCK = 16
"""Spans side by side in the tables, so that no table is higher than a texture can be."""

PathMode = int
"""How an outline changes the mask below: a place in the list of `RotoMode`."""


class TileGrid(NamedTuple):
    """The tiles of a picture with those beyond its frame."""

    size: Size
    beyond: int
    """How many tiles there are on each side of the frame."""

    @classmethod
    def of(cls, draw: Draw) -> Self:
        """The tiles of what a node may draw."""
        beyond = -(-draw.overscan // TILE)
        across, down = (-(-side // TILE) + 2 * beyond for side in draw.size)
        return cls((across, down), beyond)


class PathFill(NamedTuple):
    """How the outlines of some spans, which count together, change a mask."""

    span_count: int
    mode: PathMode = 0
    opacity: float = 1.0
    invert: bool = False

    @property
    def channel_count(self) -> int:
        """The channels of its spans: each outline starts with a new one."""
        return -(-self.span_count // BITS)


def count_blocks(fills: Sequence[PathFill]) -> int:
    """How many rows of a table hold the spans of all fills."""
    return -(-sum(fill.channel_count for fill in fills) * BITS // BLOCK)


def draw_coverage(draw: Draw, mask: Drawn, fills: Sequence[PathFill], spans: Drawn, points: Drawn) -> Drawn:
    """Sort spans into tiles, sum what lies left of each tile, then cover pixels: see the GLSL.

    `spans` has a texel for each span, whose fourth number is the span that follows; `points` has the eight points at
    which the segments of each span start.
    """
    grid, count = TileGrid.of(draw), len(fills)
    across, down = grid.size
    channels, blocks = sum(fill.channel_count for fill in fills), count_blocks(fills)
    rows, groups = -(-channels // 16), max(-(-fill.channel_count // (4 * BITS)) for fill in fills)
    shapes, owners = draw.table(_pack_fills(fills), 2), draw.table(_pack_channels(fills), BLOCK)
    four = Vector(width=4)
    boxes = draw("path_boxes", spans=spans, points=points, size=(BLOCK, blocks), result=four)
    hulls = draw("path_hulls", owners=owners, boxes=boxes, size=owners.size, result=four)
    words = draw(
        "path_words", spans=spans, points=points, boxes=boxes, hulls=hulls, owners=owners,
        size=(4 * across, rows * down), result=four, rows=rows, channels=channels, beyond=grid.beyond,
    )  # fmt: skip
    digest = draw(
        "path_digest", words=words, shapes=shapes, size=(across * count * groups, down), result=four,
        rows=rows, groups=groups, count=count,
    )  # fmt: skip
    steps = draw(
        "path_crossings", spans=spans, points=points, shapes=shapes, boxes=boxes, words=words, digest=digest,
        size=(across * count, TILE // 4 * down), result=four,
        rows=rows, groups=groups, count=count, beyond=grid.beyond,
    )  # fmt: skip
    backdrop = draw("path_backdrop", steps=steps, size=steps.size, result=four, count=count)
    levels = draw(
        "path_level", shapes=shapes, digest=digest, backdrop=backdrop, size=(across, down), result=four,
        groups=groups, count=count,
    )  # fmt: skip
    return draw(
        "path_cover", mask=mask, spans=spans, points=points, shapes=shapes, boxes=boxes, words=words, digest=digest,
        backdrop=backdrop, levels=levels,
        overlap={"mask": 0}, result=Field(), rows=rows, groups=groups, count=count,
        segments=SEGMENTS, beyond=grid.beyond,
    )  # fmt: skip


def draw_distance(draw: Draw, chords: tuple[float, ...], reach: float) -> Drawn:
    """The distance from each pixel to the nearest chord, as far as `reach`, and the feather there.

    A chord is two texels: its ends, then the feather at its start and its end.
    """
    grid = TileGrid.of(draw)
    across, down = grid.size
    count, channels = len(chords) // 8, -(-len(chords) // (8 * BITS))
    rows, groups = -(-channels // 16), -(-channels // (4 * BITS))
    table, four = draw.table(chords, 2 * BLOCK), Vector(width=4)
    hulls = draw("path_chord_hulls", chords=table, size=(BLOCK, -(-channels // BLOCK)), result=four, chord_count=count)
    nearest = draw(
        "path_nearest", chords=table, hulls=hulls, size=(across, down), result=Field(),
        chord_count=count, channels=channels, beyond=grid.beyond,
    )  # fmt: skip
    words = draw(
        "path_chord_words", chords=table, hulls=hulls, nearest=nearest, size=(4 * across, rows * down), result=four,
        rows=rows, channels=channels, chord_count=count, reach=reach, beyond=grid.beyond,
    )  # fmt: skip
    shape = draw.table((0.0, channels, count, 0.0), 1)
    digest = draw(
        "path_digest", words=words, shapes=shape, size=(across * groups, down), result=four,
        rows=rows, groups=groups, count=1,
    )  # fmt: skip
    return draw(
        "path_distance", chords=table, words=words, digest=digest, overlap={}, result=Vector(width=2),
        rows=rows, groups=groups, parts=-(-channels // BITS), reach=reach, beyond=grid.beyond,
    )  # fmt: skip


def _pack_fills(fills: Sequence[PathFill]) -> tuple[float, ...]:
    """Two texels for each fill.

    The first channel, the channels, the spans, the mode. The opacity, whether it is inverted; the rest is free.
    """
    numbers, first = list[float](), 0
    for fill in fills:
        numbers += (first, fill.channel_count, fill.span_count, fill.mode)
        numbers += (fill.opacity, float(fill.invert), 0.0, 0.0)
        first += fill.channel_count
    return tuple(numbers)


def _pack_channels(fills: Sequence[PathFill]) -> tuple[float, ...]:
    """For each channel of the words the number of its fill, and how many spans it stands for."""
    numbers = list[float]()
    for place, fill in enumerate(fills):
        for start in range(0, fill.span_count, BITS):
            numbers += (place, min(fill.span_count - start, BITS), 0.0, 0.0)
    return tuple(numbers)
