from typing import Annotated, Literal

from .._declare import (
    CurvePair,
    CurvePairSet,
    Doc,
    Draw,
    Drawn,
    Edge,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    Size,
    Slider,
    Trait,
    Vector,
    curve_pairs_of,
    name_curve_pairs,
)

Point = tuple[float, float]

_PIECES = 4
"""The straight lines that stand for a curve."""


class SplineWarp(Filter):
    """Bend one picture into another along pairs of curves, and dissolve between them: a morph.

    A curve is drawn through three points of a feature in the first picture, and through the same feature in the second.
    In between both lie at a mix of the two places. This is field morphing (Beier and Neely 1992, "Feature-Based Image
    Metamorphosis") by four straight lines for each curve: a pixel keeps its place beside each line, and those places
    are averaged with the weights (length ^ p / (a + distance)) ^ b.
    """

    aliases = (
        "morph", "morphing", "field morphing", "reshape", "warp", "spline morph", "feature warp", "face morph",
        "beier neely", "metamorphosis", "line warp",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    other = Image(0.0, doc="The second picture. Without one, show the first picture alone.")
    amount: Annotated[Fraction, Doc("0 is the first picture, 1 the second.")] = 0.5
    curves: Annotated[CurvePairSet, Doc("Pairs of curves by name.")] = name_curve_pairs(curve_1=CurvePair())
    show: Annotated[
        Literal["both", "first", "second"], Doc("A dissolve by the amount, or one of the pictures alone, bent by it.")
    ] = "both"
    reach: Annotated[
        float,
        Slider(
            0.0, 0.2, unit="height", minimum=0.0, maximum=10.0,
            doc="a: near 0, pixels on a curve follow it exactly; more is smoother.",
        ),
    ] = 0.005  # fmt: skip
    falloff: Annotated[
        float,
        Slider(
            0.5, 3.0, unit="ratio", minimum=0.0, maximum=8.0, doc="b: how much more near curves count than far ones."
        ),
    ] = 2.0
    by_length: Annotated[
        Fraction, Doc("p: whether long curves count more: 0 is no, 1 is in proportion to their length.")
    ] = 0.5
    edge: Annotated[Edge, Doc("What lies outside the pictures.")] = "clamp"

    out = OutputSocket(Image(doc="The picture in between."))

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 and self.show != "second" else None

    def passes(self, draw: Draw) -> Drawn:
        lines = _list_lines(self.curves_on, self.amount, draw.size)
        return draw(
            "spline_warp", self.image, self.other, edge=self.edge, overlap={"ways": 1},
            ways=draw(
                "spline_warp_ways", result=Vector(width=4), lines=draw.table(lines or (0.0,) * 12, 3 * _PIECES),
                count=len(lines) // 12, reach=self.reach, falloff=self.falloff, by_length=self.by_length,
            ),
            amount=self.amount, show=self.show,
        )  # fmt: skip

    @property
    def curves_on(self) -> tuple[CurvePair, ...]:
        """The pairs that count."""
        return tuple(pair for pair in curve_pairs_of(self.curves) if pair.on)


def _list_lines(pairs: tuple[CurvePair, ...], amount: float, size: Size) -> tuple[float, ...]:
    """Three texels for each line, in pixels: in the result, in the first and in the second picture."""
    numbers = list[float]()
    for pair in pairs:
        first, second = (_split_curve(points, size) for points in (pair.points_from, pair.points_to))
        mixed = [
            ((1 - amount) * a + amount * x, (1 - amount) * b + amount * y)
            for (a, b), (x, y) in zip(first, second, strict=True)
        ]
        for piece in range(_PIECES):
            for points in (mixed, first, second):
                numbers += (*points[piece], *points[piece + 1])
    return tuple(numbers)


def _split_curve(points: tuple[Point, Point, Point], size: Size) -> list[Point]:
    """The ends of the lines, on the parabola through three points at 0, 1/2 and 1 (Lagrange)."""
    places = list[Point]()
    for number in range(_PIECES + 1):
        t = number / _PIECES
        weights = ((1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1))
        x, y = (sum(w * point[axis] for w, point in zip(weights, points, strict=True)) for axis in (0, 1))
        places.append((x * size[0], y * size[1]))
    return places
