from .._declare import Image, Pointwise, Trait


class Unpremultiply(Pointwise):
    """Divide color by alpha: the color that an object has itself, however much of the pixel it covers.

    Where alpha is 0 the color stays as it is.
    """

    aliases = (
        "unpremult", "alpha convert", "alpha divide", "divide alpha", "remove color matting", "straight alpha",
        "unassociate alpha",
    )  # fmt: skip
    traits = (Trait.USES_ALPHA,)

    image = Image()
