"""Grey morphology with flat discs and squares: see shaders/lib/morphology.glsl."""

import math
from typing import Literal

from .._declare import Draw, Drawn, Edge, Pixels, Socket


def grow(draw: Draw, image: Pixels, radius: float, shape: Literal["circle", "square"], edge: Edge) -> Drawn:
    """Every pixel as the largest one around it; as the smallest one for a radius below 0.

    A fraction of a pixel mixes the two nearest whole radii. The node's GLSL file includes lib/morphology.glsl.
    `radius` must not be 0.
    """
    sense, radius = (1.0 if radius > 0.0 else -1.0), abs(radius)
    whole, part = math.floor(radius), radius - math.floor(radius)
    largest = math.ceil(radius)
    padded = draw.pad(image, (largest, largest), edge)
    grow_shape = _grow_square if shape == "square" else _grow_disc
    grown = grow_shape(draw, image, padded, largest, largest, sense)
    if part:
        smaller: Pixels = grow_shape(draw, image, padded, largest, whole, sense) if whole else image
        return draw.point("morphology_mix", smaller=smaller, larger=grown, part=part)
    return grown


def _double(draw: Draw, spans: Pixels, axis: int, count: int, sense: float) -> Drawn:
    """The extremes of twice as many pixels in a row: of `count` here and of as many behind them."""
    size = draw.size_of(spans)
    return draw("morphology_double", size=size, spans=spans, axis=axis, count=count, sense=sense)


def _grow_square(draw: Draw, image: Pixels, padded: Pixels, margin: int, radius: int, sense: float) -> Drawn:
    """The extremes in squares: along rows, then along columns.

    Extremes of 1, 2, 4, ... pixels in a row are found from those of half as many, and two of these, which overlap,
    cover any length. So the cost grows with the logarithm of the radius.
    """
    spans, length = padded, 2 * radius + 1
    width, height = draw.size_of(image)
    for axis, size in ((0, (width, height + 2 * margin)), (1, (width, height))):
        count = 1
        while 2 * count <= length:
            spans = _double(draw, spans, axis, count, sense)
            count *= 2
        spans = draw(
            "morphology_join", size=size, spans=spans, axis=axis, start=margin - radius, count=count, total=length,
            sense=sense,
        )  # fmt: skip
    assert not isinstance(spans, Socket)
    return spans


def _grow_disc(draw: Draw, image: Pixels, padded: Pixels, margin: int, radius: int, sense: float) -> Drawn:
    """The extremes in discs: a disc is a stack of rows, each covered by two spans of a power of two.

    Rows that need the same spans are joined in one pass, so that there are as many passes as powers of two.
    """
    spans, count, grown = padded, 1, image
    widths = [math.isqrt(radius * radius - row * row) for row in range(radius + 1)]
    while count <= 2 * radius + 1:
        rows = [row for row, width in enumerate(widths) if count <= 2 * width + 1 < 2 * count]
        if rows:
            grown = draw(
                "morphology_disc", spans=spans, grown=grown, first=rows[0], last=rows[-1], margin=margin,
                radius=radius, count=count, sense=sense,
            )  # fmt: skip
        spans = _double(draw, spans, 0, count, sense)
        count *= 2
    assert not isinstance(grown, Socket)
    return grown
