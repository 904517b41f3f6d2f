from .._declare import Field, OutputSocket, Pointwise, Vector


class SeparateVector4(Pointwise):
    """Split a vector of four numbers (motion both ways) into its components."""

    aliases = ("separate xyzw", "split xyzw")

    vector = Vector(width=4)

    x = OutputSocket(Field())
    y = OutputSocket(Field())
    z = OutputSocket(Field())
    w = OutputSocket(Field())
