from .._declare import Field, OutputSocket, Pointwise, Vector


class SeparateVector2(Pointwise):
    """Split a vector of two numbers (uv, a displacement) into its components."""

    vector = Vector(width=2)

    x = OutputSocket(Field())
    y = OutputSocket(Field())
