from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, OutputSocket, Slider

_REACH = 1.617
"""Sigmas from a Gaussian edge s to where 4 s (1 - s), which is 1 on the edge, has fallen to 0.2, on either side."""


class EdgeMatte(Filter):
    """Make a matte of the edge of another one: 1 on the edge, falling to 0 on both sides.

    It is `4 s (1 - s)` of the blurred matte s. Use it to grade, blur or grain an edge alone.
    """

    aliases = (
        "edge detect matte", "matte edge", "edge mask", "border mask", "rim matte", "edge blur mask", "inline",
        "inside edge", "outside edge", "double edge mask",
    )  # fmt: skip

    matte = Field(doc="A matte, 0..1.")
    width: Annotated[
        float,
        Slider(
            0.25,
            100.0,
            unit="px",
            minimum=0.0,
            maximum=2000.0,
            doc="Width of the edge: the part where the result is above 0.2.",
        ),
    ] = 8.0
    side: Annotated[Literal["both", "inside", "outside"], Doc("Which side of the edge is seen.")] = "both"
    gain: Annotated[
        float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="Factor on the result, which is then limited to 1.")
    ] = 1.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    out = OutputSocket(Field(doc="1 on the edge, 0 away from it."))

    def passes(self, draw: Draw) -> Drawn:
        soft = draw.blur(self.matte, self.width / (2.0 * _REACH), self.edge)
        return draw.point("edge_matte", self.matte, soft=soft, side=self.side, gain=self.gain, result=Field())
