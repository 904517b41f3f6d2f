from math import ceil
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, Slider, Vector


class Kuwahara(Filter):
    """Remove fine detail like a painter, but keep edges: every pixel becomes the mean of the most even area around it.

    Classic: the quadrant with the least variance (Kuwahara et al. 1976). Generalized: eight soft sectors of a disc,
    which count less the more they vary (Papari et al. 2007). Anisotropic: the disc is stretched along the strokes of
    the picture (Kyprianidis et al. 2009), with polynomial weights (Kyprianidis et al. 2010). Works on straight tones as
    a display shows them (sRGB), which are not limited to 0..1.
    """

    aliases = (
        "oil paint", "painterly", "watercolor", "paint", "anisotropic kuwahara", "brush strokes", "painting", "stylize",
        "artistic",
    )  # fmt: skip

    image = Image()
    kind: Annotated[
        Literal["anisotropic", "generalized", "classic"],
        Doc("Anisotropic paints along edges, generalized in round dabs, classic in squares."),
    ] = "anisotropic"
    radius: Annotated[
        float,
        Slider(
            1.0, 16.0, unit="px", minimum=0.0, maximum=64.0, doc="Size of the brush. The cost grows with its square."
        ),
    ] = 5.0
    sharpness: Annotated[
        float,
        Slider(
            1.0,
            12.0,
            unit="ratio",
            minimum=0.0,
            maximum=12.0,
            doc="How strongly the most even sectors dominate; classic does not use it.",
        ),
    ] = 8.0
    smoothing: Annotated[
        float,
        Slider(
            0.5,
            8.0,
            unit="px",
            minimum=0.0,
            maximum=200.0,
            doc="For anisotropic: sigma over which the directions of strokes are averaged.",
        ),
    ] = 2.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.radius < 0.5 else None

    def passes(self, draw: Draw) -> Drawn:
        tones = draw.point("kuwahara_tones", self.image, result=Vector(width=4))
        if self.kind == "classic":
            radius = ceil(self.radius - 0.5)
            smoothed = draw(
                "kuwahara_quadrants", tones=tones, edge=self.edge, overlap=radius, result=Vector(width=4), radius=radius
            )
        else:
            changes = draw("kuwahara_changes", tones=tones, edge=self.edge, overlap=1, result=Vector(width=3))
            smoothed = draw(
                "kuwahara_sectors",
                tones=tones,
                changes=draw.blur(changes, self.smoothing, self.edge),
                edge=self.edge,
                overlap={"tones": ceil(2.0 * self.radius), "changes": 0},
                result=Vector(width=4),
                kind=self.kind,
                radius=self.radius,
                sharpness=self.sharpness,
            )
        return draw.point("kuwahara", tones=smoothed)
