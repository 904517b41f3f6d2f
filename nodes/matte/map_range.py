from typing import Annotated, Literal

from .._declare import Doc, Field, OutputSocket, Pointwise, Slider


class MapRange(Pointwise):
    """Map one range of a Field to another: linearly, smoothly, or in steps. It can also only limit the Field.

    A range of length 0 maps everything below its start to the new start, and everything else to the new end.
    """

    aliases = (
        "map range", "remap range", "fit range", "clamp range", "clamp", "rescale", "normalize", "levels for data",
        "linear step", "smoothstep", "set range", "map value",
    )  # fmt: skip

    field = Field()
    from_low: Annotated[float, Slider(-1.0, 1.0, unit="scene", doc="The start of the range that is mapped.")] = 0.0
    from_high: Annotated[float, Slider(0.0, 10.0, unit="scene", doc="The end of the range that is mapped.")] = 1.0
    to_low: Annotated[float, Slider(-1.0, 1.0, unit="scene", doc="What the start becomes.")] = 0.0
    to_high: Annotated[float, Slider(0.0, 10.0, unit="scene", doc="What the end becomes.")] = 1.0
    kind: Annotated[
        Literal["linear", "smooth", "smoother", "steps"],
        Doc("Smooth: 3t^2 - 2t^3. Smoother: 6t^5 - 15t^4 + 10t^3 (Perlin 2002). Both stay inside of the new range."),
    ] = "linear"
    steps: Annotated[
        float, Slider(2.0, 16.0, unit="count", minimum=1.0, maximum=65536.0, doc="How many equal values, for steps.")
    ] = 4.0
    limit: Annotated[bool, Doc("Stay inside of the new range.")] = True

    out = OutputSocket(Field())
