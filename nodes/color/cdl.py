from typing import Annotated, Literal

from .._declare import RGBA, Doc, Image, Pointwise, Slider, Trait, Wheel


class Cdl(Pointwise):
    """Grade with a color decision list: slope, offset, power, then saturation. Many programs read and write such lists.

    Each channel becomes `(in * slope + offset) ^ power`. Then saturation moves it away from or toward the Rec.709
    luminance (ASC CDL 1.2, 2009). Works on the color without its alpha; alpha stays. The alphas of the three colors
    have no effect.
    """

    aliases = ("ocio cdl transform", "asc cdl", "color decision list", "slope offset power", "color balance")
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    style: Annotated[
        Literal["no clamp", "asc"],
        Doc(
            "ASC limits light to 0..1 before the power and at the end, as the standard says. No "
            "clamp keeps all light; light below 0 then skips the power, as in OpenColorIO."
        ),
    ] = "no clamp"
    slope: Annotated[RGBA, Wheel(0.5), Doc("Factor on the light, channel by channel.")] = (1.0, 1.0, 1.0, 1.0)
    offset: Annotated[RGBA, Wheel(0.2), Doc("Light added after the slope.")] = (0.0, 0.0, 0.0, 0.0)
    power: Annotated[RGBA, Wheel(0.5), Doc("Above 1 darkens the midtones, below 1 brightens them.")] = (
        1.0,
        1.0,
        1.0,
        1.0,
    )
    saturation: Annotated[
        float,
        Slider(0.0, 2.0, unit="ratio", minimum=0.0, doc="0 is black and white, 1 unchanged, 2 twice as far from gray."),
    ] = 1.0

    def identity(self) -> str | None:
        neutral = all(
            color[:3] == (level, level, level)
            for color, level in ((self.slope, 1.0), (self.offset, 0.0), (self.power, 1.0))
        )
        return "image" if neutral and self.saturation == 1.0 and self.style == "no clamp" else None
