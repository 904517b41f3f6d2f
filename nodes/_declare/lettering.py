"""Text that is set in type: what a node asks for, and the outlines that it gets."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

TextAlign = Literal["left", "center", "right"]
TextDirection = Literal["auto", "left to right", "right to left"]

MAX_TEXT = 20_000
"""The most characters of a text: ten pages, and more than a picture shows."""


class Typeface(Struct, frozen=True):
    """A font: a file, else a family by name, else the font of the package. `weight` is 400 for regular, 700 for bold.

    A font without this weight is drawn thicker or thinner.
    """

    path: str = ""
    family: str = ""
    weight: float = 400.0


class TextBlock(Struct, frozen=True):
    """Lines of text in one typeface. Lengths are parts of the font's size, its em.

    Lines are `leading` apart and have `tracking` between their letters. They are wrapped at `width`, if that is
    above 0.
    """

    text: str
    typeface: Typeface = Typeface()
    tracking: float = 0.0
    leading: float = 1.2
    align: TextAlign = "left"
    direction: TextDirection = "auto"
    width: float = 0.0


Curve4 = tuple[float, float, float, float, float, float, float, float]
"""A cubic curve: the x and y of its four points."""

Contour = tuple[Curve4, ...]
"""A closed outline of curves, each starting where the one before ends."""


class GlyphPlace(Struct, frozen=True):
    """A glyph by its number in the outlines, and where its origin is."""

    outline: int
    x: float
    y: float


class TypesetText(Struct, frozen=True):
    """A text as outlines. Lengths are parts of the em, y grows down, and 0 is the left end of the first line's top.

    The block is `width` wide, or as wide as its longest line, and reaches from the ascent of the first line to the
    descent of the last one. `missing` are the characters that the font has no glyph for.
    """

    outlines: tuple[tuple[Contour, ...], ...] = ()
    places: tuple[GlyphPlace, ...] = ()
    width: float = 0.0
    height: float = 0.0
    ascent: float = 0.0
    line_count: int = 0
    missing: tuple[str, ...] = ()
    font: str = ""
    """The name of the font, for messages."""
