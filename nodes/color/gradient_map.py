from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Fraction, Image, Slider, Stops, ramp_knots
from ._palettes import PALETTES


class GradientMap(Filter):
    """Map brightness to the colors of a ramp: heat vision, false color, duotones.

    The luminance (Rec.709) of the color without its alpha chooses the place on the ramp: `low` is its beginning, `high`
    its end. Alpha is multiplied by the alpha of the ramp. Link a Field to the image to color data.
    """

    aliases = (
        "color ramp", "colorama", "tint", "tritone", "duotone", "pseudo color", "false color", "pseudocolor",
        "tri tone", "cc toner", "gradient", "heat map", "colorize", "colormap",
    )  # fmt: skip

    image = Image()
    palette: Annotated[
        Literal[
            "inferno",
            "viridis",
            "magma",
            "plasma",
            "turbo",
            "ironbow",
            "white hot",
            "black hot",
            "ramp",
        ],
        Doc("A known palette, or the ramp below. The first four are also clear in gray and for color-blind viewers."),
    ] = "inferno"
    ramp: Annotated[Stops, Doc("Your own colors, dark to bright.")] = (
        0.0,
        0.004,
        0.01,
        0.05,
        1.0,
        0.45,
        0.35,
        0.02,
        0.12,
        1.0,
        0.75,
        1.0,
        0.25,
        0.02,
        1.0,
        1.0,
        1.0,
        0.95,
        0.6,
        1.0,
    )
    scale: Annotated[
        Literal["stops", "display", "linear"],
        Doc(
            "The numbers in which the ramp is evenly spaced: stops of light, sRGB values as the "
            "eye sees, or scene light."
        ),
    ] = "stops"
    low: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="scene", minimum=0.0, doc="The luminance where the ramp begins; by stops, at least 0.00001."
        ),
    ] = 0.01
    high: Annotated[float, Slider(0.1, 64.0, unit="scene", minimum=0.0, doc="The luminance where it ends.")] = 16.0
    reverse: Annotated[bool, Doc("Run the ramp the other way round.")] = False
    smooth: Annotated[bool, Doc("Ease in and out of every stop.")] = False
    amount: Annotated[Fraction, Doc("Mix with the input.")] = 1.0

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None

    def resolve_ramp(self) -> tuple[float, ...]:
        """The stops of the palette, or those of the node."""
        return self.ramp if self.palette == "ramp" else PALETTES[self.palette]

    def passes(self, draw: Draw) -> Drawn:
        return draw.point(
            "gradient_map",
            self.image,
            ramp=ramp_knots(self.resolve_ramp()),
            scale=self.scale,
            low=self.low,
            high=self.high,
            reverse=self.reverse,
            smoothed=self.smooth,
            amount=self.amount,
        )
