import math
from typing import Annotated

from .._declare import Dial, Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Slider, Trait


class Swirl(Filter):
    """Rotate the picture around a point, less with the distance from it.

    The rotation falls off as a Gaussian, angle * exp(-(distance / radius)^2), so that no border is visible. The
    opposite angle with the same radius undoes it.
    """

    aliases = ("twirl", "vortex", "twist", "whirl", "spin", "spiral")
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    angle: Annotated[
        float, Slider(-720.0, 720.0, unit="deg", doc="How far the middle turns, clockwise."), Dial("clockwise")
    ] = 180.0
    radius: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="height", minimum=0.0, doc="The distance at which the rotation has fallen to 37 percent."
        ),
    ] = 0.25
    center: Annotated[Position, Doc("The middle of the rotation, which does not move.")] = (0.5, 0.5)
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.angle == 0.0 or self.radius == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        center = (self.center[0] * draw.size[0], self.center[1] * draw.size[1])
        # x exp(-x^2) is 0.429 at most, and an arc no shorter than its chord.
        farthest = 0.429 * abs(self.angle * self.radius)
        return draw(
            "swirl",
            self.image,
            edge=self.edge,
            overlap=math.ceil(farthest) + 2,
            angle=self.angle,
            radius=self.radius,
            center=center,
        )
