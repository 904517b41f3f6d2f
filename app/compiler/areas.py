"""Rectangles of pictures, and which rectangle of one picture is read for a rectangle of another."""

from __future__ import annotations

import math

from halation.nodes import Affine, Edge, Size
from msgspec import Struct

Span = tuple[int, int]
"""Pixels along an axis: the first, and the one after the last."""

_FAR = 2**30
"""Beyond every picture, and small enough that shaders can hold it as an int."""


class Region(Struct, frozen=True):
    """A rectangle of pixels, of which (x, y) is the top left one."""

    x: int
    y: int
    width: int
    height: int

    @staticmethod
    def whole(size: Size) -> Region:
        """The region that is a whole picture."""
        return Region(0, 0, *size)

    @staticmethod
    def of(across: Span, down: Span) -> Region:
        """The region that covers these spans along both axes."""
        return Region(across[0], down[0], across[1] - across[0], down[1] - down[0])

    @property
    def size(self) -> Size:
        return (self.width, self.height)

    @property
    def start(self) -> tuple[int, int]:
        """The top left pixel."""
        return (self.x, self.y)

    @property
    def across(self) -> Span:
        return (self.x, self.x + self.width)

    @property
    def down(self) -> Span:
        return (self.y, self.y + self.height)

    def contains(self, region: Region) -> bool:
        """True if all pixels of a region lie in this one."""
        return self.union(region) == self

    def grow(self, margin: int) -> Region:
        """The region with so many more pixels on each side."""
        return Region(self.x - margin, self.y - margin, self.width + 2 * margin, self.height + 2 * margin)

    def intersect(self, region: Region) -> Region:
        """The pixels that lie in both, of which there must be some."""
        spans = zip((self.across, self.down), (region.across, region.down), strict=True)
        across, down = ((max(own[0], their[0]), min(own[1], their[1])) for own, their in spans)
        return Region.of(across, down)

    def union(self, region: Region) -> Region:
        """The smallest region that holds both."""
        spans = zip((self.across, self.down), (region.across, region.down), strict=True)
        across, down = ((min(own[0], their[0]), max(own[1], their[1])) for own, their in spans)
        return Region.of(across, down)


class Neighborhood(Struct, frozen=True):
    """Where a function reads a picture: `matrix` maps the center of its own pixel to a position, and the function reads
    pixels up to `radius` away from the one there, along each axis."""

    matrix: Affine
    radius: tuple[float, float]
    shows: bool = False
    """What is there is shown, so that a picture that reaches beyond the frame makes the result go on there."""

    @staticmethod
    def pixel(own: Size, read: Size, radius: tuple[float, float]) -> Neighborhood:
        """A neighborhood of the same pixel; in a picture of another size, of the one at the same relative position."""
        return Neighborhood((read[0] / own[0], 0.0, 0.0, 0.0, read[1] / own[1], 0.0), radius)

    def find_spans(self, region: Region) -> tuple[Span, Span]:
        """The pixels that are read for a region, which may lie beyond the edges of the picture."""
        a, b, x, c, d, y = self.matrix
        corners = [
            (i, j)
            for i in (region.x + 0.5, region.x + region.width - 0.5)
            for j in (region.y + 0.5, region.y + region.height - 0.5)
        ]
        return (
            _find_span([a * i + b * j + x for i, j in corners], self.radius[0]),
            _find_span([c * i + d * j + y for i, j in corners], self.radius[1]),
        )


def scale_size(size: Size, scale: float) -> Size:
    """The size of a picture at a scale, at least a pixel."""
    return max(1, round(size[0] * scale)), max(1, round(size[1] * scale))


def clip_span(span: Span, length: int, edge: Edge, window: Span | None = None) -> Span:
    """The pixels of a row of `length` that an edge mode reads for a span that goes beyond its ends.

    Of a row of which `window` holds more, clamp and black read more. The other modes continue the row itself.
    """
    first, end = span
    if edge in ("clamp", "black"):
        start, stop = window or (0, length)
        return min(max(first, start), stop - 1), max(min(end, stop), start + 1)
    if first >= 0 and end <= length:
        return span
    low, high = min(max(first, 0), length - 1), max(min(end, length), 1)
    if edge in ("wrap", "panorama") or first < -length or end > 2 * length:
        return 0, length
    border = 1 if edge == "mirror" else 0
    if first < 0:
        high = max(high, min(border - first, length))
    if end > length:
        low = min(low, max(2 * length - border - end, 0))
    return low, high


def clip_region(across: Span, down: Span, size: Size, edge: Edge, window: Region | None = None) -> Region:
    """The pixels that an edge mode reads for spans beyond the edges of a picture, of which `window` may hold more."""
    if edge == "panorama" and (down[0] < 0 or down[1] > size[1]):  # across a pole lies the other half of the row
        return Region.of((0, size[0]), clip_span(down, size[1], "reflect"))
    window = window or Region.whole(size)
    return Region.of(clip_span(across, size[0], edge, window.across), clip_span(down, size[1], edge, window.down))


def _find_span(places: list[float], radius: float) -> Span:
    low, high = min(places) - radius, max(places) + radius
    if not (low > -_FAR and high < _FAR):  # or no number at all
        return (-_FAR, _FAR)
    return (math.floor(low), math.floor(high) + 1)
