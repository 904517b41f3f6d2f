import math
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Slider, Trait


class Bulge(Filter):
    """Enlarge a part of the picture, as a magnifying glass does, or pinch it.

    At the center a strength of 0.5 makes things twice as large, and -1 half as large. Toward the radius the effect
    fades out without a visible border: the image is read at center + distance * (1 - strength (1 - (distance /
    radius)^2)^2).
    """

    aliases = (
        "spherize", "pinch", "fish eye", "fisheye", "magnify", "dent", "punch", "cc lens", "warp", "liquify", "squeeze",
        "implode",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    strength: Annotated[
        float, Slider(-1.0, 0.9, unit="ratio", minimum=-8.0, maximum=0.99, doc="Above 0 bulges, below 0 pinches.")
    ] = 0.5
    radius: Annotated[
        float, Slider(0.0, 1.0, unit="height", minimum=0.0, doc="The radius at which the picture is unchanged.")
    ] = 0.4
    center: Annotated[Position, Doc("The middle of the effect, which does not move.")] = (0.5, 0.5)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.strength == 0.0 or self.radius == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        # x (1 - x^2)^2 is 0.287 at most.
        farthest = 0.287 * abs(self.strength * self.radius)
        return draw(
            "bulge",
            self.image,
            edge=self.edge,
            overlap=math.ceil(farthest) + 2,
            strength=self.strength,
            radius=self.radius,
            center=center,
        )
