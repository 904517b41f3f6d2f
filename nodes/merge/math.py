from typing import Annotated, Literal

from .._declare import Doc, Field, OutputSocket, Pointwise, Slider

Operation = Literal[
    "add",
    "subtract",
    "multiply",
    "divide",
    "multiply add",
    "power",
    "minimum",
    "maximum",
    "modulo",
    "greater",
    "less",
    "absolute",
    "negate",
    "sign",
    "floor",
    "ceiling",
    "round",
    "fraction",
    "square root",
    "exponential",
    "logarithm",
    "sine",
    "cosine",
    "arc tangent",
    "clamp",
    "remap",
    "smoothstep",
    "mix",
]


class Math(Pointwise):
    """Calculate with Fields and Numbers. An undefined result (a division by 0, a root of a negative number) is 0."""

    aliases = (
        "multiply", "add", "subtract", "divide", "expression", "calculate", "arithmetic", "calculations", "vector math",
        "merge expression", "maths", "power", "min", "max", "modulo", "compound arithmetic", "absolute", "compare",
        "sine", "clamp", "custom tool",
    )  # fmt: skip

    a = Field(0.0)
    operation: Annotated[
        Operation,
        Doc(
            "Multiply add: a b + c. Power: a^b for a above 0. Greater, less: 1 where a is greater"
            " (less) than b. Modulo takes the sign of b. Sine, cosine: of a in radians. Arc "
            "tangent: of a / b, in all four quadrants. Logarithm and exponential: base e. Clamp: "
            "a within b..c. Remap: 0 at a = b, 1 at a = c, linear also beyond. Smoothstep: from 0"
            " to 1 with soft ends. Mix: a (1 - c) + b c."
        ),
    ] = "add"
    b: Annotated[float, Slider(-10.0, 10.0, unit="scene", doc="The second number.")] = 0.0
    c: Annotated[float, Slider(-10.0, 10.0, unit="scene", doc="The third number, for operations that have one.")] = 1.0

    out = OutputSocket(Field())

    def identity(self) -> str | None:
        neutral = {"add": 0.0, "subtract": 0.0, "multiply": 1.0, "divide": 1.0}
        return "a" if neutral.get(self.operation) == self.b else None
