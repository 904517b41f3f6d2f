from .._declare import Field, Output, Pointwise, Vector


class SeparateVector(Pointwise):
    """Split a vector of three numbers (a normal, a position) into its components."""

    vector = Vector(width=3)

    x = Output(Field())
    y = Output(Field())
    z = Output(Field())
