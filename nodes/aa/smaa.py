from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, Image, Slider, Vector

_REACH = {"low": (8, 0), "medium": (16, 0), "high": (32, 8), "ultra": (64, 16)}
"""How many pixels the ends of an edge are searched along rows and columns, and along diagonals."""


class Smaa(Filter):
    """Smooth jagged edges of a finished picture, but keep fine detail and corners. It works best after tone mapping.

    SMAA 1x (Jimenez et al. 2012): the stairs of an edge are replaced by slanted lines, and each pixel is mixed by how
    much of it lies on either side of the line. These areas are computed exactly, not read from a table. An edge is a
    step of the tone as a display shows it (sRGB); colors are mixed in linear light.
    """

    aliases = ("anti-aliasing", "antialias", "aa", "morphological anti-aliasing", "smooth edges", "jaggies")

    image = Image()
    quality: Annotated[
        Literal["low", "medium", "high", "ultra"],
        Doc("How far the ends of an edge are searched: 8, 16, 32 or 64 pixels. High and ultra handle diagonals too."),
    ] = "high"
    detection: Annotated[
        Literal["luminance", "color"],
        Doc(
            "What has edges: the luminance, or any color channel, which also finds edges between equally bright colors."
        ),
    ] = "luminance"
    threshold: Annotated[
        float,
        Slider(
            0.02,
            0.3,
            unit="ratio",
            minimum=0.0,
            maximum=1.0,
            doc="The smallest step that counts as an edge; black to white is 1.",
        ),
    ] = 0.1
    contrast: Annotated[
        float,
        Slider(
            1.0,
            8.0,
            unit="ratio",
            minimum=1.0,
            doc="An edge beside another one that is this many times as strong is ignored.",
        ),
    ] = 2.0
    corner_rounding: Annotated[Fraction, Doc("How much sharp corners are rounded: 0 keeps them.")] = 0.25

    def passes(self, draw: Draw) -> Drawn:
        if self.detection == "luminance":
            tone = draw.point("smaa_tone", self.image, result=Field())
            edges = draw(
                "smaa_edges",
                tone=tone,
                overlap=2,
                result=Vector(width=2),
                threshold=self.threshold,
                contrast=self.contrast,
            )
        else:
            tones = draw.point("smaa_tones", self.image, result=Vector(width=3))
            edges = draw(
                "smaa_color_edges",
                tones=tones,
                overlap=2,
                result=Vector(width=2),
                threshold=self.threshold,
                contrast=self.contrast,
            )
        reach, diagonal = _REACH[self.quality]
        weights = draw(
            "smaa_weights",
            edges=edges,
            edge="black",
            overlap=max(reach, diagonal) + 3,
            result=Vector(width=4),
            reach=reach,
            diagonal=diagonal,
            corner_rounding=self.corner_rounding,
        )
        return draw("smaa", self.image, weights=weights, edge="black", overlap=1)
