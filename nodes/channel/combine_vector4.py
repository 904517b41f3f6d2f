from .._declare import Field, OutputSocket, Pointwise, Vector


class CombineVector4(Pointwise):
    """Make a vector of four numbers (motion both ways) from its components."""

    aliases = ("combine xyzw", "join xyzw")

    x = Field(0.0)
    y = Field(0.0)
    z = Field(0.0)
    w = Field(0.0)

    vector = OutputSocket(Vector(width=4))
