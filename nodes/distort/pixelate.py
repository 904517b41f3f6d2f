import math
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, OutputSocket, Slider


class Pixelate(Filter):
    """Show the picture in coarse squares, each the average of the pixels that it covers.

    Pixels at the border of a square count by the part that it covers.
    """

    aliases = ("mosaic", "pixelize", "pixel art", "blocks", "censor", "low resolution", "pixellate", "blocky")

    image = Image()
    out = OutputSocket(follows="image")
    size: Annotated[
        tuple[float, float],
        Slider(1.0, 64.0, unit="px", minimum=0.01, doc="Width and height of a square, at least one pixel."),
    ] = (8.0, 8.0)
    sampling: Annotated[
        Literal["average", "center"],
        Doc(
            "Average keeps the light. Center shows the mean of the middle of each square, an eighth as wide and high "
            "but at least a pixel, which looks like a small picture that was enlarged, with aliasing."
        ),
    ] = "average"

    def identity(self) -> str | None:
        return "image" if max(self.size) <= 1.0 else None

    def passes(self, draw: Draw) -> Drawn:
        wide, high = (max(side, 1.0) for side in self.size)
        grid = (math.ceil(draw.size[0] / wide), math.ceil(draw.size[1] / high))
        # Squares at the far edges are cut off, so each lies up to one side before its part of the picture.
        overlap = (math.ceil(1.5 * wide) + 1, math.ceil(1.5 * high) + 1)
        squares = draw(
            "pixelate_square", self.image, size=grid, overlap=overlap, side=(wide, high), sampling=self.sampling
        )
        return draw("pixelate", squares=squares, overlap=2, side=(wide, high))
