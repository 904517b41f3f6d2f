from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, Filter, Image, OutputSocket, ProxyNote, Trait


class DepthMerge(Filter):
    """Combine two pictures by depth: the nearer one is in front, pixel by pixel.

    Where two surfaces cut through each other, the edge is antialiased: 1 / depth is linear on planes, so that the part
    of the pixel on either side is known exactly. The nearer picture is merged over the other one, so that the
    background is seen through glass. A depth of 0, below 0 or infinity is the background.
    """

    aliases = (
        "z combine", "zmerge", "depth combine", "z merge", "depth composite", "deep merge", "zcombine", "z buffer",
        "depth matte", "z comp",
    )  # fmt: skip
    traits = (Trait.USES_ALPHA,)

    proxy_notes = (ProxyNote(("depth",), "it takes the depth of one of two surfaces"),)

    a = Image(doc="A premultiplied picture.")
    a_depth = Field(doc="The depth of `a`.")
    b = Image(doc="The other premultiplied picture.")
    b_depth = Field(doc="The depth of `b`, in the same units.")
    antialias: Annotated[bool, Doc("Antialias the edges where surfaces cut through each other.")] = True

    out = OutputSocket(Image(doc="Both pictures."))
    depth = OutputSocket(Field(doc="The nearer depth."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        out, depth = draw.several(
            "depth_merge", (Image(), Field()), self.a, self.a_depth, self.b, self.b_depth, overlap=1,
            antialias=self.antialias,
        )  # fmt: skip
        return {"out": out, "depth": depth}
