"""Closed outlines as masks: `lib/paths.glsl` from Python. A pixel looks at what crosses its tile, and at no more.

What crosses a tile is found on the processor, in 64 bits, once for each change of the outlines.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from .._declare import Draw, Drawn, Field, Vector

if TYPE_CHECKING:
    from ._flattening import Outline

ENTRY = 10
"""Texels of an entry."""

_TILE, _LEAST_BITS = 16, 7
"""Tables are at least 128 texels wide: then small ones have few rows."""

PathMode = int
"""How an outline changes the mask below: a place in the list of `RotoMode`."""


class PathFill(NamedTuple):
    """An outline in pixels, and how it changes a mask."""

    outline: Outline
    mode: PathMode = 0
    opacity: float = 1.0
    invert: bool = False
    feather: float = 0.0
    """How wide its edge is, in addition to the feathers of its points."""
    growth: float = 0.0
    """How far its edge is moved outward."""


def draw_fills(draw: Draw, mask: Drawn, fills: Sequence[PathFill]) -> Drawn:
    """The mask with all outlines, one after the other: see the GLSL."""
    from ._path_tables import build_tables

    beyond = -(-draw.overscan // _TILE)
    tables = build_tables(fills, draw.size, beyond)
    bits = _LEAST_BITS
    while max(map(len, tables.values())) > 4**bits:
        bits += 1
    pictures = {name: draw.table(array("f", numbers.tobytes()), 2**bits) for name, numbers in tables.items()}
    entries, shapes = pictures["entries"], pictures["shapes"]
    count = len(tables["entries"]) // ENTRY
    across = math.ceil(math.log2(max(2.0 * math.sqrt(count), 1.0)))
    size = _TILE // 4 << across, _TILE * max(1, -(-count >> across))
    covers = draw(
        "path_covers", entries=entries, shapes=shapes, segments=pictures["segments"], chords=pictures["chords"],
        nearest=pictures["nearest"], size=size, result=Vector(width=4),
        bits=bits, across=across, count=count, beyond=beyond,
    )  # fmt: skip
    return draw(
        "path_cover", mask=mask, tiles=pictures["tiles"], entries=entries, shapes=shapes, covers=covers,
        overlap={"mask": 0}, result=Field(), bits=bits, across=across, beyond=beyond, columns=-(-draw.size[0] // _TILE) + 2 * beyond,
    )  # fmt: skip
