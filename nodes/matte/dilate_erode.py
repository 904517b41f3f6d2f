import math
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Pixels, ProxyNote, Slider, Socket


class DilateErode(Filter):
    """Grow a matte, or shrink it: every pixel becomes the largest or the smallest one around it.

    This is grey morphology with a flat disc or square. A fraction of a pixel mixes the two nearest whole radii, so that
    a soft edge moves by exactly the radius. It works on every channel by itself.
    """

    aliases = (
        "dilate", "erode", "grow", "shrink", "choke", "spread", "matte choker", "simple choker", "morphology", "expand",
        "contract", "minimax", "filter erode", "erode fast", "erode filter", "dilate erode", "minimum", "maximum",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("out",), "it enlarges single pixels, and a proxy averages small specks away"),)

    image = Image(doc="The matte, or a premultiplied picture.")
    out = OutputSocket(follows="image")
    radius: Annotated[
        float,
        Slider(
            -50.0,
            50.0,
            unit="px",
            minimum=-1000.0,
            maximum=1000.0,
            doc="Above 0 bright areas grow, below 0 they shrink.",
        ),
    ] = 5.0
    shape: Annotated[Literal["circle", "square"], Doc("What a single bright pixel grows to.")] = "circle"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.radius == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        radius = abs(self.radius)
        whole, part = math.floor(radius), radius - math.floor(radius)
        largest = math.ceil(radius)
        margin = (largest, largest)
        padded = draw.pad(self.image, margin, self.edge)
        sense = 1.0 if self.radius > 0.0 else -1.0
        grow = _grow_square if self.shape == "square" else _grow_disc
        grown: Pixels = grow(draw, self.image, padded, largest, largest, sense)
        if part:
            smaller: Pixels = grow(draw, self.image, padded, largest, whole, sense) if whole else self.image
            return draw.point("dilate_erode_mix", smaller=smaller, larger=grown, part=part)
        assert not isinstance(grown, Socket)
        return grown


def _double(draw: Draw, spans: Pixels, axis: int, count: int, sense: float) -> Drawn:
    """The extremes of twice as many pixels in a row: of `count` here and of as many behind them."""
    size = draw.size_of(spans)
    return draw("dilate_erode_double", size=size, spans=spans, axis=axis, count=count, sense=sense)


def _grow_square(draw: Draw, image: Pixels, padded: Pixels, margin: int, radius: int, sense: float) -> Drawn:
    """The extremes in squares: along rows, then along columns.

    Extremes of 1, 2, 4, ... pixels in a row are found from those of half as many, and two of these, which overlap,
    cover any length. So the cost grows with the logarithm of the radius.
    """
    spans, length = padded, 2 * radius + 1
    width, height = draw.size
    for axis, size in ((0, (width, height + 2 * margin)), (1, (width, height))):
        count = 1
        while 2 * count <= length:
            spans = _double(draw, spans, axis, count, sense)
            count *= 2
        spans = draw(
            "dilate_erode_join", size=size, spans=spans, axis=axis, start=margin - radius, count=count,
            total=length, sense=sense,
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
                "dilate_erode_disc", spans=spans, grown=grown, first=rows[0], last=rows[-1], margin=margin,
                radius=radius, count=count, sense=sense,
            )  # fmt: skip
        spans = _double(draw, spans, 0, count, sense)
        count *= 2
    assert not isinstance(grown, Socket)
    return grown
