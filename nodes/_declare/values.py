"""Values: the parameters of a node, and how they are edited."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args, get_origin

from msgspec import Struct

from .curves import MAX_POINTS
from .lights import LIGHT_NUMBERS
from .sockets import glsl_type

Unit = Literal["px", "height", "deg", "EV", "ratio", "count", "s", "scene"]
"""The unit of a number.

`px`: pixels at full size, scaled with a proxy. `height`: fraction of the picture's height, which GLSL gets in pixels.
A graph may give numbers of either in another unit, such as pixels at a height of 1080.
`deg`: degrees, which GLSL gets in radians. `EV`: photographic stops. `ratio`: a plain factor. `count`: a number of
things. `s`: seconds. `scene`: the scene's own units (radiance, depth).
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

Holds = Literal["picture", "render", "table", "scene"]
"""The content of a file: pixels, layers of a render, a color table (.cube, .3dl, ...), or meshes (.glb, .obj, ...)."""


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


class Swatch(Struct, frozen=True):
    """The value is a scene-linear RGBA color, edited with a picker. Components may leave 0..1."""


class Handle(Struct, frozen=True):
    """The value is a position in fractions of the picture, 0,0 at the top left, dragged in the viewer."""


class Dial(Struct, frozen=True):
    """The value is an angle in the plane of the picture, 0 to the right, turned by a dial in the viewer."""

    turns: Turns


class Curve(Struct, frozen=True):
    """The value is a smooth curve through points `x0, y0, x1, y1, ...` with increasing x in 0..1: see `curve_at`.

    `low` and `high` are the range of y in the editor, `minimum` and `maximum` its hard range.
    """

    low: float = 0.0
    high: float = 1.0
    minimum: float = float("-inf")
    maximum: float = float("inf")


class ColorRamp(Struct, frozen=True):
    """The value is a color ramp of stops `t, r, g, b, a, ...`, scene-linear, sorted by t: see `ramp_at`."""


class Lights(Struct, frozen=True):
    """The value is a list of lights, 16 numbers each: see `Light`."""


Fraction = Annotated[float, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0)]
RGBA = Annotated[tuple[float, float, float, float], Swatch()]
Position = Annotated[tuple[float, float], Handle()]
FilePath = Annotated[str, File()]
RenderPath = Annotated[str, File(holds="render")]
TablePath = Annotated[str, File(holds="table")]
ScenePath = Annotated[str, File(holds="scene")]
Points = Annotated[tuple[float, ...], Curve()]
Stops = Annotated[tuple[float, ...], ColorRamp()]
LightList = Annotated[tuple[float, ...], Lights()]
Kernel3x3 = tuple[float, float, float, float, float, float, float, float, float]

ValueType = Literal[
    "float", "int", "bool", "choice", "color", "vector", "matrix", "curve", "ramp", "lights", "path", "text"
]
Plain = float | int | bool | str | tuple[float, ...]
"""The types of values: JSON scalars and flat lists of numbers."""

Uniform = float | int | bool | tuple[float, ...]
"""The types of uniforms."""


class Value(Struct, frozen=True):
    """The declaration of one value, read from its annotation."""

    name: str
    type: ValueType
    default: Plain
    length: int = 1
    """How many numbers: of a curve per point, of a ramp per stop, of lights per light."""
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


def read_value(name: str, hint: Any, default: Any) -> Value:
    """Turn `Annotated[type, Slider(...), ...] = default` into a Value."""
    base, notes = (hint.__origin__, hint.__metadata__) if get_origin(hint) is Annotated else (hint, ())
    facts: dict[str, Any] = {"name": name, "default": default}
    if base in (float, int, bool):
        facts["type"] = base.__name__
    elif get_origin(base) is Literal:
        facts |= {"type": "choice", "choices": get_args(base)}
    elif get_origin(base) is tuple:
        facts |= _tuple_type(name, get_args(base), notes)
    elif base is str:
        facts["type"] = "text"
    else:
        raise TypeError(f"value '{name}': a value cannot have the type {hint!r}")
    for note in notes:
        if isinstance(note, Slider):
            facts |= {key: getattr(note, key) for key in ("low", "high", "minimum", "maximum", "unit")}
            facts["doc"] = note.doc or facts.get("doc", "")
        elif isinstance(note, Doc):
            facts["doc"] = note.text
        elif isinstance(note, Swatch):
            facts["type"] = "color"
        elif isinstance(note, File):
            facts |= {"type": "path", "layer_by": note.layer, "holds": note.holds}
        elif isinstance(note, OfLayer):
            facts |= {"file": note.path, "role": note.role}
        elif isinstance(note, Folded):
            facts["folded"] = True
        elif isinstance(note, OfSpace):
            facts["space"] = True
        elif isinstance(note, Picks):
            facts |= {"file": note.path, "matte": note.layer}
        elif isinstance(note, Handle):
            facts |= {"handle": True, "low": 0.0, "high": 1.0}
        elif isinstance(note, Dial):
            facts["turns"] = note.turns
        elif isinstance(note, Curve):
            facts |= {key: getattr(note, key) for key in ("low", "high", "minimum", "maximum")}
    return Value(**facts)


def _tuple_type(name: str, parts: tuple[Any, ...], notes: tuple[Any, ...]) -> dict[str, Any]:
    """The type and length of a flat list of numbers; that of a curve is 2 per point, that of a ramp 5 per stop."""
    if Ellipsis not in parts:
        return {"type": "matrix" if len(parts) == 9 else "vector", "length": len(parts)}
    for note in notes:
        if isinstance(note, Curve | ColorRamp):
            return {"type": "curve", "length": 2} if isinstance(note, Curve) else {"type": "ramp", "length": 5}
        if isinstance(note, Lights):
            return {"type": "lights", "length": LIGHT_NUMBERS}
    raise TypeError(f"value '{name}': a list of any length is a Curve, a ColorRamp or Lights")
