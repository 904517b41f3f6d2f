from .._declare import Field, OutputSocket, Pointwise, Vector


class CombineVector(Pointwise):
    """Make a vector of three numbers (a normal, a position) from its components."""

    aliases = ("combine xyz", "make vector", "join xyz")

    x = Field(0.0)
    y = Field(0.0)
    z = Field(0.0)

    vector = OutputSocket(Vector(width=3))
