"""Strokes of a brush as named items: a kind for each tool, and their fields."""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Annotated, Any, Literal, get_type_hints

from msgspec import Struct
from msgspec.structs import fields as fields_of
from msgspec.structs import replace

from .items import ItemSet, NamedItem
from .rows import STROKE_ROWS, Row
from .values import Doc, Fraction, ItemKind, Items, Slider, StrokePoints, Swatch, Value, read_value

MAX_STROKES = 1024
"""The most strokes of one node."""


class PaintTool(StrEnum):
    """What a stroke does to the picture."""

    BRUSH = "brush"
    ERASE = "erase"
    CLONE = "clone"
    REVEAL = "reveal"
    BLUR = "blur"
    SMEAR = "smear"


BrushBlend = Literal[
    "over", "plus", "multiply", "screen", "overlay", "soft light", "color dodge", "color burn", "darken", "lighten",
    "difference", "subtract",
]  # fmt: skip

StrokeSource = Literal["painted", "image", "source"]


class PaintStroke(Struct, frozen=True):
    """One stroke with all of its fields. A field that its tool does not have is at its default here."""

    tool: PaintTool = PaintTool.BRUSH
    points: Annotated[
        StrokePoints, Doc("A row for each point: x and y as fractions of the picture, and the pressure, 1 by default.")
    ] = (0.35, 0.6, 1.0, 0.45, 0.4, 1.0, 0.55, 0.6, 1.0, 0.65, 0.4, 1.0)
    on: Annotated[bool, Doc("Whether the stroke counts.")] = True
    size: Annotated[
        float,
        Slider(
            0.0, 0.5, unit="height", minimum=0.0, maximum=4.0,
            doc="How wide the brush is at a pressure of 1; it is as much narrower as the pressure is lower.",
        ),
    ] = 0.06  # fmt: skip
    hardness: Annotated[
        Fraction,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0,
            doc="The part of the brush that covers fully; from there it fades to its rim. 1 is a sharp rim.",
        ),
    ] = 0.6  # fmt: skip
    opacity: Annotated[Fraction, Doc("How much of the stroke counts.")] = 1.0
    color: Annotated[tuple[float, float, float], Swatch(), Doc("Scene-linear.")] = (1.0, 1.0, 1.0)
    blend: Annotated[BrushBlend, Doc("How the color is combined with the picture, as in `merge`.")] = "over"
    offset: Annotated[
        tuple[float, float],
        Slider(
            -1.0, 1.0, unit="ratio", doc="From what is painted to what is copied there, as fractions of the picture."
        ),
    ] = (0.1, 0.0)
    source: Annotated[
        StrokeSource,
        Doc("What is copied: the picture with the strokes so far, the input `image`, or the input `source`."),
    ] = "painted"
    timing: Annotated[
        Literal["offset", "fixed"],
        Doc("Whether `frame` counts from the current frame, or is the frame itself. Not for what is painted."),
    ] = "offset"
    frame: Annotated[int, Slider(-24, 24, unit="count", doc="The frame of the source: see `timing`.")] = 0
    sigma: Annotated[
        float,
        Slider(
            0.0, 0.05, unit="height", minimum=0.0, maximum=1.0, doc="The standard deviation of the Gaussian blur."
        ),
    ] = 0.01  # fmt: skip
    position: Annotated[
        tuple[float, float], Slider(-1.0, 1.0, unit="ratio", doc="Moves the stroke, in fractions of the picture.")
    ] = (0.0, 0.0)
    lifetime: Annotated[Literal["all", "range"], Doc("The frames at which it counts: all, or from first to last.")] = (
        "all"
    )
    first: Annotated[int, Slider(1, 200, unit="count", doc="The first frame of the range.")] = 1
    last: Annotated[int, Slider(1, 200, unit="count", doc="The last frame of the range.")] = 100

    @property
    def rows(self) -> tuple[Row, ...]:
        """x, y and pressure of each point."""
        return STROKE_ROWS.split(self.points)

    def is_active(self, frame: int) -> bool:
        """True if the stroke counts at a frame."""
        return self.on and (self.lifetime == "all" or self.first <= frame <= self.last)

    def source_frame(self, frame: int) -> int:
        """The frame of its source at a frame."""
        return self.frame if self.timing == "fixed" else frame + self.frame


_SHARED = ("points", "on", "size", "hardness", "opacity", "position", "lifetime", "first", "last")
_COPIES = ("source", "timing", "frame")
_FIELDS: Mapping[PaintTool, tuple[str, ...]] = {
    PaintTool.BRUSH: ("color", "blend"),
    PaintTool.ERASE: (),
    PaintTool.CLONE: ("offset", *_COPIES),
    PaintTool.REVEAL: _COPIES,
    PaintTool.BLUR: ("sigma",),
    PaintTool.SMEAR: (),
}
_DOCS = {
    PaintTool.BRUSH: "Paints a color.",
    PaintTool.ERASE: "Takes the strokes before it away, so that the input is seen.",
    PaintTool.CLONE: "Copies another part of the picture.",
    PaintTool.REVEAL: "Shows another picture, or another frame, at the same place.",
    PaintTool.BLUR: "Blurs the picture.",
    PaintTool.SMEAR: "Drags the picture along, as a finger does wet paint.",
}
_DIFFERENCES: Mapping[PaintTool, Mapping[str, Mapping[str, Any]]] = {
    PaintTool.REVEAL: {
        "source": {
            "choices": ("image", "source"),
            "default": "source",
            "doc": "What is shown: the input `image`, at another frame, or the input `source`.",
        }
    },
    PaintTool.SMEAR: {"opacity": {"doc": "How far what is under the brush is dragged along: 1 is all the way."}},
}


def _declare_kinds() -> tuple[ItemKind, ...]:
    hints = get_type_hints(PaintStroke, include_extras=True)
    declared = {
        field.name: read_value(field.name, hints[field.name], field.default)
        for field in fields_of(PaintStroke)
        if field.name != "tool"
    }

    def declare(tool: PaintTool, name: str) -> Value:
        return replace(declared[name], **_DIFFERENCES.get(tool, {}).get(name, {}))

    return tuple(
        ItemKind(tool.value, tuple(declare(tool, name) for name in declared if name in (*_SHARED, *names)), _DOCS[tool])
        for tool, names in _FIELDS.items()
    )


PAINT_STROKES = Items(_declare_kinds(), "stroke", MAX_STROKES, ordered=True)
"""What a value of strokes can hold."""

PaintStrokeSet = Annotated[ItemSet, PAINT_STROKES]


def paint_strokes_of(items: ItemSet) -> tuple[PaintStroke, ...]:
    """The strokes that a value holds, in the order of their names."""
    return tuple(PaintStroke(PaintTool(item.kind), **PAINT_STROKES.settings(item)) for item in items.values())


def name_paint_strokes(**strokes: PaintStroke) -> ItemSet:
    """The value that holds these strokes under these names."""
    return ItemSet({name: _describe(stroke) for name, stroke in strokes.items()})


def _describe(stroke: PaintStroke) -> NamedItem:
    defaults = PAINT_STROKES.by_name[stroke.tool].defaults
    fields = {name: getattr(stroke, name) for name in defaults}
    return NamedItem.of(stroke.tool.value, {name: part for name, part in fields.items() if part != defaults[name]})


def simplify_stroke(rows: tuple[Row, ...], tolerance: tuple[float, float, float]) -> tuple[Row, ...]:
    """The fewest points of a stroke so that none of those left out is farther from it than the tolerance (Ramer 1972,
    Douglas and Peucker 1973). `tolerance` is how much of x, of y and of the pressure is one unit of that distance.
    """
    across, down, more = tolerance
    places = [(x / across, y / down, pressure / more) for x, y, pressure in rows]
    kept, spans = {0, len(rows) - 1}, [(0, len(rows) - 1)]
    while spans:
        first, last = spans.pop()
        split = _find_farthest(places, first, last)
        if split is not None:
            kept.add(split)
            spans += ((first, split), (split, last))
    return tuple(rows[index] for index in sorted(kept))


def _find_farthest(places: Sequence[tuple[float, float, float]], first: int, last: int) -> int | None:
    """The place that is farthest from the chord between two others, of those that are farther from it than 1."""
    (x0, y0, z0), (x1, y1, z1) = places[first], places[last]
    across, down, more = x1 - x0, y1 - y0, z1 - z0
    square = across * across + down * down + more * more
    farthest, split = 1.0, None
    for index in range(first + 1, last):
        x, y, z = places[index]
        x, y, z = x - x0, y - y0, z - z0
        along = (across * x + down * y + more * z) / square if square > 0.0 else 0.0
        along = 0.0 if along < 0.0 else 1.0 if along > 1.0 else along
        x, y, z = x - along * across, y - along * down, z - along * more
        away = x * x + y * y + z * z
        if away > farthest:
            farthest, split = away, index
    return split
