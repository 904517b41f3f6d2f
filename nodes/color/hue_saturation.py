from typing import Annotated, Literal

from .._declare import Doc, Image, Pointwise, Slider, Trait


class HueSaturation(Pointwise):
    """Rotate all hues on the color wheel, and make colors stronger, paler or brighter.

    Perceptual works in OKLab (Ottosson 2020) and keeps perceived lightness and saturation. Luminance is linear: it
    rotates around the gray axis and keeps the luminance of the working space (Haeberli 1993). HSV (Smith 1978) keeps
    the largest channel, as paint programs do. Alpha stays.
    """

    aliases = (
        "hue shift", "hue correct", "hsv", "hsl", "hsv tool", "hue saturation value", "hue saturation lightness",
        "color balance hls", "change color", "shift hue", "hue rotate", "selective color", "leave color",
        "change to color", "vibrance", "desaturate", "modulate", "hsv adjust",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    mode: Annotated[Literal["perceptual", "luminance", "hsv"], Doc("What stays the same when hues turn.")] = (
        "perceptual"
    )
    hue: Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Above 0 red turns to yellow and green.")] = 0.0
    saturation: Annotated[
        float,
        Slider(0.0, 2.0, unit="ratio", minimum=0.0, doc="0 is black and white, 1 unchanged, 2 twice as far from gray."),
    ] = 1.0
    value: Annotated[float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="Factor on the light.")] = 1.0

    def identity(self) -> str | None:
        return "image" if (self.hue, self.saturation, self.value) == (0.0, 1.0, 1.0) else None
