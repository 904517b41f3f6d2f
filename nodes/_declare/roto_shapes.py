"""Outlines of a rotoscope as named items: closed splines, how each is combined with those before it, and its edge."""

import math
from collections.abc import Mapping
from enum import StrEnum
from typing import Annotated, Any, Literal, NamedTuple, get_type_hints

from msgspec import Struct
from msgspec.structs import fields as fields_of

from .draw import Affine
from .items import ItemSet, NamedItem
from .sockets import Size
from .splines import join_points
from .values import Doc, Fraction, Handle, ItemKind, Items, OfItem, Position, Slider, SplinePoints, read_value

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


_Offset = Annotated[
    tuple[float, float], Slider(-1.0, 1.0, unit="ratio", doc="Moves the shape, in fractions of the picture.")
]
_Turn = Annotated[float, Slider(-180.0, 180.0, unit="deg", doc="Turns it about the pivot, clockwise.")]
_Growth = Annotated[
    tuple[float, float], Slider(0.0, 3.0, unit="ratio", doc="Factor on the size of the shape, about the pivot.")
]
_Pivot = Annotated[tuple[float, float], Handle(), Doc("The point about which it turns and grows.")]
_Parent = Annotated[
    str,
    OfItem(),
    Doc("A transform, a track or a shape whose movement it follows as well; empty if it follows none."),
]


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
    position: _Offset = (0.0, 0.0)
    rotation: _Turn = 0.0
    scale: _Growth = (1.0, 1.0)
    pivot: _Pivot = (0.5, 0.5)
    parent: _Parent = ""
    motion_blur: Annotated[
        bool, Doc("Blur the shape by its own movement, as far as the shutter of the node is open.")
    ] = True
    lifetime: Annotated[Literal["all", "range"], Doc("The frames at which it counts: all, or from first to last.")] = (
        "all"
    )
    first: Annotated[int, Slider(1, 200, unit="count", doc="The first frame of the range.")] = 1
    last: Annotated[int, Slider(1, 200, unit="count", doc="The last frame of the range.")] = 100

    def is_active(self, frame: int) -> bool:
        """True if the outline counts at a frame."""
        return self.on and (self.lifetime == "all" or self.first <= frame <= self.last)


class RotoTransform(Struct, frozen=True):
    """A movement that shapes share. It draws nothing."""

    position: _Offset = (0.0, 0.0)
    rotation: _Turn = 0.0
    scale: _Growth = (1.0, 1.0)
    pivot: _Pivot = (0.5, 0.5)
    parent: _Parent = ""


class RotoTrack(Struct, frozen=True):
    """One or two points that were followed through the frames, such as those of a tracker. It draws nothing."""

    points: Annotated[
        Literal["one", "two"],
        Doc("One point moves what follows it; two turn it and change its size as well."),
    ] = "one"
    first: Annotated[Position, Doc("Where the first point is at a frame: one key for each frame of the track.")] = (
        0.5, 0.5,
    )  # fmt: skip
    first_origin: Annotated[Position, Doc("Where the first point was when the shapes were drawn.")] = (0.5, 0.5)
    second: Annotated[Position, Doc("Where the second point is at a frame.")] = (0.7, 0.5)
    second_origin: Annotated[Position, Doc("Where the second point was when the shapes were drawn.")] = (0.7, 0.5)
    parent: _Parent = ""


def _declare_kind(kind: type[Struct], name: str, doc: str) -> ItemKind:
    hints = get_type_hints(kind, include_extras=True)
    return ItemKind(
        name, tuple(read_value(field.name, hints[field.name], field.default) for field in fields_of(kind)), doc
    )


ROTO_SHAPES = Items(
    (
        _declare_kind(RotoShape, "spline", "A closed curve through points with tangents."),
        _declare_kind(RotoTransform, "transform", "A movement for the shapes whose parent it is."),
        _declare_kind(RotoTrack, "track", "One or two points that shapes follow whose parent it is."),
    ),
    "shape",
    MAX_ROTO_SHAPES,
    ordered=True,
)
"""What a value of outlines can hold."""

RotoShapeSet = Annotated[ItemSet, ROTO_SHAPES]


def roto_shapes_of(items: ItemSet) -> dict[str, RotoShape]:
    """The outlines that a value holds by name, in their order."""
    return {name: RotoShape(**ROTO_SHAPES.settings(item)) for name, item in items.items() if item.kind == "spline"}


class PlacedRotoShape(NamedTuple):
    """An outline, and the map from its points to pixels."""

    shape: RotoShape
    affine: Affine


def place_roto_shapes(items: ItemSet, size: Size) -> dict[str, PlacedRotoShape]:
    """The outlines by name and where they and their parents put them. Angles are in radians."""
    width, height = size
    return {
        name: PlacedRotoShape(shape, _join(_follow_parents(items, name, size), (width, 0.0, 0.0, 0.0, height, 0.0)))
        for name, shape in roto_shapes_of(items).items()
    }


def _follow_parents(items: ItemSet, name: str, size: Size) -> Affine:
    """How pixels of the picture move as an item and all its parents do."""
    moved, followed = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0), set[str]()
    while name in items and name not in followed:
        followed.add(name)
        fields = ROTO_SHAPES.settings(items[name])
        moved = _join(
            _find_track_move(fields, size) if items[name].kind == "track" else _find_move(fields, size), moved
        )
        name = str(fields["parent"])
    return moved


def _join(last: Affine, first: Affine) -> Affine:
    """One map after another."""
    a, b, c, d, e, f = last
    u, v, w, x, y, z = first
    return a * u + b * x, a * v + b * y, a * w + b * z + c, d * u + e * x, d * v + e * y, d * w + e * z + f


def _find_move(fields: Mapping[str, Any], size: Size) -> Affine:
    """How pixels move by a position, a rotation and a scale about a pivot."""
    (width, height), (grow_x, grow_y) = size, fields["scale"]
    cosine, sine = math.cos(fields["rotation"]), math.sin(fields["rotation"])
    pivot_x, pivot_y = fields["pivot"][0] * width, fields["pivot"][1] * height
    left, top = pivot_x + fields["position"][0] * width, pivot_y + fields["position"][1] * height
    across, down = pivot_x * grow_x, pivot_y * grow_y
    return (
        cosine * grow_x, -sine * grow_y, left - cosine * across + sine * down,
        sine * grow_x, cosine * grow_y, top - sine * across - cosine * down,
    )  # fmt: skip


def _find_track_move(fields: Mapping[str, Any], size: Size) -> Affine:
    """How pixels move with one point, or turned and scaled with two: the only such map that takes both along."""
    first, first_origin, second, second_origin = (
        complex(fields[name][0] * size[0], fields[name][1] * size[1])
        for name in ("first", "first_origin", "second", "second_origin")
    )
    turn, apart = complex(1.0), second_origin - first_origin
    if fields["points"] == "two" and abs(apart) > 1e-9:
        turn = (second - first) / apart
    shift = first - turn * first_origin
    return turn.real, -turn.imag, shift.real, turn.imag, turn.real, shift.imag


def name_roto_shapes(**outlines: RotoShape | RotoTransform | RotoTrack) -> ItemSet:
    """The value that holds these outlines, transforms and tracks under these names."""
    kinds = {RotoShape: "spline", RotoTransform: "transform", RotoTrack: "track"}
    named = dict[str, NamedItem]()
    for name, outline in outlines.items():
        kind = kinds[type(outline)]
        defaults = ROTO_SHAPES.by_name[kind].defaults
        parts = {key: part for key, default in defaults.items() if (part := getattr(outline, key)) != default}
        named[name] = NamedItem.of(kind, parts)
    return ItemSet(named)
