from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket


class Median(Filter):
    """Remove single bright or dark pixels without blurring edges: each channel becomes the median of a small square.

    The median is found by forgetful selection: in a group of more than half of all pixels, neither the largest nor the
    smallest can be the median, so both are dropped (Paeth 1990, McGuire 2008).
    """

    aliases = (
        "rank filter", "despeckle", "denoise", "dust and scratches", "dust bust", "remove noise", "salt and pepper",
        "noise reduction", "minimax",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    window: Annotated[Literal["3x3", "5x5"], Doc("The size of the square.")] = "3x3"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def passes(self, draw: Draw) -> Drawn:
        small = self.window == "3x3"
        return draw("median_3x3" if small else "median_5x5", self.image, edge=self.edge, overlap=1 if small else 2)
