from typing import Annotated

from .._declare import Doc, Fraction, Image, Pointwise, Slider, Trait


class OverExposure(Pointwise):
    """Overexpose: the picture gets brighter, and highlights turn smoothly into white.

    Light is doubled for every stop. The brightest channel p of a pixel is compressed above `start = white (1 -
    shoulder)`, by `start + (white - start) (1 - exp(-(p - start) / (white - start)))`; the others keep their ratio to
    it. The light that is lost by that turns the color to white: by `x / (1 + x)`, where x is `bleach` times the lost
    light over white. Works on the color without its alpha.
    """

    aliases = ("blown highlights", "burn out", "highlight clipping", "blow out", "highlight rolloff")
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT)

    image = Image()
    stops: Annotated[float, Slider(0.0, 6.0, unit="EV", doc="Overexposure in stops: +1 doubles the light.")] = 2.0
    white: Annotated[
        float,
        Slider(
            0.5,
            32.0,
            unit="scene",
            minimum=1e-3,
            maximum=60000.0,
            doc="The most light that film or sensor can hold: 1 for a plain sRGB display, 16 for the view AgX.",
        ),
    ] = 16.0
    shoulder: Annotated[
        Fraction, Doc("Where highlights begin to be compressed: 0 clips, 1 compresses from black on.")
    ] = 0.7
    bleach: Annotated[
        float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="How much highlights lose their color: 0 keeps it.")
    ] = 1.0
