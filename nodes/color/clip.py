from typing import Annotated

from .._declare import Image, OutputSocket, Pointwise, Slider


class Clip(Pointwise):
    """Limit every color channel to a range. Alpha stays; the color is limited without its alpha."""

    aliases = (
        "clamp", "limit", "soft clip", "range limit", "legalize", "broadcast colors", "video limiter", "min max",
        "gamut clip",
    )  # fmt: skip

    image = Image()
    out = OutputSocket(follows="image")
    low: Annotated[float, Slider(0.0, 1.0, unit="scene", doc="The lowest value of a channel.")] = 0.0
    high: Annotated[float, Slider(0.0, 16.0, unit="scene", doc="The highest value of a channel.")] = 1.0
