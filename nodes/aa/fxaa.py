from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, Image, Slider

_REACH = 25
"""How far along an edge its tone is read, in pixels: the steps of the shader's longest search but the last one."""


class Fxaa(Filter):
    """Smooth jagged edges of a finished picture. It needs no other layer, and works best after tone mapping.

    FXAA 3.11 Quality (Lottes 2009-2011), written from its white paper. Where the tone changes in a step, the node
    searches along the edge for both ends of the step. Then it reads the pixel from a place across the edge; the nearer
    an end is, the farther away that place. It does less for edges within about 25 degrees of a diagonal, which SMAA
    smooths too. The tone is the luminance as a display shows it (sRGB); colors are mixed in linear light.
    """

    aliases = ("anti-aliasing", "antialias", "aa", "fast approximate anti-aliasing", "smooth edges", "jaggies")

    image = Image()
    quality: Annotated[
        Literal["low", "medium", "high"],
        Doc("How far and how finely the ends of an edge are searched: the presets 12, 29 and 39 of FXAA."),
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
            doc="The smallest contrast of an edge, as a part of the brightest tone around it.",
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
            doc="The smallest contrast in dark areas; black to white is 1.",
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
