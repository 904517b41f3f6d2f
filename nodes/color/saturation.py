from typing import Annotated

from .._declare import Image, Pointwise, Slider, Trait


class Saturation(Pointwise):
    """Move colors away from or toward gray. The luminance (Rec.709) stays."""

    aliases = (
        "vibrance", "desaturate", "black and white", "monochrome", "chroma", "color boost", "grayscale",
        "colourfulness",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    saturation: Annotated[
        float,
        Slider(0.0, 2.0, unit="ratio", minimum=0.0, doc="0 is black and white, 1 unchanged, 2 twice as far from gray."),
    ] = 1.0

    def identity(self) -> str | None:
        return "image" if self.saturation == 1.0 else None
