from typing import Annotated, Literal

from .._declare import Doc, Fraction, Image, OutputSocket, Pointwise, Slider


class Invert(Pointwise):
    """Turn a picture into its negative.

    `display` is 1 - c of sRGB values (IEC 61966-2-1), the negative that the eye expects. `linear` is 1 - c of light,
    for masks and data. `stops` mirrors brightness around middle gray, 0.18^2 / c, within eight stops of it. Applied
    twice, each gives the picture back. Works on the color without its alpha; alpha stays.
    """

    aliases = ("negative", "invert color", "negate", "inverse", "complement", "invert mask")

    image = Image()
    out = OutputSocket(follows="image")
    space: Annotated[
        Literal["display", "linear", "stops"],
        Doc("The numbers that are inverted: sRGB values, light, or stops around middle gray."),
    ] = "display"
    amount: Annotated[
        Fraction, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="Mix with the input; link a mask here.")
    ] = 1.0

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None
