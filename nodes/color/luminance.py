from typing import Annotated, Literal

from .._declare import Doc, Field, Image, OutputSocket, Pointwise


class Luminance(Pointwise):
    """Make one channel from color: how bright every pixel is, as it looks over black."""

    aliases = (
        "rgb to bw", "black and white", "grayscale", "greyscale", "gray", "desaturate", "luma", "brightness",
        "monochrome", "luminance to alpha",
    )  # fmt: skip

    image = Image()
    measure: Annotated[
        Literal["luminance", "average", "maximum", "minimum"],
        Doc(
            "Luminance is what the eye sees: 0.2126 R + 0.7152 G + 0.0722 B (Rec.709). The others"
            " give all channels the same weight."
        ),
    ] = "luminance"

    out = OutputSocket(Field(doc="In the units of the image."))
