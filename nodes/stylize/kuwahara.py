from math import ceil, floor, log2
from typing import Annotated, Any, Literal

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, Reach, Slider, Vector


class Kuwahara(Filter):
    """Remove fine detail like a painter, but keep edges: every pixel becomes the mean of the most even area around it.

    Classic: the quadrant with the least variance (Kuwahara et al. 1976). Generalized: eight soft sectors of a disc,
    which count less the more they vary (Papari et al. 2007). Anisotropic: the disc is stretched along the strokes of
    the picture (Kyprianidis et al. 2009), with polynomial weights (Kyprianidis et al. 2010). Works on straight tones as
    a display shows them (sRGB), which are not limited to 0..1.
    """

    aliases = (
        "oil paint", "painterly", "watercolor", "paint", "anisotropic kuwahara", "brush strokes", "painting", "stylize",
        "artistic", "smooth anisotropic",
    )  # fmt: skip

    image = Image()
    kind: Annotated[
        Literal["anisotropic", "generalized", "classic"],
        Doc("Anisotropic paints along edges, generalized in round dabs, classic in squares."),
    ] = "anisotropic"
    radius: Annotated[
        float,
        Slider(
            1.0,
            16.0,
            unit="px",
            minimum=0.0,
            maximum=64.0,
            doc="Size of the brush. The cost grows with its square, that of round brushes only up to 16 px.",
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
            smoothed = self._average_sectors(draw, tones)
        return draw.point("kuwahara", tones=smoothed)

    def _average_sectors(self, draw: Draw, tones: Drawn) -> Drawn:
        changes = draw("kuwahara_changes", tones=tones, edge=self.edge, overlap=1, result=Vector(width=3))
        flow = draw.blur(changes, self.smoothing, self.edge, precise=True)
        brush: dict[str, Any] = {"kind": self.kind, "radius": self.radius, "sharpness": self.sharpness}
        reach = ceil(2.0 * self.radius)
        cell = self._find_cell(min(draw.size))
        if cell > 1:
            return self._average_cells(draw, tones, flow, brush, reach, cell)
        return draw(
            "kuwahara_sectors",
            tones=tones,
            changes=flow,
            edge=self.edge,
            overlap={"tones": reach, "changes": 0},
            result=Vector(width=4),
            **brush,
        )

    def _find_cell(self, shorter_side: int) -> int:
        """The side of the cells that are read instead of pixels, a power of two; 1 reads pixels."""
        if self.radius <= _WIDEST_OF_PIXELS:
            return 1
        widest = max(shorter_side / _SIDE_IN_CELLS, 1.0)
        return 2 ** min(ceil(log2(self.radius / _RADIUS_IN_CELLS)), floor(log2(widest)))

    def _average_cells(
        self, draw: Draw, tones: Drawn, flow: Drawn, brush: dict[str, Any], reach: int, cell: int
    ) -> Drawn:
        """Far pixels are read as means and variances of cells, from which those of a sector follow as from pixels."""
        around = ceil(reach / cell) + 1
        padded = draw.pad(tones, (around * cell, around * cell), self.edge)
        means, variances = draw.several(
            "kuwahara_cells",
            (Vector(width=4), Field()),
            tones=padded,
            size=(ceil(padded.size[0] / cell), ceil(padded.size[1] / cell)),
            overlap=Reach.block(cell, cell),
            cell=cell,
        )
        cells = Reach((1.0 / cell, 0.0, around, 0.0, 1.0 / cell, around), (around, around))
        return draw(
            "kuwahara_sectors_of_cells",
            tones=tones,
            changes=flow,
            means=means,
            variances=variances,
            edge=self.edge,
            overlap={"tones": _NEAR + cell, "changes": 0, "means": cells, "variances": cells},
            result=Vector(width=4),
            **brush,
            cell=cell,
            margin=around * cell,
            near=_NEAR,
        )


_WIDEST_OF_PIXELS = 16.0
"""Round brushes up to this radius read every pixel, wider ones only those near the center."""
_RADIUS_IN_CELLS = 8.0
"""The least number of cells along a radius. On the sample at 2160 lines, with a radius of 32 pixels, FLIP between cells
and pixels is 0.007 on average; with half as many cells 0.018, with twice as many 0.002 in twice the time."""
_SIDE_IN_CELLS = 16.0
"""The least number of cells along the shorter side of a picture: a brush that is larger than the picture would else
read cells that hold much of it. In pictures of noise, colors are within 6e-4 of the formula on average; with less than
half as many cells within 3e-3."""
_NEAR = 8
"""How far around the center each pixel is read, where sectors overlap. Half of it: FLIP 0.008 as above."""
