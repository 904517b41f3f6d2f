from typing import Annotated

from .._declare import RGBA, Doc, Field, Fraction, Image, OutputSocket, Pointwise, Slider


class Brick(Pointwise):
    """A wall of bricks in mortar, each with a color of its own between two. Edges are antialiased exactly."""

    aliases = ("brick texture", "bricks", "wall", "tiles", "tile pattern", "grid", "masonry", "brick pattern", "planks")

    width: Annotated[float, Slider(4.0, 512.0, unit="px", minimum=0.01, doc="From one brick to the next in a row.")] = (
        96.0
    )
    height: Annotated[float, Slider(4.0, 512.0, unit="px", minimum=0.01, doc="From one row to the next.")] = 32.0
    mortar: Annotated[
        float, Slider(0.0, 32.0, unit="px", minimum=0.0, maximum=100000.0, doc="How wide the joints are.")
    ] = 4.0
    shift: Annotated[float, Slider(0.0, 1.0, unit="ratio", doc="How far a row is shifted, as a part of a brick.")] = 0.5
    every: Annotated[
        int,
        Slider(
            1,
            8,
            unit="count",
            minimum=1,
            maximum=1000,
            doc="How often a row is shifted: 2 shifts every second row, 3 every third, 1 none.",
        ),
    ] = 2
    first: Annotated[RGBA, Doc("One end of the colors of bricks, premultiplied.")] = (
        0.3,
        0.09,
        0.05,
        1.0,
    )
    second: Annotated[RGBA, Doc("The other end of the colors of bricks, premultiplied.")] = (0.5, 0.2, 0.12, 1.0)
    joint: Annotated[RGBA, Doc("The color of the mortar, premultiplied.")] = (0.45, 0.42, 0.38, 1.0)
    variety: Annotated[Fraction, Doc("How different bricks are: at 0 all have the color midway between the two.")] = 1.0
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives other colors.")] = 0
    offset: Annotated[tuple[float, float], Slider(-256.0, 256.0, unit="px", doc="Moves the wall right and down.")] = (
        0.0,
        0.0,
    )

    out = OutputSocket(Image(doc="The colors."))
    value = OutputSocket(Field(doc="How much of a pixel is brick: 0 in the mortar."))
    random = OutputSocket(Field(doc="A random number of each brick, 0..1."))
