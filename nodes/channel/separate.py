from .._declare import Field, Image, OutputSocket, Pointwise


class Separate(Pointwise):
    """Split a picture into its four channels, which are given as they are (premultiplied)."""

    aliases = (
        "separate color", "separate rgb", "separate rgba", "split channels", "split rgb", "channel split",
        "extract channel", "channel isolate", "get alpha",
    )  # fmt: skip

    image = Image()

    red = OutputSocket(Field())
    green = OutputSocket(Field())
    blue = OutputSocket(Field())
    alpha = OutputSocket(Field())
