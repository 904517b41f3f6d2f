from typing import Annotated, Literal

from .._declare import Doc, Fraction, Image, OutputSocket, Pointwise, Slider


class Posterize(Pointwise):
    """Round the picture to a few levels of light, as in a screen print.

    `round(c (levels - 1)) / (levels - 1)`. Light brighter than 1 gets more levels with the same distance. Works on the
    color without its alpha; alpha stays.
    """

    aliases = ("quantize", "reduce colors", "color steps", "threshold", "banding", "levels of color")

    image = Image()
    out = OutputSocket(follows="image")
    levels: Annotated[
        float,
        Slider(
            2.0, 32.0, unit="count", minimum=2.0, maximum=65536.0, doc="How many levels there are from black to white."
        ),
    ] = 5.0
    space: Annotated[
        Literal["display", "linear"],
        Doc("The numbers in which the levels are evenly spaced: sRGB values, as the eye sees, or scene light."),
    ] = "display"
    channels: Annotated[
        Literal["luminance", "separate"],
        Doc(
            "Luminance rounds how bright a pixel is and keeps its color. Separate rounds red, "
            "green and blue on their own."
        ),
    ] = "luminance"
    amount: Annotated[
        Fraction, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="Mix with the input; link a mask here.")
    ] = 1.0

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None
