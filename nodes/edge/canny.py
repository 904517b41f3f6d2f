from collections.abc import Mapping
from math import ceil
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, ProxyNote, Slider, Vector

_STEP = 3
"""Pixels that one draw follows an edge: half the window of `canny_follow`."""


class Canny(Filter):
    """Draw edges as clean lines one pixel wide, without faint and short ones.

    Canny 1986 as in OpenCV: blur, Sobel gradient, ridges of the gradient, then hysteresis with two thresholds. It uses
    the tone (luminance as a display shows it, sRGB), in which a step from black to white is 1. Alpha is kept.
    """

    aliases = ("edge detect", "find edges", "edges", "line art", "contours")

    proxy_notes = (ProxyNote(("lines", "out"), "its lines are one or two pixels wide at any size", "look"),)

    image = Image()
    sigma: Annotated[
        float,
        Slider(
            0.0,
            8.0,
            unit="px",
            minimum=0.0,
            maximum=500.0,
            doc="Sigma of the blur that removes noise and fine detail.",
        ),
    ] = 1.0
    low: Annotated[float, Slider(0.0, 1.0, unit="ratio", minimum=0.0, doc="Weaker edges are never drawn.")] = 0.05
    high: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            doc="Stronger edges are always drawn. Edges between the two thresholds are drawn if they touch one.",
        ),
    ] = 0.15
    reach: Annotated[
        float,
        Slider(
            0.0,
            200.0,
            unit="px",
            minimum=0.0,
            maximum=1000.0,
            doc="How far a weak edge is followed from a strong one: at least this many pixels along the line.",
        ),
    ] = 60.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    out = OutputSocket(Image(doc="White lines on black."))
    lines = OutputSocket(Field(doc="1 on a line, else 0."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        tone = draw.blur(draw.point("canny_tone", self.image, result=Field()), self.sigma, self.edge)
        gradient = draw("canny_gradient", tone=tone, edge=self.edge, overlap=1, result=Vector(width=2))
        state = draw(
            "canny_ridge",
            gradient=gradient,
            edge="black",
            overlap=1,
            result=Field(),
            low=min(self.low, self.high),
            high=max(self.low, self.high),
        )
        for _ in range(ceil(self.reach / _STEP)):
            state = draw("canny_follow", state=state, edge="black", overlap=_STEP, result=Field())
        lines = draw.point("canny_lines", result=Field(), state=state)
        return {"out": draw.point("canny", self.image, lines=lines), "lines": lines}
