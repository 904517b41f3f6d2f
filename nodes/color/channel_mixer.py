from typing import Annotated

from .._declare import Doc, Image, Pointwise, Slider, Trait

_Mix = tuple[float, float, float]


class ChannelMixer(Pointwise):
    """Make every color channel from a mix of red, green and blue.

    `red = red.r * R + red.g * G + red.b * B + constant.r`, and so on. Monochrome makes one gray for all channels
    instead, like black and white film behind a colored filter. The node is linear: the constant is added only as far as
    alpha covers the pixel. Alpha stays.
    """

    aliases = ("channel mix", "mix channels", "rgb mixer", "monochrome mixer", "crosstalk")
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    red: Annotated[_Mix, Slider(-2.0, 2.0, unit="ratio", doc="How much R, G and B go into red.")] = (1.0, 0.0, 0.0)
    green: Annotated[_Mix, Slider(-2.0, 2.0, unit="ratio", doc="How much R, G and B go into green.")] = (0.0, 1.0, 0.0)
    blue: Annotated[_Mix, Slider(-2.0, 2.0, unit="ratio", doc="How much R, G and B go into blue.")] = (0.0, 0.0, 1.0)
    monochrome: Annotated[bool, Doc("Black and white: all three channels become the gray mix.")] = False
    gray: Annotated[
        _Mix,
        Slider(-2.0, 2.0, unit="ratio", doc="How much R, G and B go into gray; by default their luminance (Rec.709)."),
    ] = (0.2126, 0.7152, 0.0722)
    constant: Annotated[_Mix, Slider(-1.0, 1.0, unit="scene", doc="Light added to R, G and B.")] = (0.0, 0.0, 0.0)
    normalized: Annotated[bool, Doc("Divide each mix by its sum, if that is not 0, so that grays stay gray.")] = False

    def identity(self) -> str | None:
        rows = (self.red, self.green, self.blue) == ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        return "image" if rows and not self.monochrome and self.constant == (0.0, 0.0, 0.0) else None
