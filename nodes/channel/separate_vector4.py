from .._declare import Field, Output, Pointwise, Vector


class SeparateVector4(Pointwise):
    """Split a vector of four numbers (motion both ways) into its components."""

    vector = Vector(width=4)

    x = Output(Field())
    y = Output(Field())
    z = Output(Field())
    w = Output(Field())
