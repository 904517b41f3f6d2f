from collections.abc import Mapping
from typing import Annotated

from .._declare import CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, ProxyNote, Slider, Vector


class Curvature(Filter):
    """Find ridges and cavities: how strongly surfaces bend toward the viewer and away.

    The mean curvature, half the trace of the shape operator: how much the normal changes from pixel to pixel, relative
    to the change of the position. It is never measured across a gap in depth. On balls it is exactly 1 / radius.
    Positions come from `position`, or from depth and camera. If only normals are linked, the view is taken as parallel,
    and lengths are picture heights.
    """

    aliases = ("edge wear", "cavity", "convexity", "dirt mask", "pointiness", "worn edges", "ridges")

    proxy_notes = (
        ProxyNote(("cavity", "mean", "ridge"), "it compares neighboring pixels, which are farther apart in a proxy"),
    )

    normal = Vector(width=3, doc="Normals of surfaces.")
    position = Vector(0.0, width=3, doc="Positions in the world.")
    depth = Field(0.0, doc="Planar depth: the distance along the camera's axis, in place of positions.")
    camera = CameraSocket(0.0, doc="Without one, normals alone are the camera's own: x right, y up, z toward it.")
    radius: Annotated[
        float,
        Slider(
            0.01,
            10.0,
            unit="scene",
            minimum=0.0,
            doc="The radius of a ball whose curvature gives 1. Larger balls give less.",
        ),
    ] = 0.25
    reach: Annotated[
        float,
        Slider(
            1.0, 10.0, unit="px", minimum=0.0, maximum=100.0, doc="The distance between the pixels that are compared."
        ),
    ] = 1.0

    ridge = OutputSocket(Field(doc="Curvature of ridges, 0..1."))
    cavity = OutputSocket(Field(doc="Curvature of cavities, 0..1."))
    mean = OutputSocket(Field(doc="Mean curvature per unit of length: above 0 on ridges, below 0 in cavities."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Use positions, linked or computed from depth. Without them only normals are compared, as seen by a camera
        that is infinitely far away.
        """
        camera, reach, field = draw.camera(self.camera), max(round(self.reach), 1), Field()
        places = self.position if draw.is_linked(self.position) else None
        if places is None and camera and draw.is_linked(self.depth):
            places = draw.point("curvature_place", self.depth, result=Vector(width=3), rays=camera.inverse)
        if places:
            mean = draw(
                "curvature_found",
                self.normal,
                places=places,
                overlap={"normal": reach, "places": 3 * reach},
                result=field,
                reach=reach,
            )
        else:
            mean = draw(
                "curvature_alone",
                self.normal,
                overlap=reach,
                result=field,
                reach=reach,
                right=camera.right if camera else (1.0, 0.0, 0.0),
                down=camera.down if camera else (0.0, -1.0, 0.0),
                forward=camera.forward if camera else (0.0, 0.0, -1.0),
            )
        ridge, cavity = (
            draw.point("curvature", result=field, mean=mean, radius=radius) for radius in (self.radius, -self.radius)
        )
        return {"ridge": ridge, "cavity": cavity, "mean": mean}
