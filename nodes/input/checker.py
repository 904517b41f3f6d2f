from typing import Annotated

from .._declare import RGBA, Doc, Field, Image, OutputSocket, Pointwise, Slider


class Checker(Pointwise):
    """A checkerboard."""

    aliases = (
        "checkerboard", "checker texture", "checker board", "test pattern", "color bars", "uv grid", "grid", "brick",
        "test card",
    )  # fmt: skip

    size: Annotated[float, Slider(1.0, 256.0, unit="px", minimum=0.01, doc="Side of a square.")] = 32.0
    first: Annotated[RGBA, Doc("The color of the square at the offset, premultiplied.")] = (0.05, 0.05, 0.05, 1.0)
    second: Annotated[RGBA, Doc("The color of its neighbors, premultiplied.")] = (0.5, 0.5, 0.5, 1.0)
    offset: Annotated[tuple[float, float], Slider(-256.0, 256.0, unit="px", doc="Moves the board right and down.")] = (
        0.0,
        0.0,
    )

    out = OutputSocket(Image(doc="The colors."))
    value = OutputSocket(Field(doc="A mask: 0 on squares of the first color, 1 on those of the second."))
