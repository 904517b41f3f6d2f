from typing import Annotated

from .._declare import RGBA, Doc, Pointwise


class Constant(Pointwise):
    """One color everywhere."""

    aliases = (
        "eyedropper fill",
        "rgb", "color", "solid", "fill", "background", "solid color", "flat color", "color constant", "value", "plain",
        "colour",
    )  # fmt: skip

    color: Annotated[RGBA, Doc("Scene-linear and premultiplied: half-covering white is 0.5, 0.5, 0.5, 0.5.")] = (
        0.18,
        0.18,
        0.18,
        1.0,
    )
