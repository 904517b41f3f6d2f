"""Shapes runs of letters into glyphs by HarfBuzz, and reads the outlines of glyphs."""

from __future__ import annotations

from functools import lru_cache
from typing import Any
from unicodedata import category

from halation.nodes import Contour, Curve4
from msgspec import Struct

from .bidi_runs import TextRun
from .fonts import LoadedFont
from .harfbuzz import hb

_IGNORED = frozenset({"Cc", "Cf", "Zl", "Zp"})
"""Categories of characters that have no picture, so that no glyph of them is missing."""


class ShapedGlyph(Struct, frozen=True):
    """A glyph by its number in the font, in em: how far it moves on, and where it lies from there, y up."""

    glyph: int
    cluster: int
    """The first letter that it stands for."""
    advance: float
    x: float
    y: float


def shape_run(paragraph: str, run: TextRun, font: LoadedFont, tracking: float) -> list[ShapedGlyph]:
    """The glyphs of a run from left to right. Letters beside it count as its context.

    With tracking there are no ligatures, whose letters could not be moved apart.
    """
    buffer = hb.Buffer()
    buffer.add_str(paragraph, run.start, run.end - run.start)
    buffer.direction = "rtl" if run.is_backward else "ltr"
    buffer.script, buffer.language = run.script, "und"
    hb.shape(font.font, buffer, {"liga": False, "clig": False} if tracking else {})
    infos, places, scale = buffer.glyph_infos, buffer.glyph_positions, 1.0 / font.upem
    glyphs = list[ShapedGlyph]()
    for number, (info, place) in enumerate(zip(infos, places, strict=True)):
        is_last = number + 1 == len(infos) or infos[number + 1].cluster != info.cluster
        advance = place.x_advance * scale + (tracking if is_last else 0.0)
        glyphs.append(
            ShapedGlyph(info.codepoint, info.cluster, advance, place.x_offset * scale, place.y_offset * scale)
        )
    return glyphs


def find_missing(paragraph: str, glyphs: list[ShapedGlyph]) -> list[str]:
    """The characters that a font has no glyph for."""
    letters = (paragraph[glyph.cluster] for glyph in glyphs if glyph.glyph == 0)
    return [letter for letter in letters if category(letter) not in _IGNORED]


@lru_cache(maxsize=4096)  # chosen by judgement: the letters of a few fonts, a few KB each
def trace_glyph(font: LoadedFont, glyph: int) -> tuple[Contour, ...]:
    """The outlines of a glyph in em, y down, as cubic curves; straight lines are curves too."""
    tracer = _GlyphTracer(1.0 / font.upem)
    font.font.draw_glyph(glyph, _make_functions(), tracer)
    return tuple(contour for contour in map(tuple, tracer.contours) if contour)


@lru_cache(maxsize=1)
def _make_functions() -> Any:
    """The functions by which HarfBuzz draws."""
    functions = hb.DrawFuncs()
    functions.set_move_to_func(lambda x, y, tracer: tracer.move(x, y))
    functions.set_line_to_func(lambda x, y, tracer: tracer.line(x, y))
    functions.set_quadratic_to_func(lambda a, b, x, y, tracer: tracer.quadratic(a, b, x, y))
    functions.set_cubic_to_func(lambda a, b, c, d, x, y, tracer: tracer.cubic(a, b, c, d, x, y))
    functions.set_close_path_func(lambda tracer: tracer.close())
    return functions


class _GlyphTracer:
    """Collects the curves of a glyph."""

    def __init__(self, scale: float) -> None:
        self.contours = list[list[Curve4]]()
        self._scale, self._x, self._y = scale, 0.0, 0.0

    def move(self, x: float, y: float) -> None:
        self.contours.append([])
        self._x, self._y = x * self._scale, -y * self._scale
        self._start = self._x, self._y

    def line(self, x: float, y: float) -> None:
        """A straight line, as a curve whose inner points lie on it at thirds."""
        x, y = x * self._scale, -y * self._scale
        across, down = (x - self._x) / 3.0, (y - self._y) / 3.0
        self._add(self._x + across, self._y + down, x - across, y - down, x, y)

    def quadratic(self, a: float, b: float, x: float, y: float) -> None:
        """A quadratic curve, as the cubic one that is the same."""
        a, b, x, y = a * self._scale, -b * self._scale, x * self._scale, -y * self._scale
        self._add(
            (self._x + 2.0 * a) / 3.0, (self._y + 2.0 * b) / 3.0, (x + 2.0 * a) / 3.0, (y + 2.0 * b) / 3.0, x, y
        )  # fmt: skip

    def cubic(self, a: float, b: float, c: float, d: float, x: float, y: float) -> None:
        scale = self._scale
        self._add(a * scale, -b * scale, c * scale, -d * scale, x * scale, -y * scale)

    def close(self) -> None:
        """Go back to the start, where the font has not done so."""
        if self.contours and (self._x, self._y) != self._start:
            self.line(self._start[0] / self._scale, -self._start[1] / self._scale)

    def _add(self, a: float, b: float, c: float, d: float, x: float, y: float) -> None:
        self.contours[-1].append((self._x, self._y, a, b, c, d, x, y))
        self._x, self._y = x, y
