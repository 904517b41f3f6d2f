import math
from typing import Annotated

from .._declare import Dial, Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Slider


class DirectionalBlur(Filter):
    """Blur along a straight line, as if the camera had moved during the exposure.

    Each pixel becomes the mean along the line, which is sampled at least once per pixel (bilinear). The cost grows with
    the length.
    """

    aliases = ("dir blur", "motion blur 2d", "linear blur", "angle blur", "cross blur", "smear", "streak blur")

    image = Image()
    out = OutputSocket(follows="image")
    angle: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="Where the line points: 0 is right, 90 is up."),
        Dial("counterclockwise"),
    ] = 0.0
    length: Annotated[
        float, Slider(0.0, 200.0, unit="px", minimum=0.0, maximum=2000.0, doc="From one end of the line to the other.")
    ] = 40.0
    shift: Annotated[
        float,
        Slider(
            -0.5,
            0.5,
            unit="ratio",
            minimum=-16.0,
            maximum=16.0,
            doc="0 spreads to both sides, 0.5 only in the direction of the line, -0.5 only in the opposite one.",
        ),
    ] = 0.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.length == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        farthest = abs(self.length) * (0.5 + abs(self.shift))
        return draw(
            "directional_blur",
            self.image,
            edge=self.edge,
            overlap=math.ceil(farthest) + 1,
            angle=self.angle,
            spread=self.length,
            shift=self.shift,
        )
