from typing import Annotated, Literal

from .._declare import Doc, Field, Fraction, Image, Pointwise, Slider, Trait


class BrightPass(Pointwise):
    """Keep only the light that should glow: bright pixels, or those in a mask.

    `L` is the brightness of a pixel and `t` the threshold. The color is scaled to the new `L` and keeps its hue. Hard
    keeps `L > t` as it is. Soft subtracts `t`, with a smooth transition by a quadratic knee (KinoBloom, Takahashi
    2015). Clamp keeps everything up to the limit. Exponential keeps `1 - exp(-(L/t)^power)` of the light, power keeps
    `(L/t)^power`; neither has a hard border that could flicker. To choose the light only by a mask, link `mask` and set
    the threshold to 0. Light is measured premultiplied, as it arrives; alpha is kept.
    """

    aliases = (
        "threshold", "highlights", "highlight extract", "extract", "high pass", "luminance threshold",
        "isolate highlights",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS, Trait.USES_ALPHA)

    image = Image()
    mask = Field(1.0, doc="How much of each pixel may glow: emission, a matte.")
    mode: Annotated[Literal["hard", "soft", "clamp", "exponential", "power"], Doc("How bright light is chosen.")] = (
        "soft"
    )
    measure: Annotated[
        Literal["luminance", "maximum"],
        Doc(
            "Luminance is Rec.709. Maximum is of the three channels, so that blue and red lamps count as white ones do."
        ),
    ] = "luminance"
    threshold: Annotated[
        float,
        Slider(0.0, 10.0, unit="scene", minimum=0.0, doc="Light counts as bright above this. Clamp does not use it."),
    ] = 1.0
    knee: Annotated[Fraction, Doc("For soft: the part of the threshold over which light fades in.")] = 0.5
    power: Annotated[
        float,
        Slider(
            0.5, 8.0, unit="ratio", minimum=0.0, maximum=16.0, doc="For exponential and power: how steep the curve is."
        ),
    ] = 2.0
    limit: Annotated[
        float,
        Slider(
            1.0,
            1000.0,
            unit="scene",
            minimum=0.0,
            maximum=65504.0,
            doc="The largest light that counts, to limit suns and noise; 65504 is no limit.",
        ),
    ] = 65504.0
