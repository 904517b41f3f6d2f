"""Closed outlines as masks: `lib/paths.glsl` from Python. A pixel looks at what crosses its tile, and at no more.

What crosses a tile is found on the processor, in 64 bits, once for each change of the outlines.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence

from halation.nodes import Draw, Drawn, Field, OutlineFill, Pixels, Vector

_TILE, _LEAST_BITS = 16, 7  # pixels; tables are at least 128 texels wide, so that small ones have few rows


class OutlineDraw:
    """The part of `Draw` that fills outlines."""

    def fill(self: Draw, mask: Pixels, fills: Sequence[OutlineFill]) -> Drawn:
        """The mask with all outlines, one after the other: see the GLSL."""
        from .outline_tables import ENTRY, build_tables

        beyond = -(-self.overscan // _TILE)
        tables = build_tables(fills, self.size, beyond)
        bits = _LEAST_BITS
        while max(map(len, tables.values())) > 4**bits:
            bits += 1
        pictures = {
            name: self.table(_fill_rows(numbers.tobytes(), 2**bits), 2**bits) for name, numbers in tables.items()
        }
        entries, shapes = pictures["entries"], pictures["shapes"]
        count = len(tables["entries"]) // ENTRY
        across = math.ceil(math.log2(max(2.0 * math.sqrt(count), 1.0)))
        is_uneven = any(tables["entries"][::ENTRY, 3])
        covers = self(
            "path_covers_fine" if is_uneven else "path_covers", entries=entries, shapes=shapes,
            segments=pictures["segments"], chords=pictures["chords"],
            nearest=pictures["nearest"], size=(_TILE // 4 << across, _TILE * _avoid_powers(-(-count >> across))),
            result=Vector(width=4), bits=bits, across=across, count=count, beyond=beyond,
        )  # fmt: skip
        return self(
            "path_cover", mask=mask, tiles=pictures["tiles"], covers=covers,
            overlap={"mask": 0}, result=Field(), bits=bits, across=across, beyond=beyond,
            columns=-(-self.size[0] // _TILE) + 2 * beyond,
        )  # fmt: skip


def _fill_rows(content: bytes, width: int) -> array[float]:
    """Floats of 32 bits, and zeros up to the end of a row of that many pixels of four channels."""
    numbers = array("f")
    size = numbers.itemsize * 4 * width
    numbers.frombytes(content.ljust(size * _avoid_powers(-(-len(content) // size)), b"\0"))
    return numbers


def _avoid_powers(rows: int) -> int:
    """As many rows or a few more, whose number is no power of two.

    Mesa compiles a program again for pictures whose height is one: the largest takes 0.5 s, and `burn_in` had it three
    times, with an empty cache.
    """
    rows = max(rows, 3)
    return rows + (rows & (rows - 1) == 0)
