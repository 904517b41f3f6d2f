from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Trait, Vector


class StMap(Filter):
    """Remap the picture: every pixel of the map holds a position in the picture, from 0 to 1.

    Maps come from lens calibration or from a UV pass of a render. Where neighboring pixels of the map point far apart,
    the area between is averaged. Where the map is NaN, the result is empty.
    """

    aliases = (
        "stmap", "uv map", "map uv", "uv lookup", "texture lookup", "remap", "uv remap", "warp by uv", "coordinates",
        "texture",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    st = Vector(width=2, doc="The position to read: 0 to 1 across the picture; pixel centers are at halves.")
    origin: Annotated[
        Literal["bottom left", "top left"],
        Doc(
            "Which corner is 0, 0: bottom left for renders and most compositors, top left for OpenImageIO and textures."
        ),
    ] = "bottom left"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "black"

    def passes(self, draw: Draw) -> Drawn:
        return draw("st_map", self.image, self.st, edge=self.edge, origin=self.origin)
