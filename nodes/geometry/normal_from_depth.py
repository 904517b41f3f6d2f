from collections.abc import Mapping
from typing import Annotated

from .._declare import CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, ProxyNote, Slider, Vector


class NormalFromDepth(Filter):
    """Compute normals from depth and the camera, for renders without a normal pass.

    1 / depth is linear on planes, so that its slopes give the tangent plane. The slopes are measured on that side of
    the pixel where 1 / depth stays linear for two pixels (Wu 2021, "Accurate Normal Reconstruction from Depth Buffer"),
    so that edges stay sharp. `curvature` is the mean curvature per world unit: above 0 where a surface bulges (1 / r on
    a ball), below 0 in hollows. On the background both are 0.
    """

    aliases = ("normals", "create normals", "depth to normal", "normal map", "surface normal")

    proxy_notes = (
        ProxyNote(("curvature", "normal"), "it compares neighboring pixels, which are farther apart in a proxy"),
    )

    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")
    reach: Annotated[
        float,
        Slider(
            1.0,
            8.0,
            unit="px",
            minimum=1.0,
            maximum=64.0,
            doc="The distance between the normals that are compared for the curvature.",
        ),
    ] = 2.0

    normal = OutputSocket(
        Vector(width=3, doc="Normals of length 1 in the axes of the world, on the side of the camera.")
    )
    curvature = OutputSocket(Field())

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        camera = draw.camera(self.camera)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        normal = draw("normal_from_depth", self.depth, edge="black", overlap=2, result=Vector(width=3), rows=rows)
        reach = max(round(self.reach), 1)
        curvature = draw(
            "normal_from_depth_curvature",
            self.depth,
            normal=normal,
            edge="black",
            overlap=reach,
            result=Field(),
            rays=rays,
            reach=reach,
        )
        return {"normal": normal, "curvature": curvature}
