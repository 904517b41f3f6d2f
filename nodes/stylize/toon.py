from typing import Annotated

from .._declare import Image, Pointwise, Slider


class Toon(Pointwise):
    """Paint in few flat tones, as in cartoons: brightness in steps, hue and saturation unchanged.

    Soft quantization (Winnemöller et al. 2006) of the tone, which is the luminance as a display shows it (sRGB).
    Between two steps the tone follows tanh, scaled so that it has no jumps, and so that a sharpness of 0 changes
    nothing. Black and white are steps; brighter light has more steps. Works on the color without its alpha.
    """

    aliases = ("cartoon", "cel shading", "cel shader", "anime", "comic", "toon shader", "cell shading")

    image = Image()
    levels: Annotated[
        float, Slider(2.0, 16.0, unit="count", minimum=2.0, maximum=1024.0, doc="How many steps from black to white.")
    ] = 5.0
    sharpness: Annotated[
        float,
        Slider(0.0, 50.0, unit="ratio", minimum=0.0, doc="0 changes nothing, 10 leaves soft steps, 50 hard ones."),
    ] = 14.0

    def identity(self) -> str | None:
        return "image" if self.sharpness == 0.0 else None
