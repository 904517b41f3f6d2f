from typing import Annotated, Literal

from .._declare import RGBA, Doc, Fraction, Image, Pointwise, Slider, Trait, Wheel

_ONE = (1.0, 1.0, 1.0, 1.0)


class ColorBalance(Pointwise):
    """Grade with three color wheels: lift for shadows, gamma for midtones, gain for highlights.

    The formula is that of Blender's Color Balance: lift `l` moves black in sRGB values, `1 + (c - 1)(2 - l)`, gain
    multiplies, and gamma is a power of the light. The three amounts say where the change is seen. Works on the color
    without its alpha; alpha stays. The alphas of the three colors have no effect.
    """

    aliases = (
        "color balance", "lift gamma gain", "color wheels", "three way color corrector", "3 way color", "primaries",
        "color correction", "shadows midtones highlights", "lgg", "color correct", "wheels", "colour balance",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    lift: Annotated[RGBA, Wheel(0.2), Doc("Moves the shadows; 1 changes nothing.")] = _ONE
    gamma: Annotated[RGBA, Wheel(0.5), Doc("Moves the midtones; above 1 is brighter.")] = _ONE
    gain: Annotated[RGBA, Wheel(0.5), Doc("Factor on the sRGB values, which moves the highlights most.")] = _ONE
    shadows: Annotated[Fraction, Doc("How much of the change is seen in the shadows.")] = 1.0
    midtones: Annotated[Fraction, Doc("How much of it is seen in the midtones.")] = 1.0
    highlights: Annotated[Fraction, Doc("How much of it is seen in the highlights.")] = 1.0
    low: Annotated[
        float,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=16.0, doc="The sRGB value where midtones begin."),
    ] = 0.33
    high: Annotated[
        float,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=16.0, doc="The sRGB value where highlights begin."),
    ] = 0.66
    blend: Annotated[
        float,
        Slider(0.0, 0.5, unit="ratio", minimum=0.0, maximum=16.0, doc="How wide the change between them is."),
    ] = 0.25
    show: Annotated[
        Literal["picture", "ranges"], Doc("Show the ranges instead: shadows red, midtones green, highlights blue.")
    ] = "picture"

    def identity(self) -> str | None:
        neutral = all(color[:3] == _ONE[:3] for color in (self.lift, self.gamma, self.gain))
        return "image" if neutral and self.show == "picture" else None
