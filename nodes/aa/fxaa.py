from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, Image, Slider

_REACH = 25
"""How far along an edge its tone is read, in pixels: the steps of the shader's longest search but the last one."""


class Fxaa(Filter):
    """Smooth jagged edges of a finished picture, without any other layer: best after tone mapping.

    FXAA 3.11 Quality (Lottes 2009-2011), written from its white paper. Where the tone changes, the two ends of the step
    are searched along the edge, and the pixel is read from a place across the edge, farther away the nearer the end is.
    Within about 25 degrees of a diagonal it does less; SMAA handles diagonals. The tone is the luminance as a display
    shows it (sRGB); colors are mixed in linear light.
    """

    aliases = ("anti-aliasing", "antialias", "aa", "fast approximate anti-aliasing", "smooth edges", "jaggies")

    image = Image()
    quality: Annotated[
        Literal["low", "medium", "high"],
        Doc("How far and how finely the ends of an edge are searched: the presets 12, 29 and 39."),
    ] = "medium"
    subpixel: Annotated[Fraction, Doc("How much single pixels and fine lines are softened.")] = 0.75
    threshold: Annotated[
        float,
        Slider(
            0.063,
            0.333,
            unit="ratio",
            minimum=0.0,
            maximum=1.0,
            doc="The least contrast of an edge, as a part of the brightest tone around.",
        ),
    ] = 0.166
    threshold_dark: Annotated[
        float,
        Slider(
            0.0,
            0.1,
            unit="ratio",
            minimum=0.0,
            maximum=1.0,
            doc="The least contrast in dark areas; black to white is 1.",
        ),
    ] = 0.0833

    def passes(self, draw: Draw) -> Drawn:
        tone = draw.point("fxaa_tone", self.image, result=Field())
        return draw(
            "fxaa",
            self.image,
            tone=tone,
            overlap={"image": 2, "tone": _REACH},
            quality=self.quality,
            subpixel=self.subpixel,
            threshold=self.threshold,
            threshold_dark=self.threshold_dark,
        )
