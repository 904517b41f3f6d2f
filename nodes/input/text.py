"""Text over a picture. The provider shapes it and gives outlines; `_paths.py` says how these become pixels."""

import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, pairwise
from typing import Annotated, Literal, NamedTuple

from .._declare import (
    RGBA,
    Curve4,
    Dial,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    FontPath,
    Image,
    OutputSocket,
    Position,
    Prose,
    RotoMode,
    Size,
    Slider,
    TextAlign,
    TextBlock,
    TextDirection,
    Typeface,
    TypesetText,
)
from ._paths import BITS, BLOCK, SEGMENTS, TILE, PathFill, count_blocks, draw_coverage, draw_distance

Point = tuple[float, float]
Box = tuple[float, float, float, float]
"""Left, top, right and bottom."""

_FINE = 0.003
"""How far in pixels a segment may be from its curve. The polygon has the area of the curve and is on both sides of it,
by two thirds of this at most: coverage is exact to 1 / 255."""

_COARSE = 0.006
"""How far a segment may be that is no longer than `_SHORT`: what is too much at its middle is missing at its ends."""

_SHORT = 1.5
"""Pixels: the length up to which a segment counts as short. Coverage is a mean over a pixel, where errors even out."""

_LONG = 64.0
"""The longest segment in pixels: a slanted one then lies in few tiles that it does not cross."""

_LOOSE = 0.02
"""How far in pixels a point may lie from a chord that stands for it: what lies between is at most 0.06 away."""

_BLUR_REACH = 4.0
"""Sigmas that a Gaussian of `draw.blur` reaches."""

_MOST_SEGMENTS = 512
"""The most segments of a curve: as many as a quarter of a circle needs that is 3000 pixels high."""

_MOST_ROWS = 8192
"""The highest picture that a table of tiles becomes: half of what every device can draw."""


_MOST_LAYERS = 4
"""A letter, the next one that joins it, and a mark on each; what is beyond shares the last layer."""

_NEIGHBORS = 64
"""How many letters of a layer can be near the next one: more than in a line and a half of a long text."""

_LARGER = tuple(RotoMode).index(RotoMode.MAX)
"""The mode of a fill that keeps the larger coverage."""


class _Letter(NamedTuple):
    """The polygons of a glyph in pixels, and the box around them."""

    polygons: list[list[Point]]
    box: Box

    @property
    def span_count(self) -> int:
        """How many spans of segments it has."""
        return sum(-(-len(polygon) // SEGMENTS) for polygon in self.polygons)


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
        cover = _draw_letters(draw, letters)
        body = _draw_stroke(draw, cover, letters, self.outline_width) if self.outline_width > 0.0 else cover
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
        across = {"left": 0.0, "center": 0.5, "right": 1.0}[self.align] * typeset.width
        down = {
            "top": 0.0, "middle": 0.5 * typeset.height, "bottom": typeset.height, "baseline": typeset.ascent,
        }[self.vertical]  # fmt: skip
        cos, sin = math.cos(self.rotation), math.sin(self.rotation)
        x, y = (self.anchor[i] * size[i] for i in (0, 1))
        across, down = across * self.size, down * self.size
        return _Placement(self.size, cos, sin, x - cos * across + sin * down, y - sin * across - cos * down)


def _trace_letters(typeset: TypesetText, to: _Placement, size: Size, margin: float) -> Iterator[_Letter]:
    """All letters that can be seen. Each outline is flattened once."""
    polygons = [[_flatten(contour, to.scale) for contour in outline] for outline in typeset.outlines]
    for place in typeset.places:
        x, y = place.x * to.scale, place.y * to.scale
        x, y = to.x + to.cos * x - to.sin * y, to.y + to.sin * x + to.cos * y
        moved = [
            [(x + to.cos * a - to.sin * b, y + to.sin * a + to.cos * b) for a, b in polygon]
            for polygon in polygons[place.outline]
        ]
        across, down = zip(*chain.from_iterable(moved), strict=True)
        box = min(across), min(down), max(across), max(down)
        if _overlap(box, (-margin, -margin, size[0] + margin, size[1] + margin)):
            yield _Letter(moved, box)


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
            if not any(_overlap(letter.box, other.box) for other in layer[-_NEIGHBORS:]):
                layer.append(letter)
                break
        else:
            if len(layers) < _MOST_LAYERS:
                layers.append([letter])
            else:
                layers[-1].append(letter)
    return layers


def _flatten(contour: tuple[Curve4, ...], scale: float) -> list[Point]:
    """A closed polygon with the area of a contour: points within curves lie a little outside, as `roto_points` says."""
    polygon = list[Point]()
    for curve in contour:
        ax, ay, bx, by, cx, cy, dx, dy = (part * scale for part in curve)
        first = ax - 2.0 * bx + cx, ay - 2.0 * by + cy
        second = bx - 2.0 * cx + dx, by - 2.0 * cy + dy
        bend = max(math.hypot(*first), math.hypot(*second))
        length = math.dist((ax, ay), (bx, by)) + math.dist((bx, by), (cx, cy)) + math.dist((cx, cy), (dx, dy))
        fine = min(math.sqrt(0.75 * bend / _FINE), max(length / _SHORT, math.sqrt(0.75 * bend / _COARSE)))
        count = min(max(1, math.ceil(fine), math.ceil(length / _LONG)), _MOST_SEGMENTS)
        polygon.append((ax, ay))
        push = 6.0 / (12.0 * count * count)
        for number in range(1, count):
            t = number / count
            u = 1.0 - t
            p, q, r, s = u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t
            x = p * ax + q * bx + r * cx + s * dx - push * (u * first[0] + t * second[0])
            y = p * ay + q * by + r * cy + s * dy - push * (u * first[1] + t * second[1])
            polygon.append((x, y))
    return polygon


def _draw_letters(draw: Draw, letters: list[_Letter]) -> Drawn:
    """The coverage of all letters. Many are drawn in several parts, so that no table is higher than it can be."""
    cover = draw("path_nothing", size=draw.size, result=Field(), overlap={})
    most = BITS * 16 * max(1, _MOST_ROWS // -(-draw.size[1] // TILE))
    parts, span_count = [list[_Letter]()], 0
    for letter in letters:
        span_count += letter.span_count
        if parts[-1] and span_count > most:
            parts, span_count = [*parts, []], letter.span_count
        parts[-1].append(letter)
    for part in parts:
        cover = _cover_layers(draw, cover, _sort_layers(part)) if part else cover
    return cover


def _cover_layers(draw: Draw, cover: Drawn, layers: list[list[_Letter]]) -> Drawn:
    """The mask with layers of letters: where letters overlap, the one that covers more of a pixel counts."""
    fills = [PathFill(sum(letter.span_count for letter in layer), _LARGER) for layer in layers]
    spans, points = list[float](), list[float]()
    for fill, layer in zip(fills, layers, strict=True):
        for polygon in chain.from_iterable(letter.polygons for letter in layer):
            base, count = len(spans) // 4, -(-len(polygon) // SEGMENTS)
            for span in range(base + 1, base + count):
                spans += (0.0, 0.0, 0.0, span)
            spans += (0.0, 0.0, 0.0, base)
            for x, y in polygon:
                points += (x, y, 0.0, 0.0)
            points += (*polygon[-1], 0.0, 0.0) * (count * SEGMENTS - len(polygon))
        free = fill.channel_count * BITS - fill.span_count
        spans += (0.0,) * (4 * free)
        points += (0.0,) * (4 * SEGMENTS * free)
    free = count_blocks(fills) * BLOCK - len(spans) // 4
    spans += (0.0,) * (4 * free)
    points += (0.0,) * (4 * SEGMENTS * free)
    tables = draw.table(tuple(spans), BLOCK), draw.table(tuple(points), BLOCK * SEGMENTS)
    return draw_coverage(draw, cover, fills, *tables)


def _thin_out(polygon: list[Point]) -> list[Point]:
    """The points of a polygon without those that lie almost on the line to the next one that stays."""
    corners = [polygon[0]]
    for before, point, after in zip(polygon, polygon[1:], (*polygon[2:], polygon[0]), strict=False):
        (x, y), (a, b) = corners[-1], after
        across, down = a - x, b - y
        away = abs(across * (point[1] - y) - down * (point[0] - x))
        near = math.dist(before, corners[-1]) + math.dist(point, before)
        if away > _LOOSE * math.hypot(across, down) or near > _LONG:
            corners.append(point)
    return corners


def _draw_stroke(draw: Draw, cover: Drawn, letters: list[_Letter], width: float) -> Drawn:
    """The letters grown by a width, as a function of the distance to their outlines."""
    chords = list[float]()
    for polygon in chain.from_iterable(letter.polygons for letter in letters):
        corners = _thin_out(polygon)
        for start, end in pairwise((*corners, corners[0])):
            chords += (*start, *end, 0.0, 0.0, 0.0, 0.0)
    if not chords:
        return cover
    nearest = draw_distance(draw, tuple(chords), width + 1.0)
    return draw.point("text_stroke", cover=cover, nearest=nearest, result=Field(), width=width)
