from typing import Annotated, Literal

from .._declare import Doc, Image, OutputSocket, Points, Pointwise

_STRAIGHT = (0.0, 0.0, 1.0, 1.0)


class Curves(Pointwise):
    """Change tones by curves: one for all channels, then one each for red, green and blue.

    A curve is a monotone cubic through its points (Fritsch and Butland 1984): between two points it never leaves their
    range. Before its first and after its last point it continues with the slope that it has there, so that highlights
    keep their detail. Works on the color without its alpha; alpha stays.
    """

    aliases = (
        "rgb curves", "color curves", "color lookup", "color look up", "luma curve", "tone curve", "channel curves",
        "arbitrary map", "contrast", "s curve", "vector curves",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    space: Annotated[
        Literal["display", "log", "linear"],
        Doc(
            "The horizontal axis of a curve from 0 to 1: sRGB values as in paint programs, stops of "
            "light (ACEScct, 0.41 is middle gray, 1 is 222 times white), or scene light."
        ),
    ] = "display"
    keep_color: Annotated[
        bool, Doc("The curve for all channels changes only the brightness; hue and saturation stay.")
    ] = False
    master: Annotated[Points, Doc("For all channels, before the others.")] = _STRAIGHT
    red: Points = _STRAIGHT
    green: Points = _STRAIGHT
    blue: Points = _STRAIGHT

    def identity(self) -> str | None:
        return "image" if all(curve == _STRAIGHT for curve in (self.master, self.red, self.green, self.blue)) else None
