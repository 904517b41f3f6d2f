"""Sets text: paragraphs are shaped, broken into lines, and aligned. All lengths are in em."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from unicodedata import category, combining, east_asian_width

from halation.nodes import MAX_TEXT, Contour, GlyphPlace, TextBlock, TypesetText
from msgspec import Struct

from ...errors import InputError
from ...resources.sandbox import Sandbox
from .bidi_runs import find_levels, split_runs
from .fonts import LoadedFont, load_font
from .shaping import ShapedGlyph, find_missing, shape_run, trace_glyph

_MOST_CURVES = 2_000_000
"""The most curves of a text: ten times what the longest text needs in a font with many points."""

_SLACK = 1e-6
"""How much in em a line may be wider than its box: rounding."""


class _TextLine(Struct, frozen=True):
    """The glyphs of a line from left to right, and how far they reach."""

    glyphs: tuple[ShapedGlyph, ...]
    width: float


def typeset(block: TextBlock, sandbox: Sandbox) -> TypesetText:
    """The outlines of a text. Raises InputError for a font that cannot be read, and a text that is too long."""
    if len(block.text) > MAX_TEXT:
        raise InputError(f"the text has {len(block.text):,} characters, and {MAX_TEXT:,} are the most: shorten it")
    return _typeset(block, load_font(block.typeface, sandbox))


@lru_cache(maxsize=64)  # chosen by judgement: the text nodes of a few graphs
def _typeset(block: TextBlock, font: LoadedFont) -> TypesetText:
    lines, missing = list[_TextLine](), list[str]()
    text = block.text.replace("\r\n", "\n").replace("\r", "\n").replace("\t", "    ")
    for paragraph in text.split("\n"):
        clean = "".join(letter for letter in paragraph if category(letter) not in ("Cc", "Cs"))
        for line in _set_paragraph(clean, block, font):
            missing += find_missing(clean, list(line.glyphs))
            lines.append(line)
    extents = font.font.get_font_extents("ltr")
    ascent, descent = extents.ascender / font.upem, -extents.descender / font.upem
    width = block.width or max(line.width for line in lines)
    places, outlines = _place_lines(lines, block, font, width, ascent)
    height = ascent + descent + (len(lines) - 1) * block.leading
    return TypesetText(
        outlines, places, width, height, ascent, len(lines), tuple(dict.fromkeys(missing)), font.name
    )  # fmt: skip


def _place_lines(
    lines: Sequence[_TextLine], block: TextBlock, font: LoadedFont, width: float, ascent: float
) -> tuple[tuple[GlyphPlace, ...], tuple[tuple[Contour, ...], ...]]:
    """The places of all glyphs that can be seen, and the outlines that they share."""
    numbers, places, outlines, curve_count = dict[int, int](), list[GlyphPlace](), list[tuple[Contour, ...]](), 0
    shift = {"left": 0.0, "center": 0.5, "right": 1.0}[block.align]
    for row, line in enumerate(lines):
        x, y = (width - line.width) * shift, ascent + row * block.leading
        for glyph in line.glyphs:
            if glyph.glyph not in numbers:
                numbers[glyph.glyph] = len(outlines)
                outlines.append(trace_glyph(font, glyph.glyph))
            contours = outlines[numbers[glyph.glyph]]
            curve_count += sum(map(len, contours))
            if curve_count > _MOST_CURVES:
                raise InputError(f"the font {font.name} has too many curves for this text: choose another font")
            if contours:
                places.append(GlyphPlace(numbers[glyph.glyph], x + glyph.x, y - glyph.y))
            x += glyph.advance
    return tuple(places), tuple(outlines)


def _set_paragraph(paragraph: str, block: TextBlock, font: LoadedFont) -> Iterator[_TextLine]:
    """The lines of a paragraph. Where it breaks is decided by the widths of letters in the whole paragraph."""
    _, levels = find_levels(paragraph, block.direction)
    ends = [len(paragraph)]
    if block.width > 0.0:
        ends = _break_lines(paragraph, _measure_letters(paragraph, levels, block, font), block.width + _SLACK)
    start = 0
    for end in ends:
        seen_end = start + len(paragraph[start:end].rstrip()) if end < len(paragraph) else end
        glyphs = [
            glyph
            for run in split_runs(paragraph, levels, start, seen_end)
            for glyph in shape_run(paragraph[:seen_end], run, font, block.tracking)
        ]
        width = sum(glyph.advance for glyph in glyphs) - (block.tracking if glyphs else 0.0)
        yield _TextLine(tuple(glyphs), width)
        start = end


def _measure_letters(paragraph: str, levels: Sequence[int], block: TextBlock, font: LoadedFont) -> list[float]:
    """The width of each letter; that of a cluster counts for its first one."""
    widths = [0.0] * len(paragraph)
    for run in split_runs(paragraph, levels, 0, len(paragraph)):
        for glyph in shape_run(paragraph, run, font, block.tracking):
            widths[glyph.cluster] += glyph.advance
    return widths


def _break_lines(paragraph: str, widths: Sequence[float], limit: float) -> list[int]:
    """Where lines end: at the last break that fits, else in the middle of a word that is wider than a line."""
    ends, start, last, width = list[int](), 0, 0, 0.0
    place = 0
    while place < len(paragraph):
        if place > start and _may_break(paragraph, place):
            last = place
        width += widths[place]
        if width > limit and not paragraph[place].isspace() and place > start:
            end = last if last > start else place
            while end > start + 1 and combining(paragraph[end]):
                end -= 1
            ends.append(end)
            start, last, width, place = end, end, 0.0, end
            continue
        place += 1
    return [*ends, len(paragraph)]


def _may_break(paragraph: str, place: int) -> bool:
    """True if a line may end before a letter: after spaces and hyphens, and between ideographs (UAX 14, in short)."""
    before, after = paragraph[place - 1], paragraph[place]
    if after.isspace() or before == "\u00a0":
        return False
    if before.isspace() or before in "\u200b\u2010\u2013\u2014" or (before == "-" and after.isalpha()):
        return True
    return "W" in (east_asian_width(before), east_asian_width(after)) and category(after)[0] not in "PM"
