from typing import Annotated

from .._declare import RGBA, Doc, Fraction, Image, Pointwise, Slider, Wheel


class Grade(Pointwise):
    """Grade shadows, midtones and highlights with lift, gamma, gain and offset.

    Each channel becomes `(in * (gain - lift) + lift + offset) ^ (1 / gamma)`, as Nuke's Grade does with black point 0
    and white point 1: black becomes lift, and white becomes gain. Negative light skips the gamma and stays negative.
    Works on the color without its alpha; alpha stays as it is. The alphas of the four colors have no effect.
    """

    aliases = (
        "color correct", "color correction", "color corrector", "color balance", "lift gamma gain", "three way",
        "color wheels", "primary grade", "brightness contrast", "brightness", "contrast", "gamma", "color gain",
        "gamma pedestal gain", "lumetri color", "color grading", "gain", "offset", "rolloff contrast", "log wheels",
        "black point", "white point", "multiply color", "add color",
    )  # fmt: skip

    image = Image()
    lift: Annotated[RGBA, Wheel(0.2), Doc("What black becomes, while white stays.")] = (0.0, 0.0, 0.0, 0.0)
    gamma: Annotated[RGBA, Wheel(0.5), Doc("Above 1 brightens the midtones, while black and white stay.")] = (
        1.0,
        1.0,
        1.0,
        1.0,
    )
    gain: Annotated[RGBA, Wheel(0.5), Doc("What white becomes, while black stays.")] = (1.0, 1.0, 1.0, 1.0)
    offset: Annotated[RGBA, Doc("Light added everywhere.")] = (0.0, 0.0, 0.0, 0.0)
    amount: Annotated[
        Fraction, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="Mix with the input; link a mask here.")
    ] = 1.0

    def identity(self) -> str | None:
        neutral = all(
            color[:3] == (level, level, level)
            for color, level in ((self.lift, 0.0), (self.gamma, 1.0), (self.gain, 1.0), (self.offset, 0.0))
        )
        return "image" if neutral or self.amount == 0.0 else None
