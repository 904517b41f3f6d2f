from typing import Annotated, Literal

from .._declare import RGBA, Doc, Field, Fraction, Image, OutputSocket, Pointwise, Position, Slider


class Ramp(Pointwise):
    """A gradient between two colors: along a line, outward from a point, or around a point like a clock hand."""

    aliases = (
        "gradient", "gradient ramp", "gradient texture", "linear gradient", "radial", "radial gradient",
        "4-color gradient", "color wheel", "four color gradient", "blend texture", "background", "vertical gradient",
    )  # fmt: skip

    shape: Annotated[
        Literal["linear", "radial", "angular"],
        Doc(
            "Linear runs from start to end; radial has its center at start and its rim at end; angular turns clockwise "
            "around start, beginning in the direction of end."
        ),
    ] = "linear"
    start: Annotated[Position, Doc("Where the first color is.")] = (0.0, 0.5)
    end: Annotated[Position, Doc("Where the second color is.")] = (1.0, 0.5)
    first: Annotated[RGBA, Doc("The color at the start, premultiplied.")] = (0.0, 0.0, 0.0, 1.0)
    second: Annotated[RGBA, Doc("The color at the end, premultiplied.")] = (1.0, 1.0, 1.0, 1.0)
    smoothness: Annotated[
        Fraction,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            maximum=1.0,
            doc="0 is a straight line, 1 eases in and out (3t^2 - 2t^3).",
        ),
    ] = 0.0

    out = OutputSocket(Image(doc="The colors."))
    value = OutputSocket(Field(doc="A mask: 0 at the start, 1 at the end."))
