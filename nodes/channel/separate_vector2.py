from .._declare import Field, Output, Pointwise, Vector


class SeparateVector2(Pointwise):
    """Split a vector of two numbers (uv, a displacement) into its components."""

    vector = Vector(width=2)

    x = Output(Field())
    y = Output(Field())
