from collections.abc import Mapping
from math import ceil, hypot
from typing import Annotated, Any

from .._declare import (
    Doc,
    Draw,
    Drawn,
    Edge,
    Field,
    Filter,
    Image,
    OutputSocket,
    ProxyNote,
    Slider,
    Vector,
    space_pixels,
)

_STEP = 3
"""Pixels that one draw follows an edge: half the window of `canny_follow`."""


class Canny(Filter):
    """Draw edges as clean lines, one pixel wide by default, without faint and short ones.

    Canny 1986 as in OpenCV: blur, Sobel gradient, ridges of the gradient, then hysteresis with two thresholds. It uses
    the tone (luminance as a display shows it, sRGB), in which a step from black to white is 1. Alpha is kept.
    """

    version = 2
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
    width: Annotated[
        float,
        Slider(
            0.0,
            16.0,
            unit="px",
            minimum=0.0,
            maximum=200.0,
            doc="Width of the lines, and distance of the pixels that are compared; 0 is one pixel at any size.",
        ),
    ] = 1.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    out = OutputSocket(Image(doc="White lines on black."))
    lines = OutputSocket(Field(doc="1 on a line, else 0; less on lines that are narrower than a pixel."))

    @classmethod
    def upgrade(cls, version: int, values: dict[str, Any]) -> dict[str, Any]:
        return {"width": 0.0, **values}

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Find ridges, follow weak ones from strong ones a few pixels per draw, then widen the lines.

        A wide line is a square around each pixel of a thin one, drawn along the columns and then along the rows.
        """
        spacing = space_pixels(self.width)
        tone = draw.point("canny_tone", self.image, result=Field())
        gradient = draw(
            "canny_gradient",
            tone=draw.blur(tone, hypot(self.sigma, spacing.sigma), self.edge, precise=True),
            edge=self.edge,
            overlap=spacing.step,
            result=Vector(width=2),
            spacing=spacing.step,
            gain=spacing.gain,
        )
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
        lines = draw.point("canny_lines", result=Field(), state=state, cover=min(spacing.gain, 1.0))
        if spacing.step > 1:
            reach, width = spacing.step // 2 + 1, spacing.step
            lines = draw("canny_columns", thin=lines, edge="black", overlap=(0, reach), result=Field(), width=width)
            lines = draw("canny_rows", thin=lines, edge="black", overlap=(reach, 0), result=Field(), width=width)
        return {"out": draw.point("canny", self.image, lines=lines), "lines": lines}
