from .._declare import Field, Image, OutputSocket, Pointwise


class Combine(Pointwise):
    """Make a picture from up to four channels, which are taken as they are (premultiplied)."""

    aliases = (
        "combine color", "combine rgb", "combine rgba", "join channels", "channel combiner", "merge channels",
        "set alpha",
    )  # fmt: skip

    red = Field(0.0)
    green = Field(0.0)
    blue = Field(0.0)
    alpha = Field(1.0, doc="Opaque unless linked.")

    out = OutputSocket(Image())
