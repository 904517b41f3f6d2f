from typing import Annotated, Literal

from .._declare import Doc, Image, Pointwise, Slider, Trait

_DAYLIGHT = 6504.0
"""The correlated color temperature of D65, the white of Rec.709 (CIE 15)."""


class WhiteBalance(Pointwise):
    """Make the light of the scene white: enter the color of the light, and gray objects become gray.

    Above 6504 kelvin (the working white, D65) the picture gets warmer, below it colder, as in raw converters. The color
    of the light lies on the Planckian locus (Krystek 1985), which is moved so that it passes through D65. Tint moves
    the color away from the locus: 3000 is a distance of 1 in CIE 1960 uv. The adaptation of the eye is Bradford (Lam
    1985) or CAT16 (Li et al. 2017). Linear: alpha does not matter.
    """

    aliases = (
        "color temperature", "temperature", "tint", "kelvin", "photo filter", "warm", "cool", "auto white balance",
        "warming filter", "cooling filter", "color cast", "auto color",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    temperature: Annotated[
        float,
        Slider(
            2000.0,
            12000.0,
            unit="K",
            minimum=1667.0,
            maximum=15000.0,
            doc="Color temperature of the light in kelvin: candle 1850, bulb 2850, noon 5500, shade 8000.",
        ),
    ] = _DAYLIGHT
    tint: Annotated[
        float,
        Slider(
            -100.0,
            100.0,
            unit="ratio",
            minimum=-100.0,
            maximum=100.0,
            doc="Above 0 the light was green (fluorescent) and the picture gets more magenta; below 0 greener.",
        ),
    ] = 0.0
    method: Annotated[
        Literal["bradford", "cat16"],
        Doc(
            "How the adaptation of the eye is computed. Bradford is the way of ICC profiles; "
            "CAT16 treats saturated blues better."
        ),
    ] = "bradford"

    def identity(self) -> str | None:
        return "image" if self.temperature == _DAYLIGHT and self.tint == 0.0 else None
