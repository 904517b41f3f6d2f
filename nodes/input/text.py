"""Text over a picture. The provider shapes it and gives outlines."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import Annotated, Literal, NamedTuple

from .._declare import (
    RGBA,
    Contour,
    Dial,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    FontPath,
    Image,
    OutlineFill,
    OutlinePlace,
    OutputSocket,
    Position,
    Prose,
    Size,
    Slider,
    TextAlign,
    TextBlock,
    TextDirection,
    Typeface,
    TypesetText,
)

Box = tuple[float, float, float, float]
"""Left, top, right and bottom."""

_BLUR_REACH = 4.0
"""Sigmas that a Gaussian of `draw.blur` reaches."""

_MOST_LAYERS = 4
"""A letter, the next one that joins it, and a mark on each; what is beyond shares the last layer."""

_NEIGHBORS = 64
"""How many letters of a layer can be near the next one: more than in a line and a half of a long text."""


class _Letter(NamedTuple):
    """Where a glyph is, and the box around its control points in pixels."""

    place: OutlinePlace
    box: Box


class _Placement(NamedTuple):
    """A map from em to pixels: `scale` pixels to the em, turned by cosine and sine, then moved."""

    scale: float
    cos: float
    sin: float
    x: float
    y: float


class Text(Filter):
    """Draw text over a picture, in the font of the package, a font file, or an installed family.

    All scripts are shaped by HarfBuzz: Arabic joins, marks of Hebrew and Devanagari find their places, and lines run
    both ways. Letters are exact areas of their outlines at every size. Sizes are parts of the picture's height.

    Tokens in braces become words: {frame}, {frame:4} with four digits, {timecode}, {seconds}, {rate}, {size}, {file},
    {path}, {date}, {meta:Make} for a name in the header of the file that the picture comes from, and {=frame / 24} for
    a formula. Two braces draw one.
    """

    aliases = (
        "title", "text+", "type", "caption", "label", "subtitle", "lower third", "watermark", "burn-in", "burnin",
        "slate", "timecode", "string", "font", "typography", "text generator", "draw text", "text image", "credits",
        "text block", "text plus", "string to image", "drop shadow", "timer",
    )  # fmt: skip

    image = Image(0.0, doc="The picture below the text.")
    text: Annotated[Prose, Doc("What is drawn. Lines are broken where it has line breaks, and at the wrap width.")] = (
        "Title"
    )
    font: Annotated[FontPath, Doc("A font file. If empty, the family is used.")] = ""
    family: Annotated[
        str,
        Doc(
            "The name of a font family. 'DejaVu Sans' and 'DejaVu Sans Mono' come with Halation and look the same "
            "everywhere; others must be installed."
        ),
    ] = "DejaVu Sans"
    weight: Annotated[
        float,
        Slider(
            100.0, 900.0, unit="count", minimum=1.0, maximum=1000.0,
            doc="How bold the letters are: 400 is regular, 700 bold. Fonts without this weight are drawn thicker.",
        ),
    ] = 400.0  # fmt: skip
    size: Annotated[
        float, Slider(0.01, 0.5, unit="height", minimum=0.0, maximum=10.0, doc="The size of the font, its em.")
    ] = 0.1
    tracking: Annotated[
        float,
        Slider(-0.1, 0.5, unit="ratio", minimum=-1.0, maximum=10.0, doc="Space between letters, in parts of the size."),
    ] = 0.0
    leading: Annotated[
        float,
        Slider(0.8, 2.0, unit="ratio", minimum=0.0, maximum=10.0, doc="From line to line, in parts of the size."),
    ] = 1.2
    align: Annotated[TextAlign, Doc("Which side of the lines is straight. That side of the text is at the anchor.")] = (
        "center"
    )
    vertical: Annotated[
        Literal["top", "middle", "bottom", "baseline"],
        Doc("What of the text is at the height of the anchor; the baseline is that of the first line."),
    ] = "middle"
    anchor: Annotated[Position, Doc("Where the text is.")] = (0.5, 0.5)
    wrap_width: Annotated[
        float,
        Slider(0.0, 2.0, unit="height", minimum=0.0, maximum=100.0, doc="The longest line; 0 breaks no lines."),
    ] = 0.0
    fit_width: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=10.0,
            doc="The part of the picture's width that the text may take: where it would be wider, all of it is drawn "
            "smaller. 0 sets no limit.",
        ),
    ] = 0.0  # fmt: skip
    direction: Annotated[
        TextDirection, Doc("Where a paragraph starts. Auto follows its first letter; words keep their own way.")
    ] = "auto"
    rotation: Annotated[
        float, Dial("clockwise"), Slider(-180.0, 180.0, unit="deg", doc="Turns the text around the anchor, clockwise.")
    ] = 0.0
    color: Annotated[RGBA, Doc("The color of the letters, premultiplied.")] = (1.0, 1.0, 1.0, 1.0)
    outline_width: Annotated[
        float,
        Slider(0.0, 0.02, unit="height", minimum=0.0, maximum=1.0, doc="How wide the line around the letters is."),
    ] = 0.0
    outline_color: Annotated[RGBA, Doc("The color of the line around the letters, premultiplied.")] = (
        0.0, 0.0, 0.0, 1.0,
    )  # fmt: skip
    shadow_offset: Annotated[
        tuple[float, float],
        Slider(-0.05, 0.05, unit="height", minimum=-10.0, maximum=10.0, doc="Where the shadow falls, right and down."),
    ] = (0.006, 0.006)
    shadow_blur: Annotated[
        float, Slider(0.0, 0.05, unit="height", minimum=0.0, maximum=1.0, doc="How soft the shadow is.")
    ] = 0.004
    shadow_color: Annotated[RGBA, Doc("The color of the shadow, premultiplied; a transparent one is no shadow.")] = (
        0.0, 0.0, 0.0, 0.0,
    )  # fmt: skip

    out = OutputSocket(Image(doc="The picture with the text over it."))
    matte = OutputSocket(Field(doc="How much of each pixel the letters cover, 0..1."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        size = max(self.size, 1e-6)  # a text of no size is a point
        block = TextBlock(
            draw.expand_text(self.text, self.image), Typeface(self.font, self.family, self.weight), self.tracking,
            self.leading, self.align, self.direction, self.wrap_width / size,
        )  # fmt: skip
        typeset = draw.typeset(block)
        margin = self._margin + draw.overscan
        letters = list(_trace_letters(typeset, self._place(typeset, draw.size), draw.size, margin))
        cover = _draw_letters(draw, typeset, letters)
        body = cover
        if self.outline_width > 0.0 and letters:
            body = draw.fill(cover, [_fill(typeset, letters, self.outline_width)])
        picture = draw.point("text_below", self.image)
        if any(self.shadow_color):
            shadow = draw.place(body, (1.0, 0.0, -self.shadow_offset[0], 0.0, 1.0, -self.shadow_offset[1]), "triangle")
            shadow = draw.blur(shadow, self.shadow_blur, "black") if self.shadow_blur > 0.0 else shadow
            picture = draw.point("text_over", image=picture, cover=shadow, color=self.shadow_color)
        if body is not cover:
            picture = draw.point("text_over", image=picture, cover=body, color=self.outline_color)
        return {"out": draw.point("text_over", image=picture, cover=cover, color=self.color), "matte": cover}

    @property
    def _margin(self) -> float:
        """How far in pixels letters outside of the picture can reach into it."""
        return self.outline_width + max(map(abs, self.shadow_offset)) + _BLUR_REACH * self.shadow_blur + 2.0

    def _place(self, typeset: TypesetText, size: Size) -> _Placement:
        """Where the block of text is: its left top in pixels, turned around the anchor."""
        em = self.size
        if self.fit_width > 0.0 and typeset.width * em > self.fit_width * size[0]:
            em = self.fit_width * size[0] / typeset.width
        across = {"left": 0.0, "center": 0.5, "right": 1.0}[self.align] * typeset.width
        down = {
            "top": 0.0, "middle": 0.5 * typeset.height, "bottom": typeset.height, "baseline": typeset.ascent,
        }[self.vertical]  # fmt: skip
        cos, sin = math.cos(self.rotation), math.sin(self.rotation)
        x, y = (self.anchor[i] * size[i] for i in (0, 1))
        across, down = across * em, down * em
        return _Placement(em, cos, sin, x - cos * across + sin * down, y - sin * across - cos * down)


def _trace_letters(typeset: TypesetText, to: _Placement, size: Size, margin: float) -> Iterator[_Letter]:
    """All letters that can be seen."""
    a, b = to.scale * to.cos, to.scale * to.sin
    boxes = [_find_box(outline, a, b) for outline in typeset.outlines]
    for place in typeset.places:
        x, y = to.x + a * place.x - b * place.y, to.y + b * place.x + a * place.y
        left, top, right, bottom = boxes[place.outline]
        box = left + x, top + y, right + x, bottom + y
        if _overlap(box, (-margin, -margin, size[0] + margin, size[1] + margin)):
            yield _Letter(OutlinePlace(place.outline, (a, -b, x, b, a, y)), box)


def _find_box(outline: tuple[Contour, ...], a: float, b: float) -> Box:
    """The box around a glyph that is turned and scaled, where its origin is 0; nowhere, if there is nothing to draw."""
    curves = list(chain.from_iterable(outline))
    if not curves:
        return math.inf, math.inf, -math.inf, -math.inf
    points = [(curve[at], curve[at + 1]) for curve in curves for at in range(0, 8, 2)]
    across, down = [a * x - b * y for x, y in points], [b * x + a * y for x, y in points]
    return min(across), min(down), max(across), max(down)


def _overlap(box: Box, other: Box) -> bool:
    """True if two boxes have a common place."""
    return box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]


def _sort_layers(letters: Iterable[_Letter]) -> list[list[_Letter]]:
    """Letters in layers, so that those of a layer do not overlap.

    Letters that join, as in Arabic, overlap: where both cover half a pixel, the sum of their areas would be too much.
    """
    layers = list[list[_Letter]]()
    for letter in letters:
        for layer in layers:
            if not _meets_any(letter, layer[-_NEIGHBORS:]):
                layer.append(letter)
                break
        else:
            if len(layers) < _MOST_LAYERS:
                layers.append([letter])
            else:
                layers[-1].append(letter)
    return layers


def _meets_any(letter: _Letter, others: Iterable[_Letter]) -> bool:
    """True if a letter overlaps another one. Each is compared with hundreds, so this is written out."""
    left, top, right, bottom = letter.box
    for other in others:
        box = other.box
        if left < box[2] and box[0] < right and top < box[3] and box[1] < bottom:
            return True
    return False


def _draw_letters(draw: Draw, typeset: TypesetText, letters: list[_Letter]) -> Drawn:
    """The coverage of all letters. Where letters overlap, the one that covers more of a pixel counts."""
    cover = draw("path_nothing", size=draw.size, result=Field(), overlap={})
    return draw.fill(cover, [_fill(typeset, layer) for layer in _sort_layers(letters)]) if letters else cover


def _fill(typeset: TypesetText, letters: Iterable[_Letter], growth: float = 0.0) -> OutlineFill:
    """Letters as one outline; a mask keeps what is more."""
    return OutlineFill(typeset.outlines, tuple(letter.place for letter in letters), "max", growth=growth)
