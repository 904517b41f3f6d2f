from typing import Annotated, Literal

from .._declare import Doc, Image, OutputSocket, Pointwise, Slider


class Levels(Pointwise):
    """Stretch the light between a black and a white point, and bend the midtones between them.

    `out = low + (high - low) * ((in - black) / (white - black)) ^ (1 / gamma)` per channel. Values below the black
    point skip the gamma and continue linearly. Works on the color without its alpha; alpha stays.
    """

    aliases = (
        "brightness contrast", "black point", "white point", "input levels", "gamma", "auto contrast", "auto levels",
        "equalize", "stretch", "normalize", "histogram stretch", "set range", "map range", "remap", "fit range",
        "contrast", "remap range", "map value", "individual controls", "luma level", "levels individual controls",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    space: Annotated[
        Literal["linear", "display"], Doc("The unit of the points: scene light, or sRGB values as in paint programs.")
    ] = "linear"
    black: Annotated[float, Slider(0.0, 1.0, unit="scene", doc="What becomes black.")] = 0.0
    white: Annotated[float, Slider(0.0, 4.0, unit="scene", doc="What becomes white.")] = 1.0
    gamma: Annotated[
        float,
        Slider(
            0.2,
            5.0,
            unit="ratio",
            minimum=0.01,
            maximum=100.0,
            doc="Above 1 brightens the midtones, below 1 darkens them.",
        ),
    ] = 1.0
    low: Annotated[float, Slider(0.0, 1.0, unit="scene", doc="The result for black.")] = 0.0
    high: Annotated[float, Slider(0.0, 4.0, unit="scene", doc="The result for white.")] = 1.0
    clip: Annotated[bool, Doc("Limit values beyond the two points to them.")] = False

    def identity(self) -> str | None:
        neutral = (self.black, self.white) == (self.low, self.high) and self.gamma == 1.0 and self.black != self.white
        return "image" if neutral and not self.clip else None
