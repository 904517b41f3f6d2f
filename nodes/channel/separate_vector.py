from .._declare import Field, OutputSocket, Pointwise, Vector


class SeparateVector(Pointwise):
    """Split a vector of three numbers (a normal, a position) into its components."""

    aliases = ("separate xyz", "split xyz", "split vector")

    vector = Vector(width=3)

    x = OutputSocket(Field())
    y = OutputSocket(Field())
    z = OutputSocket(Field())
