from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, ProxyNote, Slider, Vector


class HeightToNormal(Filter):
    """Make a normal map from heights: which way a surface faces whose relief is the Field.

    The normal is (-dh/dx, -dh/dy, 1) at length 1, with x right, y up and z toward the viewer.
    """

    aliases = (
        "normal map", "bump", "bump to normal", "height map", "heightmap to normal", "height to normal",
        "normal from height", "relief", "displacement to normal", "slope",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("normal", "color"), "it compares neighboring pixels, which are farther apart"),)

    height = Field(doc="The heights, usually 0..1.")
    depth: Annotated[
        float, Slider(-100.0, 100.0, unit="px", doc="How high a height of 1 is; below 0 white is deep.")
    ] = 10.0
    kernel: Annotated[
        Literal["sobel", "central"],
        Doc("Sobel also averages over three rows, which helps against noise; central compares two neighbors."),
    ] = "sobel"
    green: Annotated[Literal["up", "down"], Doc("Where green points: up as in OpenGL, down as in DirectX.")] = "up"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    normal = OutputSocket(Vector(width=3, doc="The normal, -1..1."))
    color = OutputSocket(Image(doc="The same as the colors of a normal map, 0..1."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        normal = draw(
            "height_to_normal", self.height, edge=self.edge, overlap=1, result=Vector(width=3), depth=self.depth,
            kernel=self.kernel, green=self.green,
        )  # fmt: skip
        return {"normal": normal, "color": draw.point("height_to_normal_color", normal=normal)}
