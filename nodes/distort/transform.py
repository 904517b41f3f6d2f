import math
from typing import Annotated, Literal

from .._declare import Affine, Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Resampling, Slider, Trait

_SMALLEST = 1e-3
"""No scale is nearer to 0."""


class Transform(Filter):
    """Move, rotate, scale and skew the picture within its frame.

    The picture is scaled, then skewed, then rotated around the pivot, then moved. Where the picture shrinks, the filter
    is wider, so that nothing aliases. Several transforms in a row with the same edge work as one, as in Nuke: pixels
    are filtered only once, by the filter of the last one, and what left the frame in between comes back. Catmull-Rom
    and Mitchell: Mitchell and Netravali 1988.
    """

    aliases = (
        "track position", "trackpos", "tracker",
        "move", "translate", "rotate", "scale", "position", "mirror", "flip", "flop", "flip horizontal",
        "flip vertical", "dve", "offset", "shift", "pan", "tile", "motion tile", "camera shake", "transform image",
        "geometry", "turn", "zoom", "reposition", "pivot", "skew", "corner pin", "stabilize 2d", "transform masked",
        "warp stabilizer",
    )  # fmt: skip
    traits = (Trait.RESAMPLES,)

    image = Image()
    out = OutputSocket(follows="image")
    position: Annotated[
        tuple[float, float], Slider(-500.0, 500.0, unit="px", doc="How far the picture moves, to the right and down.")
    ] = (0.0, 0.0)
    rotation: Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Clockwise.")] = 0.0
    scale: Annotated[
        tuple[float, float],
        Slider(0.1, 4.0, unit="ratio", doc="Factor on the width and on the height; below 0 mirrors."),
    ] = (1.0, 1.0)
    skew: Annotated[
        tuple[float, float],
        Slider(
            -60.0,
            60.0,
            unit="deg",
            minimum=-89.0,
            maximum=89.0,
            doc="How far upright edges lean: below the pivot to the right; how far level ones fall to the right.",
        ),
    ] = (0.0, 0.0)
    pivot: Annotated[Position, Doc("The point around which the picture is rotated and scaled.")] = (0.5, 0.5)
    direction: Annotated[Literal["forward", "inverse"], Doc("Inverse undoes what forward did.")] = "forward"
    kernel: Resampling = "triangle"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "black"

    def identity(self) -> str | None:
        values = (self.position, self.rotation, self.scale, self.skew)
        still = values == ((0.0, 0.0), 0.0, (1.0, 1.0), (0.0, 0.0))
        return "image" if still else None

    def passes(self, draw: Draw) -> Drawn:
        width, height = draw.size
        matrix = self.backward((self.pivot[0] * width, self.pivot[1] * height))
        return draw.place(self.image, matrix, self.kernel, self.edge)

    def backward(self, pivot: tuple[float, float]) -> Affine:
        """Where a result pixel lies in the image."""
        wide, high = (math.copysign(max(abs(part), _SMALLEST), part) for part in self.scale)
        cos, sin = math.cos(self.rotation), math.sin(self.rotation)
        lean, fall = (math.tan(part) for part in self.skew)
        moved = (pivot[0] + self.position[0], pivot[1] + self.position[1])
        if self.direction == "inverse":
            pivot, moved = moved, pivot
            a, b = (cos - sin * fall) * wide, (cos * lean - sin) * high
            c, d = (sin + cos * fall) * wide, (sin * lean + cos) * high
        else:
            whole = 1.0 - lean * fall
            wide, high = (part * math.copysign(max(abs(whole), _SMALLEST), whole) for part in (wide, high))
            a = (cos + lean * sin) / wide
            b = (sin - lean * cos) / wide
            c = (-sin - fall * cos) / high
            d = (cos - fall * sin) / high
        return (a, b, pivot[0] - a * moved[0] - b * moved[1], c, d, pivot[1] - c * moved[0] - d * moved[1])
