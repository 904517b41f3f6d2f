from .._declare import Field, OutputSocket, Pointwise, Vector


class SeparateVector2(Pointwise):
    """Split a vector of two numbers (uv, a displacement) into its components."""

    aliases = ("separate xy", "split xy", "split uv")

    vector = Vector(width=2)

    x = OutputSocket(Field())
    y = OutputSocket(Field())
