from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Trait


class CornerPin(Filter):
    """Put the corners of the picture on four places, in perspective: for screens, posters and windows in a shot.

    Straight lines stay straight. The opposite stretches what lies between the four places over the whole frame.
    """

    aliases = (
        "corner pin", "cornerpin", "corner positioner", "four point", "perspective", "cc power pin",
        "screen replacement", "quad warp", "homography", "plane track", "distort corners", "keystone", "unpin", "card",
        "cornerpin2d", "vector corner pin", "perspective positioner", "planar transform", "plane track deform",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    top_left: Annotated[Position, Doc("Where the top left corner goes.")] = (0.1, 0.1)
    top_right: Annotated[Position, Doc("Where the top right corner goes.")] = (0.9, 0.1)
    bottom_right: Annotated[Position, Doc("Where the bottom right corner goes.")] = (0.9, 0.9)
    bottom_left: Annotated[Position, Doc("Where the bottom left corner goes.")] = (0.1, 0.9)
    direction: Annotated[
        Literal["pin", "unpin"], Doc("Pin the picture into the places, or stretch what lies between them.")
    ] = "pin"
    kernel: Annotated[
        Literal["nearest", "triangle", "catmull-rom", "mitchell", "lanczos"],
        Doc("How pixels are interpolated. Triangle is bilinear."),
    ] = "catmull-rom"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "black"

    def passes(self, draw: Draw) -> Drawn:
        matrix = _map_square((self.top_left, self.top_right, self.bottom_right, self.bottom_left))
        rows = matrix if self.direction == "unpin" else _invert(matrix)
        return draw(
            "corner_pin", self.image, edge=self.edge, first=rows[:3], second=rows[3:6], third=rows[6:],
            kernel=self.kernel,
        )  # fmt: skip


Point = tuple[float, float]

_SINGULAR = 1e-12
"""An area or a determinant, of places as fractions of the picture, that is 0 but for the rounding of doubles."""


def _map_square(corners: tuple[Point, Point, Point, Point]) -> tuple[float, ...]:
    """The matrix by rows that maps the unit square to a quadrangle (Heckbert 1989). All zeros where there is none."""
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = corners
    across, down = (x1 - x2, y1 - y2), (x3 - x2, y3 - y2)
    skew = (x0 - x1 + x2 - x3, y0 - y1 + y2 - y3)
    area = across[0] * down[1] - down[0] * across[1]
    if abs(area) < _SINGULAR:
        return (0.0,) * 9
    g = (skew[0] * down[1] - down[0] * skew[1]) / area
    h = (across[0] * skew[1] - skew[0] * across[1]) / area
    return (x1 - x0 + g * x1, x3 - x0 + h * x3, x0, y1 - y0 + g * y1, y3 - y0 + h * y3, y0, g, h, 1.0)


def _invert(matrix: tuple[float, ...]) -> tuple[float, ...]:
    """The inverse up to a factor: the adjugate matrix, whose third row is positive inside of the quadrangle."""
    a, b, c, d, e, f, g, h, i = matrix
    inverse = (
        e * i - f * h, c * h - b * i, b * f - c * e,
        f * g - d * i, a * i - c * g, c * d - a * f,
        d * h - e * g, b * g - a * h, a * e - b * d,
    )  # fmt: skip
    determinant = a * inverse[0] + b * inverse[3] + c * inverse[6]
    return tuple(number / determinant for number in inverse) if abs(determinant) > _SINGULAR else (0.0,) * 9
