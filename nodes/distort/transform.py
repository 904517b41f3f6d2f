import math
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, Position, Slider

_SMALLEST = 1e-3
"""No scale is nearer to 0."""


class Transform(Filter):
    """Move, turn and scale the picture within its frame.

    The picture is scaled, then turned about the pivot, then moved. The filter widens where the picture shrinks, so that
    nothing aliases. Catmull-Rom and Mitchell: Mitchell and Netravali 1988.
    """

    image = Image()
    position: Annotated[tuple[float, float], Slider(
        -500.0, 500.0, unit="px", doc="How far the picture moves, right and down."
    )] = (0.0, 0.0)
    rotation: Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Clockwise.")] = 0.0
    scale: Annotated[tuple[float, float], Slider(
        0.1, 4.0, unit="ratio", doc="Factor on the width and on the height; below 0 mirrors."
    )] = (1.0, 1.0)
    pivot: Annotated[Position, Doc("The point about which the picture turns and grows.")] = (0.5, 0.5)
    direction: Annotated[Literal["forward", "inverse"], Doc("Inverse takes back what forward did.")] = "forward"
    kernel: Annotated[Literal["nearest", "triangle", "catmull-rom", "mitchell", "lanczos"], Doc(
        "Nearest keeps data as it is, triangle is bilinear; Catmull-Rom and Lanczos (3 lobes) are sharp and may ring "
        "around lights, Mitchell is between."
    )] = "triangle"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "black"

    def identity(self) -> str | None:
        still = (self.position, self.rotation, self.scale) == ((0.0, 0.0), 0.0, (1.0, 1.0))
        return "image" if still else None

    def passes(self, draw: Draw) -> Drawn:
        width, height = draw.size
        pivot = (self.pivot[0] * width, self.pivot[1] * height)
        (a, b, c, d), (x, y) = self.backward(pivot)
        return draw(
            "transform", self.image, edge=self.edge, across=(a, b), down=(c, d), start=(x, y), kernel=self.kernel
        )

    def backward(self, pivot: tuple[float, float]) -> tuple[tuple[float, float, float, float], tuple[float, float]]:
        """Where a result pixel lies in the image: a matrix by rows, and what its product with the pixel adds to."""
        wide, high = (math.copysign(max(abs(part), _SMALLEST), part) for part in self.scale)
        cos, sin = math.cos(self.rotation), math.sin(self.rotation)
        matrix = (cos * wide, -sin * high, sin * wide, cos * high)
        moved = (pivot[0] + self.position[0], pivot[1] + self.position[1])
        if self.direction == "inverse":
            pivot, moved = moved, pivot
        else:
            matrix = (cos / wide, sin / wide, -sin / high, cos / high)
        a, b, c, d = matrix
        return matrix, (pivot[0] - a * moved[0] - b * moved[1], pivot[1] - c * moved[0] - d * moved[1])
