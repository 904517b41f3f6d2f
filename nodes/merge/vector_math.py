from typing import Annotated, Literal

from .._declare import Doc, Field, OutputSocket, Pointwise, Slider, Vector


class VectorMath(Pointwise):
    """Calculate with vectors of three channels: normals, positions, motion. An undefined result is 0."""

    aliases = (
        "vector math", "dot product", "cross product", "normalize", "vector length", "distance", "reflect", "project",
        "vector add", "vector subtract", "scale vector", "vector operation",
    )  # fmt: skip

    a = Vector(0.0)
    operation: Annotated[
        Literal[
            "add", "subtract", "multiply", "divide", "multiply add", "cross", "project", "reflect", "scale",
            "normalize", "absolute", "minimum", "maximum", "floor", "fraction",
        ],
        Doc(
            "Multiply add: a b + c. Project: a onto b. Reflect: a at a surface with the normal b. Scale: a times "
            "`factor`. Normalize: a at length 1. All others work on each channel by itself."
        ),
    ] = "add"  # fmt: skip
    b: Annotated[tuple[float, float, float], Slider(-10.0, 10.0, unit="scene", doc="The second vector.")] = (
        0.0,
        0.0,
        0.0,
    )
    c: Annotated[tuple[float, float, float], Slider(-10.0, 10.0, unit="scene", doc="The third vector.")] = (
        0.0,
        0.0,
        0.0,
    )
    factor: Annotated[float, Slider(-10.0, 10.0, unit="ratio", doc="For scale.")] = 1.0

    out = OutputSocket(Vector(doc="The vector."))
    dot = OutputSocket(Field(doc="The dot product of a and b, whatever the operation."))
    length = OutputSocket(Field(doc="The length of `out`."))
