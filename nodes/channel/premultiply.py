from .._declare import Image, Pointwise, Trait


class Premultiply(Pointwise):
    """Multiply color by alpha, for pictures that came with straight (unassociated) alpha."""

    aliases = ("premult", "alpha convert", "associate alpha", "alpha multiply", "multiply alpha")
    traits = (Trait.USES_ALPHA,)

    image = Image()
