from typing import Annotated, Literal

from .._declare import Doc, Image, Pointwise

Pick = Annotated[
    Literal[
        "red",
        "green",
        "blue",
        "alpha",
        "luminance",
        "zero",
        "one",
        "other red",
        "other green",
        "other blue",
        "other alpha",
        "other luminance",
    ],
    Doc("Where this channel comes from: a channel of the image or of the other image, or a constant."),
]


class ChannelShuffle(Pointwise):
    """Rearrange channels of one or two pictures. Values are copied as they are, without regard to alpha."""

    aliases = (
        "shuffle", "shuffle copy", "swizzle", "copy channels", "channel copy", "copy", "channel booleans",
        "set channels", "shift channels", "reorder channels", "channel merge", "copy aux", "set matte", "set alpha",
    )  # fmt: skip

    image = Image()
    other = Image(0.0, doc="A second picture to take channels from.")
    red: Pick = "red"
    green: Pick = "green"
    blue: Pick = "blue"
    alpha: Pick = "alpha"

    def identity(self) -> str | None:
        unchanged = (self.red, self.green, self.blue, self.alpha) == ("red", "green", "blue", "alpha")
        return "image" if unchanged else None
