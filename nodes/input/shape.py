"""Shapes from a few numbers, and one closed spline."""

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    RGBA,
    Affine,
    Doc,
    Draw,
    Drawn,
    Field,
    Fraction,
    Image,
    OutlineFill,
    OutlinePlace,
    OutputSocket,
    Pointwise,
    Position,
    Size,
    Slider,
    SplinePoints,
    join_points,
    trace_spline,
)

_DROP = join_points(
    ((0.5, 0.0), (1.0, 0.65, 0.0, -0.2, 0.0, 0.2), (0.5, 1.0, 0.28, 0.0, -0.28, 0.0), (0.0, 0.65, 0.0, 0.2, 0.0, -0.2))
)
"""A drop: one corner and three smooth points, so that both kinds are there to begin with."""


class Shape(Pointwise):
    """Draw a rectangle, an ellipse, a polygon, a star, a line or a spline: a mask, and the same filled with a color.

    The mask is how much of each pixel the shape covers, to 2e-3. All lengths are parts of the picture's height, so the
    shape is the same at every size. The cost does not depend on the softness.

    The points of the spline lie in the box of the shape: 0, 0 is its left top corner and 1, 1 its right bottom one,
    before it turns. So center, size and rotation move the spline like all others; several splines are a `roto`.
    """

    aliases = (
        "beam",
        "rectangle", "ellipse", "circle", "square", "polygon", "star", "line", "box mask", "ellipse mask",
        "shape layer", "vignette mask", "mask", "garbage matte", "rounded rectangle", "triangle", "solid",
        "radial mask", "polygon mask", "power window", "window", "bezier", "spline", "path", "curve", "pen", "b-spline",
        "freeform shape", "triangles mask",
    )  # fmt: skip

    shape: Annotated[
        Literal["rectangle", "ellipse", "polygon", "star", "line", "spline"],
        Doc(
            "Polygon and star have corners at equal angles, the first at the top. A line runs across, with round ends. "
            "The spline goes through points that are dragged in the viewer."
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
    spline: Annotated[
        SplinePoints,
        Doc(
            "A row for each point of the spline, in the box of the shape: x, y, the two tangents as offsets, and a "
            "softness in addition to that of the shape, as a part of the picture's height."
        ),
    ] = _DROP
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

    def takes_passes(self) -> bool:
        return self.shape == "spline"

    def place_spline(self, name: str, size: Size) -> Affine | None:
        """The box of the shape, turned about its center."""
        if self.shape != "spline":
            return None
        (across, down), cosine, sine = self.size, math.cos(self.rotation), math.sin(self.rotation)
        x, y = self.center[0] * size[0], self.center[1] * size[1]
        return (
            cosine * across, -sine * down, x - 0.5 * (cosine * across - sine * down),
            sine * across, cosine * down, y - 0.5 * (sine * across + cosine * down),
        )  # fmt: skip

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        place = self.place_spline("spline", draw.size)
        assert place is not None
        contour, feathers = trace_spline(self.spline, draw.size[1])
        fill = OutlineFill(
            ((contour,),), (OutlinePlace(0, place),), invert=self.invert, feather=self.softness, feathers=feathers
        )
        mask = draw.fill(draw("path_nothing", size=draw.size, result=Field(), overlap={}), [fill])
        return {"out": draw.point("shape_fill", mask=mask, color=self.color), "mask": mask}
