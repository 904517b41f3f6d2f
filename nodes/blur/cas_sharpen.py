from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Fraction, Image, OutputSocket, Slider, Trait


class CasSharpen(Filter):
    """Sharpen by AMD's FidelityFX CAS: more where contrast is low, little where it is high, so without halos.

    Contrast adaptive sharpening of 3 x 3 pixels (Lottes 2019), each channel by itself. It expects light from 0 to 1,
    after the tone map; above 2 nothing is sharpened. Alpha is kept.
    """

    aliases = (
        "cas", "contrast adaptive sharpening", "fidelityfx", "amd sharpening", "adaptive sharpen", "game sharpen",
        "fsr sharpen", "rcas",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    out = OutputSocket(follows="image")
    sharpness: Annotated[
        Fraction,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="0 is the least that CAS does, 1 the most."),
    ] = 0.5
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def passes(self, draw: Draw) -> Drawn:
        return draw("cas_sharpen", self.image, edge=self.edge, overlap=1, sharpness=self.sharpness)
