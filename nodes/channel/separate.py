from .._declare import Field, Image, Output, Pointwise


class Separate(Pointwise):
    """Split an image into its four channels, as they are (premultiplied)."""

    image = Image()

    red = Output(Field())
    green = Output(Field())
    blue = Output(Field())
    alpha = Output(Field())
