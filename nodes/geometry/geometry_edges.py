from collections.abc import Mapping
from math import ceil, log2
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, OutputSocket, ProxyNote, Slider, Vector

_SEAM = 2.0
"""Width of a bare edge in pixels: one on either side of the seam."""


class GeometryEdges(Filter):
    """Find where surfaces end, fold and meet, as lines of any width, from depth, normals and ids.

    It uses those that are linked. Depth: the second difference of 1 / depth along a row or column, relative
    to the nearest of three pixels. 1 / depth is linear on every plane, so that flat surfaces at any angle have no edge;
    between two surfaces it is `1 - near / far`. Normals: the angle between neighbors. Ids: any difference. Lines lie on
    the borders between pixels.
    """

    aliases = (
        "edges from depth", "crease", "wireframe", "depth edges", "normal edges", "outline", "line art", "toon outline",
    )  # fmt: skip

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
        field = Field()
        differences = draw("geometry_edges_found", self.depth, self.normal, self.ids, overlap=1, result=Vector(width=3))
        edges = draw.point(
            "geometry_edges",
            result=field,
            found=differences,
            amounts=(self.depth_amount, self.crease_amount, self.id_amount),
            gap=self.depth_threshold,
            crease=self.crease_threshold,
            softness=self.softness,
            cover=min(self.width / _SEAM, 1.0),
        )
        if self.width > _SEAM:
            edges = self._widen(draw, edges)
        return {
            "edges": edges,
            "gap": draw.point("geometry_edges_gap", result=field, found=differences),
            "crease": draw.point("geometry_edges_crease", result=field, found=differences),
            "border": draw.point("geometry_edges_border", result=field, found=differences),
        }

    def _widen(self, draw: Draw, edges: Drawn) -> Drawn:
        """What lies within half the width of a seam, by the distance to the bare edges' contour."""
        beyond = (self.width - _SEAM) / 2.0
        reach = ceil(beyond) + 2
        columns = draw.point("geometry_edges_seeds", result=Vector(width=2), edges=edges)
        for level in reversed(range(ceil(log2(reach + 1)))):
            columns = draw(
                "geometry_edges_columns", seeds=columns, overlap=(0, 2**level), result=Vector(width=2), reach=2**level
            )
        contour = draw(
            "geometry_edges_distance",
            mask=edges,
            columns=columns,
            overlap={"mask": reach + 1, "columns": (reach, 0)},
            result=Field(),
            reach=reach,
        )
        return draw.point("geometry_edges_line", result=Field(), contour=contour, beyond=beyond)
