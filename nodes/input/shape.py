from typing import Annotated, Literal

from .._declare import RGBA, Doc, Field, Fraction, Image, OutputSocket, Pointwise, Position, Slider


class Shape(Pointwise):
    """Draw a rectangle, an ellipse, a polygon, a star or a line: a mask, and the same filled with a color.

    The mask is how much of each pixel the shape covers, to 2e-3. All lengths are parts of the picture's height, so the
    shape is the same at every size. The cost does not depend on the softness.
    """

    aliases = (
        "rectangle", "ellipse", "circle", "square", "polygon", "star", "line", "box mask", "ellipse mask",
        "shape layer", "vignette mask", "mask", "garbage matte", "rounded rectangle", "triangle", "solid",
        "radial mask", "polygon mask", "power window", "window",
    )  # fmt: skip

    shape: Annotated[
        Literal["rectangle", "ellipse", "polygon", "star", "line"],
        Doc(
            "Polygon and star have corners at equal angles, the first at the top. A line runs across, with round ends."
        ),
    ] = "rectangle"
    center: Annotated[Position, Doc("The middle of the shape.")] = (0.5, 0.5)
    size: Annotated[
        tuple[float, float],
        Slider(
            0.0, 1.5, unit="height", minimum=0.0, maximum=100.0, doc="Width and height. Of a line: length and width."
        ),
    ] = (0.6, 0.4)
    rotation: Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Turns the shape, clockwise.")] = 0.0
    roundness: Annotated[
        Fraction,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0,
            doc="How round the corners of a rectangle are; 1 is a half circle at the short side.",
        ),
    ] = 0.0  # fmt: skip
    points: Annotated[
        int, Slider(3, 12, unit="count", minimum=3, maximum=64, doc="How many corners a polygon or a star has.")
    ] = 5
    inner: Annotated[
        Fraction,
        Slider(0.1, 1.0, unit="ratio", minimum=0.01, maximum=1.0, doc="Where the inner corners of a star are."),
    ] = 0.4
    softness: Annotated[
        float,
        Slider(
            0.0, 0.5, unit="height", minimum=0.0, maximum=10.0,
            doc="How wide the soft edge is, half of it inside and half outside.",
        ),
    ] = 0.0  # fmt: skip
    invert: Annotated[bool, Doc("Cover everything outside of the shape.")] = False
    color: Annotated[RGBA, Doc("The color of the picture, premultiplied.")] = (1.0, 1.0, 1.0, 1.0)

    out = OutputSocket(Image(doc="The color where the shape is, transparent elsewhere."))
    mask = OutputSocket(Field(doc="How much of each pixel the shape covers, 0..1."))
