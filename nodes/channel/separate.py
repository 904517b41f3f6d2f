from .._declare import Field, Image, OutputSocket, Pointwise


class Separate(Pointwise):
    """Split an image into its four channels, as they are (premultiplied)."""

    image = Image()

    red = OutputSocket(Field())
    green = OutputSocket(Field())
    blue = OutputSocket(Field())
    alpha = OutputSocket(Field())
