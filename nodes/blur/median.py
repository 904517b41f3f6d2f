from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image


class Median(Filter):
    """Remove single bright or dark pixels without blurring edges: each channel's middle value of a square.

    By forgetful selection: of more than half of all pixels, the largest and the smallest can never be the median
    (Paeth 1990, McGuire 2008).
    """

    aliases = (
        "rank filter", "despeckle", "denoise", "dust and scratches", "dust bust", "remove noise", "salt and pepper",
        "noise reduction", "minimax",
    )  # fmt: skip

    image = Image()
    window: Annotated[Literal["3x3", "5x5"], Doc("Which neighbors are sorted.")] = "3x3"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def passes(self, draw: Draw) -> Drawn:
        small = self.window == "3x3"
        return draw("median_3x3" if small else "median_5x5", self.image, edge=self.edge, overlap=1 if small else 2)
