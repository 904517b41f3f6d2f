from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, Filter, Image, OutputSocket, Pixels, ProxyNote, Slider
from ._diffusion import fill
from ._morphology import grow


class Inpaint(Filter):
    """Fill a part of a picture from what lies around it: remove wires, dust, markers and logos.

    Color diffuses in from the border, as smoothly as possible, without texture. A soft matte blends the filling with
    the picture; color comes only from pixels where the matte is 0.
    """

    aliases = (
        "inpaint", "in paint", "fill hole", "heal", "content aware fill", "wire removal", "dust removal", "dustbust",
        "remove object", "marker removal", "patch", "laplace fill", "rig removal", "remove wire",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("out",), "the pixels that it leaves out are whole ones"),)

    image = Image()
    out = OutputSocket(follows="image")
    hole = Field(0.0, doc="What is filled, 0..1.")
    grow: Annotated[
        float,
        Slider(0.0, 20.0, unit="px", minimum=0.0, maximum=200.0, doc="How far the hole is enlarged first."),
    ] = 0.0
    opaque: Annotated[bool, Doc("Make the filling opaque, also where the picture around it is not.")] = False

    def passes(self, draw: Draw) -> Drawn:
        wide: Pixels = draw.point("inpaint_wide", self.hole)
        if self.grow > 0.0:
            wide = grow(draw, wide, self.grow, "circle", "clamp")
        known = draw.point("inpaint_known", hole=wide, result=Field())
        filled = fill(draw, self.image, known)
        return draw.point("inpaint", self.image, hole=wide, filled=filled, opaque=self.opaque)
