from .._declare import Image, Pointwise, Trait


class Unpremultiply(Pointwise):
    """Divide color by alpha, so that it is the color of the thing and not of its coverage.

    Where alpha is 0 the color stays as it is.
    """

    traits = (Trait.USES_ALPHA,)

    image = Image()
