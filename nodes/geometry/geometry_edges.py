from collections.abc import Mapping
from math import ceil, log2
from typing import Annotated, Any

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, OutputSocket, ProxyNote, Slider, Trait, Vector
from ..light._coverage import COVERAGE_AROUND, COVERAGE_REACH

_SEAM = 2.0
"""Width of a bare edge in pixels: one on either side of the seam."""

_FOLLOWED = 13
"""How many pixels away seams of the same line are looked for: those of shaders/lib/seam.glsl, and one to the side."""

_NEAR = 2
"""How many pixels away a seam can be whose line covers a pixel."""


class GeometryEdges(Filter):
    """Find where surfaces end, fold and meet, as lines of any width, from depth, normals and ids.

    It uses those that are linked. Depth: the second difference of 1 / depth along a row or column, relative
    to the nearest of three pixels. 1 / depth is linear on every plane, so that flat surfaces at any angle have no edge;
    between two surfaces it is `1 - near / far`. Normals: the angle between neighbors. Ids: any difference. Lines lie
    on the borders between pixels, smoothed along a contour, so that they are antialiased at every width.
    """

    aliases = (
        "edges from depth", "crease", "wireframe", "depth edges", "normal edges", "outline", "line art", "toon outline",
    )  # fmt: skip
    traits = (Trait.NEEDS_SURFACES,)

    proxy_notes = (
        ProxyNote(("border", "crease", "gap"), "its lines are one or two pixels wide at any size", "look"),
        ProxyNote(("edges",), "its lines are narrower than two pixels of the proxy, and therefore fainter", "look"),
    )

    depth = Field(0.0, doc="Planar depth: the distance along the camera's axis.")
    normal = Vector(0.0, width=3, doc="Normals of surfaces.")
    ids = Field(0.0, doc="Numbers of objects or materials.")
    width: Annotated[
        float,
        Slider(0.0, 20.0, unit="px", minimum=0.0, maximum=1000.0, doc="Width of the lines, the same near and far."),
    ] = 2.0
    depth_amount: Annotated[Fraction, Doc("How strong lines by depth are.")] = 1.0
    depth_threshold: Annotated[
        float,
        Slider(
            0.0,
            0.5,
            unit="ratio",
            minimum=0.0,
            doc="Steps in depth that are a smaller part of the depth make no lines.",
        ),
    ] = 0.05
    crease_amount: Annotated[Fraction, Doc("How strong lines by normals are.")] = 1.0
    crease_threshold: Annotated[
        float, Slider(0.0, 90.0, unit="deg", minimum=0.0, maximum=180.0, doc="Folds with smaller angles make no lines.")
    ] = 35.0
    id_amount: Annotated[Fraction, Doc("How strong lines between ids are.")] = 1.0
    softness: Annotated[
        Fraction,
        Doc(
            "The range above the threshold over which lines gain strength, as a part of the "
            "threshold. Lines wider than 2 pixels are hard."
        ),
    ] = 0.5

    edges = OutputSocket(Field(doc="How much of each pixel lines cover, 0..1."))
    gap = OutputSocket(Field(doc="The step in depth between surfaces, as a part of the depth."))
    crease = OutputSocket(Field(doc="The angle between neighboring normals, in degrees; 180 at the background."))
    border = OutputSocket(Field(doc="1 where two ids meet."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Find seams between pixels, the line through each staircase of seams, and the coverage of a band around it."""
        field = Field()
        normal = self._separate(draw) if draw.is_linked(self.normal) else self.normal
        layers: dict[str, Any] = {"depth": self.depth, "normal": normal, "ids": self.ids}
        differences = draw("geometry_edges_found", **layers, overlap=1, result=Vector(width=3))
        seams = draw(
            "geometry_edges_seams",
            **layers,
            overlap={"depth": 2, "normal": 1, "ids": 1},
            result=Vector(width=3),
            amounts=(self.depth_amount, self.crease_amount, self.id_amount),
            gap=self.depth_threshold,
            crease=self.crease_threshold,
            softness=self.softness,
        )
        right, below = (
            draw(f"geometry_edges_{side}", seams=seams, edge="black", overlap=_FOLLOWED, result=Vector(width=3))
            for side in ("right", "below")
        )
        lines: dict[str, Any] = {"right": right, "below": below}
        runs = draw("geometry_edges_runs", seams=seams, **lines, edge="black", overlap=1, result=Vector(width=3))
        if self.width > _SEAM:
            edges = self._widen(draw, runs, lines)
        else:
            edges = draw(
                "geometry_edges", runs=runs, **lines, edge="black", overlap=_NEAR, result=field, width=self.width
            )
        return {
            "edges": edges,
            "gap": draw.point("geometry_edges_gap", result=field, differences=differences),
            "crease": draw.point("geometry_edges_crease", result=field, differences=differences),
            "border": draw.point("geometry_edges_border", result=field, differences=differences),
        }

    def _separate(self, draw: Draw) -> Drawn:
        """Normals of one surface in each pixel, where a renderer has filtered two of them into one."""
        deep = draw.is_linked(self.depth)
        near = draw.point("geometry_edges_near", self.depth, self.normal, result=Field(), deep=deep)
        coverage = draw(
            "geometry_edges_coverage",
            self.normal,
            near=near,
            overlap=COVERAGE_AROUND,
            result=Vector(width=3),
            crease=self.crease_threshold,
        )
        return draw(
            "geometry_edges_pure",
            self.normal,
            near=near,
            coverage=coverage,
            overlap={"normal": COVERAGE_REACH, "near": COVERAGE_REACH, "coverage": 0},
            result=Vector(width=3),
            deep=deep,
        )

    def _widen(self, draw: Draw, runs: Drawn, lines: Mapping[str, Any]) -> Drawn:
        """What lies within half the width of a line: the nearest seam is found first, in columns and then in a row."""
        reach = ceil(self.width / 2.0) + _NEAR
        columns = draw.point("geometry_edges_seeds", result=Vector(width=2), runs=runs)
        for level in reversed(range(ceil(log2(reach + 1)))):
            columns = draw(
                "geometry_edges_columns", seeds=columns, overlap=(0, 2**level), result=Vector(width=2), reach=2**level
            )
        return draw(
            "geometry_edges_wide",
            runs=runs,
            **lines,
            columns=columns,
            edge="black",
            overlap={"columns": (reach, 0)} | dict.fromkeys(("runs", "right", "below"), reach + _NEAR),
            result=Field(),
            width=self.width,
            reach=reach,
        )
