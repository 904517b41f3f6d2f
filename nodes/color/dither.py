from typing import Annotated, Literal

from .._declare import Doc, Image, Pointwise, Slider, Trait


class Dither(Pointwise):
    """Reduce the picture to a few levels without banding: a pattern decides which of two levels a pixel gets.

    `ceil(c (levels - 1) - threshold) / (levels - 1)`. The average stays the same. Blue noise: void and cluster
    (Ulichney 1993). Bayer: 8 x 8, ordered (1973). White: pcg3d (Jarzynski and Olano 2020). As the last node before a
    file of 256 levels it removes banding; with two levels it gives the look of old computers. Works on the color
    without its alpha; alpha stays.
    """

    aliases = ("ordered dither", "bayer", "banding", "deband", "reduce banding")
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    pattern: Annotated[
        Literal["blue noise", "bayer", "white"],
        Doc(
            "Blue noise is the least visible. Bayer looks like a regular weave, white noise like the grain of bad film."
        ),
    ] = "blue noise"
    levels: Annotated[
        float,
        Slider(
            2.0, 256.0, unit="count", minimum=2.0, maximum=65536.0, doc="How many levels there are from black to white."
        ),
    ] = 256.0
    space: Annotated[
        Literal["display", "linear"],
        Doc(
            "The numbers in which the levels are evenly spaced: sRGB values, as files of 8 bits "
            "store them, or scene light."
        ),
    ] = "display"
    size: Annotated[
        float, Slider(1.0, 16.0, unit="px", minimum=0.01, doc="The side of a dot of the pattern, at least one pixel.")
    ] = 1.0
    colored: Annotated[bool, Doc("Another pattern for each of red, green and blue.")] = False
    animate: Annotated[bool, Doc("Another pattern for each frame.")] = False
