from .._declare import Field, OutputSocket, Pointwise, Vector


class CombineVector2(Pointwise):
    """Make a vector of two numbers (uv, a displacement) from its components."""

    aliases = ("combine xy", "make uv", "join xy")

    x = Field(0.0)
    y = Field(0.0)

    vector = OutputSocket(Vector(width=2))
