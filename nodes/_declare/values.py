"""Values: the parameters of a node, and how they are edited."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Annotated, Any, Literal, get_args, get_origin

from msgspec import Struct

from .checks import check_default, check_unit
from .curves import MAX_POINTS
from .items import ItemSet, NamedItem, Scalar
from .rows import SPLINE_ROWS, STROKE_ROWS
from .sockets import glsl_type

Unit = Literal["px", "height", "deg", "EV", "ratio", "count", "s", "scene", "K", "mm"]
"""The unit of a number.

`px`: pixels at full size, scaled with a proxy. `height`: fraction of the picture's height, which GLSL gets in pixels.
A graph may give numbers of either in another unit, such as pixels at a height of 1080.
`deg`: degrees, which GLSL gets in radians. `EV`: photographic stops. `ratio`: a plain factor. `count`: a number of
things. `s`: seconds. `scene`: the scene's own units (radiance, depth). `K`: kelvin, of a color temperature.
`mm`: millimeters, of lenses and sensors.
"""


class Slider(Struct, frozen=True):
    """A number: the range of the slider, the hard range `minimum` to `maximum`, which typing cannot leave, the unit."""

    low: float
    high: float
    unit: Unit
    minimum: float = float("-inf")
    maximum: float = float("inf")
    doc: str = ""


class Doc(Struct, frozen=True):
    """A sentence for the tooltip of a value that has no slider."""

    text: str


Turns = Literal["clockwise", "counterclockwise"]
"""Which way an angle grows."""

Missing = Literal["error", "hold", "nearest", "black"]
"""What a frame of a sequence shows if it has no file."""

Holds = Literal["picture", "render", "table", "scene", "font"]
"""The content of a file: pixels, layers of a render, a color table (.cube, .3dl, ...), meshes (.glb, .obj, ...), or a
font (.ttf, .otf, ...)."""


class Folded(Struct, frozen=True):
    """The value belongs to the mask that many nodes have: interfaces show it only where it is used."""


class File(Struct, frozen=True):
    """The value is the path of a file. `layer` names the value that chooses a layer of it."""

    layer: str = ""
    holds: Holds = "picture"


class OfLayer(Struct, frozen=True):
    """The value is about the layer of a render with a role, such as "depth": a text names the layer, a choice says
    what its numbers mean. `path` is the value with the file of the render.
    """

    role: str
    path: str = "path"


class OfSpace(Struct, frozen=True):
    """The value names a color space of the graph's config."""


class Picks(Struct, frozen=True):
    """The value is a list of names of a cryptomatte, for `pick_ids`. `layer` is the value that chooses the matte."""

    layer: str
    path: str = "path"


class OfItem(Struct, frozen=True):
    """The value is the name of another item beside the one that it belongs to, or empty. Names lead in no circle."""


class OneOf(Struct, frozen=True):
    """The value is one of the names that another text of the node lists, with commas between them, or the number of
    one from 1 to `most`; empty if it is none. In a graph it is a choice among these names.
    """

    names: str
    most: int


class Lines(Struct, frozen=True):
    """The value is a text of several lines: its field in interfaces has room for them."""


class Swatch(Struct, frozen=True):
    """The value is a scene-linear RGBA color, edited with a picker. Components may leave 0..1."""


class Wheel(Struct, frozen=True):
    """The value is a color that balances a picture, and its default is gray: interfaces offer a wheel for it.

    The rim of the wheel is `reach` away from gray, in the numbers of the color.
    """

    reach: float


class Handle(Struct, frozen=True):
    """The value is a position in fractions of the picture, 0,0 at the top left, dragged in the viewer."""


class Dial(Struct, frozen=True):
    """The value is an angle in the plane of the picture, 0 to the right, turned by a dial in the viewer."""

    turns: Turns


class Curve(Struct, frozen=True):
    """The value is a smooth curve through points `x0, y0, x1, y1, ...` with increasing x in 0..1: see `curve_at`.

    `low` and `high` are the range of y in the editor, `minimum` and `maximum` its hard range. The first and the last
    point of a `cyclic` curve are the same place, such as red at both ends of the hues.
    """

    low: float = 0.0
    high: float = 1.0
    minimum: float = float("-inf")
    maximum: float = float("inf")
    cyclic: bool = False


class Spline(Struct, frozen=True):
    """The value is a closed spline: seven numbers for each point, and in files a row. See `splines.py`."""


class Stroke(Struct, frozen=True):
    """The value is the way of a brush: x, y and pressure for each point, and in files a row. See `rows.py`."""


class ColorRamp(Struct, frozen=True):
    """The value is a color ramp of stops `t, r, g, b, a, ...`, scene-linear, sorted by t: see `ramp_at`."""


class ItemKind(Struct, frozen=True, dict=True):
    """A kind of named items: its name, the declarations of its fields, and a sentence about it."""

    name: str
    declarations: tuple[Value, ...]
    doc: str = ""

    @cached_property
    def fields(self) -> Mapping[str, Value]:
        """The declarations of the fields by name."""
        return {value.name: value for value in self.declarations}

    @cached_property
    def defaults(self) -> Mapping[str, Any]:
        """The defaults of the fields by name."""
        return {value.name: value.default for value in self.declarations}

    @cached_property
    def scaled(self) -> tuple[Value, ...]:
        """The fields whose working unit is another one than that of files."""
        return tuple(value for value in self.declarations if value.unit in ("px", "height", "deg"))

    def settings(self, item: NamedItem) -> dict[str, Any]:
        """All fields of an item of this kind by name, set or at their default."""
        return {**self.defaults, **item.fields}


class Items(Struct, frozen=True, dict=True):
    """The value is an `ItemSet` of items of these kinds, each called a `noun`, at most `most`.

    `convert` turns what older versions saved in place of it into a mapping of names to objects; None for anything else.
    """

    kinds: tuple[ItemKind, ...]
    noun: str = "item"
    most: int = 1024
    convert: Callable[[object], Mapping[str, Any] | None] | None = None
    ordered: bool = False
    """True if the order of the items, which is that of their names, makes a difference."""

    @cached_property
    def by_name(self) -> Mapping[str, ItemKind]:
        """The kinds by name."""
        return {kind.name: kind for kind in self.kinds}

    def settings(self, item: NamedItem) -> dict[str, Any]:
        """All fields of an item by name, set or at their default."""
        return self.by_name[item.kind].settings(item)

    def to_working_units(self, items: ItemSet, factor_of: Callable[[Value], float]) -> ItemSet:
        """The items with all fields that have a unit in working units, multiplied by the factor of each field."""
        converted: dict[str, NamedItem] = {}
        for name, item in items.items():
            fields: dict[str, Scalar] = {}
            for value in self.by_name[item.kind].scaled:
                factor, stored = factor_of(value), item.fields.get(value.name, value.default)
                if isinstance(stored, tuple):
                    fields[value.name] = tuple(part * factor for part in stored)
                elif isinstance(stored, int | float):
                    fields[value.name] = stored * factor
            if fields:
                converted[name] = NamedItem.of(item.kind, {**item.fields, **fields})
        return items.replace(converted)


Fraction = Annotated[float, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0)]
RGBA = Annotated[tuple[float, float, float, float], Swatch()]
Position = Annotated[tuple[float, float], Handle()]
PatternOffset = Annotated[
    tuple[float, float], Slider(-500.0, 500.0, unit="px", doc="How far the pattern moves, to the right and down.")
]
PatternPeriod = Annotated[
    tuple[float, float],
    Slider(
        0.0,
        2048.0,
        unit="px",
        minimum=0.0,
        doc="After how many pixels the pattern repeats, across and down; 0 never does.",
    ),
]
PatternLoop = Annotated[
    float,
    Slider(
        0.0, 10.0, unit="ratio", minimum=0.0, doc="After how much evolution the pattern is the same again; 0 is never."
    ),
]
FilePath = Annotated[str, File()]
RenderPath = Annotated[str, File(holds="render")]
TablePath = Annotated[str, File(holds="table")]
ScenePath = Annotated[str, File(holds="scene")]
FontPath = Annotated[str, File(holds="font")]
Prose = Annotated[str, Lines()]
Points = Annotated[tuple[float, ...], Curve()]
Stops = Annotated[tuple[float, ...], ColorRamp()]
SplinePoints = Annotated[tuple[float, ...], Spline()]
StrokePoints = Annotated[tuple[float, ...], Stroke()]
Kernel3x3 = tuple[float, float, float, float, float, float, float, float, float]

ValueType = Literal[
    "float", "int", "bool", "choice", "color", "vector", "matrix", "curve", "ramp", "spline", "stroke", "point",
    "items", "path", "text",
]  # fmt: skip
Plain = Scalar | ItemSet
"""The types of values: JSON scalars, flat lists of numbers, and named items."""

Uniform = float | int | bool | tuple[float, ...]
"""The types of uniforms."""


class Value(Struct, frozen=True):
    """The declaration of one value, read from its annotation."""

    name: str
    type: ValueType
    default: Plain
    length: int = 1
    """How many numbers: of a curve, spline or stroke per point, of a ramp per stop."""
    choices: tuple[str, ...] = ()
    low: float = float("-inf")
    high: float = float("inf")
    minimum: float = float("-inf")
    maximum: float = float("inf")
    unit: str | None = None
    """Its `Unit`; of a length in a graph also pixels at a height, such as `px@1080`."""
    doc: str = ""
    label: str = ""
    """What an interface calls it, if not by its name."""
    layer_by: str = ""
    """The value that picks a layer of this file."""
    holds: Holds = "picture"
    """What a file is expected to be."""
    handle: bool = False
    """True for a position that is dragged in the viewer."""
    wheel: float = 0.0
    """How far from gray the rim of its wheel is, for a color that balances a picture; 0 for others."""
    turns: Turns | Literal[""] = ""
    """Which way it turns, for an angle in the plane of the picture."""
    file: str = ""
    """The value with the path of the render that it is about."""
    role: str = ""
    """What the layer is that it is about."""
    matte: str = ""
    """The value that says of which cryptomatte it lists names."""
    space: bool = False
    """True for the name of a color space."""
    folded: bool = False
    """True if it belongs to the mask that many nodes have: interfaces show it only where it is used."""
    has_lines: bool = False
    """True for a text of several lines."""
    cyclic: bool = False
    """True for a curve whose first and last point are the same place."""
    items: Items | None = None
    """What named items it can hold."""
    names_item: bool = False
    """True for the name of another item beside its own."""
    listed_in: str = ""
    """The text that lists the names that it is one of; it may also be a number up to its `maximum`."""

    @property
    def glsl(self) -> str | None:
        """Its GLSL parameter type, or None where it never reaches a shader."""
        if self.type in ("float", "int", "bool"):
            return self.type
        if self.type in ("color", "vector"):
            return glsl_type(self.length)
        fixed = {"choice": "int", "matrix": "mat3", "curve": f"vec4[{MAX_POINTS}]", "ramp": f"vec4[{2 * MAX_POINTS}]"}
        return fixed.get(self.type)

    @property
    def pixels(self) -> bool:
        """True for the path of a file with pictures."""
        return self.type == "path" and self.holds in ("picture", "render")

    @property
    def wireable(self) -> bool:
        """True if a link may drive it (on a pointwise node)."""
        return self.type in ("float", "int", "bool", "color", "vector")


_FLAGS: Mapping[type, str] = MappingProxyType(
    {Lines: "has_lines", Folded: "folded", OfSpace: "space", OfItem: "names_item"}
)
"""The annotations that only say that something is so, and the field of a Value that is then true."""


def read_value(name: str, hint: Any, default: Any) -> Value:
    """Turn `Annotated[type, Slider(...), ...] = default` into a Value."""
    base, notes = (hint.__origin__, hint.__metadata__) if get_origin(hint) is Annotated else (hint, ())
    facts: dict[str, Any] = {"name": name, "default": default}
    check_default(name, base, default)
    if base in (float, int, bool):
        facts["type"] = base.__name__
    elif get_origin(base) is Literal:
        facts |= {"type": "choice", "choices": get_args(base)}
    elif get_origin(base) is tuple:
        facts |= _tuple_type(name, get_args(base), notes)
    elif base is str:
        facts["type"] = "text"
    elif base is ItemSet:
        facts["type"] = "items"
    else:
        raise TypeError(f"value '{name}': a value cannot have the type {hint!r}")
    for note in notes:
        if isinstance(note, Slider):
            check_unit(name, note.unit, Unit)
            facts |= {key: getattr(note, key) for key in ("low", "high", "minimum", "maximum", "unit")}
            facts["doc"] = note.doc or facts.get("doc", "")
        elif isinstance(note, Doc):
            facts["doc"] = note.text
        elif isinstance(note, Swatch):
            facts["type"] = "color"
        elif isinstance(note, Wheel):
            facts["wheel"] = note.reach
        elif isinstance(note, File):
            facts |= {"type": "path", "layer_by": note.layer, "holds": note.holds}
        elif isinstance(note, OfLayer):
            facts |= {"file": note.path, "role": note.role}
        elif type(note) in _FLAGS:
            facts[_FLAGS[type(note)]] = True
        elif isinstance(note, OneOf):
            facts |= {"listed_in": note.names, "minimum": 1, "maximum": note.most}
        elif isinstance(note, Picks):
            facts |= {"file": note.path, "matte": note.layer}
        elif isinstance(note, Handle):
            facts |= {"handle": True, "low": 0.0, "high": 1.0}
        elif isinstance(note, Dial):
            facts["turns"] = note.turns
        elif isinstance(note, Curve):
            facts |= {key: getattr(note, key) for key in ("low", "high", "minimum", "maximum", "cyclic")}
        elif isinstance(note, Items):
            facts["items"] = note
    return Value(**facts)


def _tuple_type(name: str, parts: tuple[Any, ...], notes: tuple[Any, ...]) -> dict[str, Any]:
    """The type and length of a flat list of numbers: per point or stop where it can be of any length."""
    if Ellipsis not in parts:
        return {"type": "matrix" if len(parts) == 9 else "vector", "length": len(parts)}
    for note in notes:
        if isinstance(note, Curve | ColorRamp):
            return {"type": "curve", "length": 2} if isinstance(note, Curve) else {"type": "ramp", "length": 5}
        if isinstance(note, Spline):
            return {"type": "spline", "length": SPLINE_ROWS.length}
        if isinstance(note, Stroke):
            return {"type": "stroke", "length": STROKE_ROWS.length}
    raise TypeError(f"value '{name}': a list of any length is a Curve, a ColorRamp, a Spline or a Stroke")
