"""Where numbers stand in a block of uniforms, by the rules of std140."""

from __future__ import annotations

from collections.abc import Iterable

Place = tuple[int, str, int]
"""The byte of a block at which a uniform begins, the kind of its numbers (float, int, uint), and for a list or a matrix
how many of them stand in each row of 16 bytes; else 0."""

_KINDS = {"i": "int", "b": "int", "u": "uint"}
_ROW = 16
"""Bytes of a row: lists and matrices begin at one, and so does each of their parts."""


def lay_out_block(uniforms: Iterable[tuple[str, str, int]]) -> tuple[dict[str, Place], int]:
    """The place of each uniform, and the bytes of the whole block (GLSL 4.60, section 7.6.2.2).

    A uniform is a type of GLSL such as `ivec2` or `mat3`, a name, and the length of a list; 0 for a single one.
    """
    places: dict[str, Place] = {}
    end = 0
    for type_, name, length in uniforms:
        width = int(type_[-1]) if type_[-1].isdigit() else 1
        rows = max(length, 1) * width if type_.startswith("mat") else length
        align = _ROW if rows or width > 2 else 4 * width
        start = -(-end // align) * align
        places[name] = start, _KINDS.get(type_[0], "float"), width if rows else 0
        end = start + (_ROW * rows if rows else 4 * width)
    return places, -(-end // _ROW) * _ROW
