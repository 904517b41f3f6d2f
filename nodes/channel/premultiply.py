from .._declare import Image, Pointwise, Trait


class Premultiply(Pointwise):
    """Multiply color by alpha, for pictures that came with straight (unassociated) alpha."""

    traits = (Trait.USES_ALPHA,)

    image = Image()
