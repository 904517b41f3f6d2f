"""Outlines of a rotoscope as named items: closed splines, how each is combined with those before it, and its edge."""

import math
from enum import StrEnum
from typing import Annotated, Literal, get_type_hints

from msgspec import Struct
from msgspec.structs import fields as fields_of

from .draw import Affine
from .items import ItemSet, NamedItem
from .sockets import Size
from .splines import join_points
from .values import Doc, Fraction, Handle, ItemKind, Items, Slider, SplinePoints, read_value

MAX_ROTO_SHAPES = 256
"""The most outlines of one node: the texture of their backdrops is at most 16384 texels wide for a picture of 1024."""

_ARM = 4.0 / 3.0 * (2.0**0.5 - 1.0)
"""The tangents of a quarter of a circle of radius 1."""


def make_ellipse(x: float, y: float, width: float, height: float) -> tuple[float, ...]:
    """The spline of an ellipse about a place; all in fractions of the picture."""
    across, down = 0.5 * width, 0.5 * height
    arm_x, arm_y = _ARM * across, _ARM * down
    return join_points(
        (
            (x, y - down, -arm_x, 0.0, arm_x, 0.0),
            (x + across, y, 0.0, -arm_y, 0.0, arm_y),
            (x, y + down, arm_x, 0.0, -arm_x, 0.0),
            (x - across, y, 0.0, arm_y, 0.0, -arm_y),
        )
    )


class RotoMode(StrEnum):
    """How an outline is combined with those before it."""

    UNION = "union"
    SUBTRACT = "subtract"
    INTERSECT = "intersect"
    MAX = "max"
    MIN = "min"
    DIFFERENCE = "difference"
    PLUS = "plus"


class RotoShape(Struct, frozen=True):
    """One closed spline with all of its fields."""

    points: Annotated[
        SplinePoints,
        Doc("A row for each point: x, y, the two tangents as offsets, and a feather in addition to that of the shape."),
    ] = make_ellipse(0.5, 0.5, 0.4, 0.5)
    mode: Annotated[
        Literal["union", "subtract", "intersect", "max", "min", "difference", "plus"],
        Doc(
            "How the shape is combined with those before it, by name. Where shapes share an edge, plus leaves no seam. "
            "Difference is what only one of both covers."
        ),
    ] = "union"
    on: Annotated[bool, Doc("Whether the shape counts.")] = True
    opacity: Annotated[Fraction, Doc("How much of the shape counts.")] = 1.0
    feather: Annotated[
        float,
        Slider(
            0.0, 0.3, unit="height", minimum=0.0, maximum=10.0,
            doc="How wide the soft edge is, half of it inside and half outside.",
        ),
    ] = 0.0  # fmt: skip
    invert: Annotated[bool, Doc("Cover everything outside of the shape.")] = False
    position: Annotated[
        tuple[float, float], Slider(-1.0, 1.0, unit="ratio", doc="Moves the shape, in fractions of the picture.")
    ] = (0.0, 0.0)
    rotation: Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Turns it about the pivot, clockwise.")] = 0.0
    scale: Annotated[
        tuple[float, float], Slider(0.0, 3.0, unit="ratio", doc="Factor on the size of the shape, about the pivot.")
    ] = (1.0, 1.0)
    pivot: Annotated[tuple[float, float], Handle(), Doc("The point about which it turns and grows.")] = (
        0.5,
        0.5,
    )
    motion_blur: Annotated[
        bool, Doc("Blur the shape by its own movement, as far as the shutter of the node is open.")
    ] = True
    lifetime: Annotated[Literal["all", "range"], Doc("The frames at which it counts: all, or from first to last.")] = (
        "all"
    )
    first: Annotated[int, Slider(1, 200, unit="count", doc="The first frame of the range.")] = 1
    last: Annotated[int, Slider(1, 200, unit="count", doc="The last frame of the range.")] = 100

    def find_affine(self, size: Size, turn: float) -> Affine:
        """The map from fractions of the picture, as points have them, to its pixels; `turn` is the angle in radians."""
        (width, height), (grow_x, grow_y), cosine, sine = size, self.scale, math.cos(turn), math.sin(turn)
        pivot_x, pivot_y = self.pivot[0] * width, self.pivot[1] * height
        left, top = pivot_x + self.position[0] * width, pivot_y + self.position[1] * height
        across, down = pivot_x * grow_x, pivot_y * grow_y
        return (
            cosine * grow_x * width, -sine * grow_y * height, left - cosine * across + sine * down,
            sine * grow_x * width, cosine * grow_y * height, top - sine * across - cosine * down,
        )  # fmt: skip

    def is_active(self, frame: int) -> bool:
        """True if the outline counts at a frame."""
        return self.on and (self.lifetime == "all" or self.first <= frame <= self.last)


def _declare_kind() -> ItemKind:
    hints = get_type_hints(RotoShape, include_extras=True)
    values = (read_value(field.name, hints[field.name], field.default) for field in fields_of(RotoShape))
    return ItemKind("spline", tuple(values), "A closed curve through points with tangents.")


ROTO_SHAPES = Items((_declare_kind(),), "shape", MAX_ROTO_SHAPES, ordered=True)
"""What a value of outlines can hold."""

RotoShapeSet = Annotated[ItemSet, ROTO_SHAPES]


def roto_shapes_of(items: ItemSet) -> dict[str, RotoShape]:
    """The outlines that a value holds by name, in their order."""
    return {name: RotoShape(**ROTO_SHAPES.settings(item)) for name, item in items.items()}


def name_roto_shapes(**outlines: RotoShape) -> ItemSet:
    """The value that holds these outlines under these names."""
    defaults = ROTO_SHAPES.kinds[0].defaults
    return ItemSet(
        {
            name: NamedItem.of(
                "spline", {key: part for key, default in defaults.items() if (part := getattr(outline, key)) != default}
            )
            for name, outline in outlines.items()
        }
    )
