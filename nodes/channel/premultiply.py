from .._declare import Image, Pointwise


class Premultiply(Pointwise):
    """Multiply color by alpha, for pictures that came with straight (unassociated) alpha."""

    image = Image()
