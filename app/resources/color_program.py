"""Color math that is written elsewhere: GLSL that a color library makes for one change of color."""

from __future__ import annotations

from typing import ClassVar

from ..glsl import GlslText
from .record import Record


class LookupTable(Record, frozen=True):
    """Numbers that GLSL reads through a sampler: float32 [height, width, channels] or [depth, height, width, channels].

    `linear` tables are interpolated by the sampler; all are clamped at their edges. Tables of the same sampler are the
    same.
    """

    sampler: str
    linear: bool
    values: object

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"values"})


class ColorProgram(Record, frozen=True):
    """GLSL 4.00 that declares `vec4 <function>(vec4)`, on straight color, and the samplers of `tables`.

    Programs of the same function are the same.
    """

    function: str
    text: GlslText
    tables: tuple[LookupTable, ...]

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"text"})
