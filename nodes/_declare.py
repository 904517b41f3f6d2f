"""The vocabulary of nodes: a class body declares an effect, an instance holds its values.

    class Exposure(Pointwise):
        \"\"\"Brighten or darken in photographic stops.\"\"\"

        image = Image()
        stops: Annotated[float, Slider(-10.0, 10.0, unit="EV")] = 0.0

- *Sockets* (`Image`, `Field`, `Vector`, `Number`, `Color`) are inputs that a link fills; one with a
  `default` may stay unlinked. `Output(...)` declares outputs; without any there is one Image, `out`.
- *Values* are annotated attributes with a default. Numbers carry a `Slider`, choices are `Literal`s.
- `Pointwise` is one GLSL function of its own pixel; its numbers, colors and vectors can be wired too.
- `Filter` records draws symbolically in `passes`, `Source` reads files there, `Temporal` also keeps history.

Values reach `passes` and GLSL in working units (see `Slider.unit`), so no node converts any itself.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any, ClassVar, Literal, Protocol, Self, dataclass_transform, get_args, get_origin, get_type_hints

Size = tuple[int, int]
"""Width and height in pixels."""

Unit = Literal["px", "height", "deg", "EV", "ratio", "count", "s", "scene"]
"""What a number counts.

`px` pixels at full size (scaled under a proxy); `height` fraction of the image height (pixels in GLSL);
`deg` degrees (radians in GLSL); `EV` photographic stops; `ratio` a plain factor; `count` a whole number of
things; `s` seconds; `scene` the scene's own units (radiance, depth).
"""

Edge = Literal["clamp", "mirror", "reflect", "wrap", "black"]
"""What lies outside a picture: scipy's nearest, mirror, reflect and wrap; black is transparent."""


class Kind(StrEnum):
    """What travels on a link."""

    IMAGE = "Image"
    FIELD = "Field"
    VECTOR = "Vector"
    NUMBER = "Number"
    COLOR = "Color"


# --- sockets ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Socket:
    """A typed end of a link. With a `default` (one number per channel, or one for all) it may stay unlinked."""

    kind: ClassVar[Kind]
    default: float | tuple[float, ...] | None = None
    doc: str = dataclasses.field(default="", kw_only=True)
    name: str = dataclasses.field(default="", init=False, compare=False)

    def __set_name__(self, owner: type, name: str) -> None:
        object.__setattr__(self, "name", name)

    @property
    def channels(self) -> int:
        """Floats per pixel."""
        return 1 if self.kind in (Kind.FIELD, Kind.NUMBER) else 4

    @property
    def optional(self) -> bool:
        """True if the socket works without a link."""
        return self.default is not None

    @property
    def single(self) -> bool:
        """True if it carries one value for the whole picture instead of one per pixel."""
        return self.kind in (Kind.NUMBER, Kind.COLOR)

    @property
    def glsl(self) -> str:
        """The GLSL type of one pixel."""
        return glsl_type(self.channels)


class Image(Socket):
    """RGBA, scene-linear, premultiplied."""

    kind = Kind.IMAGE


class Field(Socket):
    """One channel of data: depth, mask, occlusion."""

    kind = Kind.FIELD


@dataclass(frozen=True)
class Vector(Socket):
    """Two to four channels of data that is not color: normal, position, velocity, uv."""

    kind = Kind.VECTOR
    width: int = dataclasses.field(default=3, kw_only=True)

    @property
    def channels(self) -> int:
        return self.width


class Number(Socket):
    """One number for the whole picture; it may be measured on the GPU."""

    kind = Kind.NUMBER


class Color(Socket):
    """One scene-linear RGBA color for the whole picture."""

    kind = Kind.COLOR


@dataclass(frozen=True)
class Output:
    """Something a node makes. `socket` says its type."""

    socket: Socket = dataclasses.field(default_factory=Image)
    name: str = dataclasses.field(default="", init=False, compare=False)

    def __set_name__(self, owner: type, name: str) -> None:
        object.__setattr__(self, "name", name)
        object.__setattr__(self.socket, "name", name)


def glsl_type(channels: int) -> str:
    """The GLSL type that holds `channels` floats."""
    return ("float", "vec2", "vec3", "vec4")[channels - 1]


# --- values ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Slider:
    """How a number is edited: the soft range of the slider, the hard range that typing cannot leave, the unit."""

    low: float
    high: float
    unit: Unit = dataclasses.field(kw_only=True)
    minimum: float = dataclasses.field(default=float("-inf"), kw_only=True)
    maximum: float = dataclasses.field(default=float("inf"), kw_only=True)
    doc: str = dataclasses.field(default="", kw_only=True)


@dataclass(frozen=True)
class Doc:
    """A sentence for the tooltip of a value that has no slider."""

    text: str


@dataclass(frozen=True)
class File:
    """The value is a path; `layer` names the sibling value that picks a layer of that file, if any."""

    layer: str = ""


@dataclass(frozen=True)
class Swatch:
    """The value is a scene-linear RGBA color, edited with a picker. Components may leave 0..1."""


@dataclass(frozen=True)
class Handle:
    """The value is a position as a fraction of the picture (0,0 is its top left), dragged in the viewer."""


Fraction = Annotated[float, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0)]
RGBA = Annotated[tuple[float, float, float, float], Swatch()]
Position = Annotated[tuple[float, float], Handle()]
FilePath = Annotated[str, File()]
Kernel3x3 = tuple[float, float, float, float, float, float, float, float, float]

ValueType = Literal["float", "int", "bool", "choice", "color", "vector", "matrix", "path", "text"]
Plain = float | int | bool | str | tuple[float, ...]
"""What a value may be: JSON scalars and flat lists of numbers."""


@dataclass(frozen=True)
class Value:
    """The declaration of one value, read from its annotation."""

    name: str
    type: ValueType
    default: Plain
    length: int = 1
    choices: tuple[str, ...] = ()
    low: float = float("-inf")
    high: float = float("inf")
    minimum: float = float("-inf")
    maximum: float = float("inf")
    unit: Unit | None = None
    doc: str = ""
    layer_of: str = ""

    @property
    def glsl(self) -> str | None:
        """Its GLSL parameter type, or None where it never reaches a shader."""
        if self.type in ("float", "int", "bool"):
            return self.type
        if self.type in ("color", "vector"):
            return glsl_type(self.length)
        return {"choice": "int", "matrix": "mat3"}.get(self.type)

    @property
    def wireable(self) -> bool:
        """True if a link may drive it (on a pointwise node)."""
        return self.type in ("float", "int", "bool", "color", "vector")

    @property
    def is_pixels(self) -> bool:
        """True for lengths in pixels, which shrink under a proxy."""
        return self.unit == "px"


def _read_value(name: str, hint: Any, default: Any) -> Value:
    """Turn `Annotated[type, Slider(...), ...] = default` into a Value."""
    base, notes = (hint.__origin__, hint.__metadata__) if get_origin(hint) is Annotated else (hint, ())
    found: dict[str, Any] = {"name": name, "default": default}
    if base in (float, int, bool):
        found["type"] = base.__name__
    elif get_origin(base) is Literal:
        found |= {"type": "choice", "choices": get_args(base)}
    elif get_origin(base) is tuple:
        length = len(get_args(base))
        found |= {"type": "matrix" if length == 9 else "vector", "length": length}
    elif base is str:
        found["type"] = "text"
    else:
        raise TypeError(f"value '{name}': {hint!r} is no type that a value can have")
    for note in notes:
        if isinstance(note, Slider):
            found |= {key: getattr(note, key) for key in ("low", "high", "minimum", "maximum", "unit")}
            found["doc"] = note.doc or found.get("doc", "")
        elif isinstance(note, Doc):
            found["doc"] = note.text
        elif isinstance(note, Swatch):
            found["type"] = "color"
        elif isinstance(note, File):
            found["type"] = "path"
    return Value(**found)


# --- what a filter may draw ----------------------------------------------------------------------------------


class Drawn(Protocol):
    """Pixels that a draw will make. Only the compiler looks inside."""

    @property
    def size(self) -> Size: ...


Pixels = Socket | Drawn
Argument = Socket | Drawn | Plain


class Draw(Protocol):
    """Records what a node wants drawn; nothing runs yet, but sizes are known.

    Functions are looked up in the node's own GLSL file. `result` is the type of what is drawn.
    """

    @property
    def size(self) -> Size:
        """The size that the node's outputs have unless drawn otherwise."""
        ...

    def size_of(self, pixels: Pixels) -> Size:
        """The size of an input or of something drawn."""
        ...

    def linked(self, socket: Socket) -> bool:
        """True if something is linked to this input of the node."""
        ...

    def __call__(
        self, function: str, /, *inputs: Socket, size: Size | None = None, edge: Edge = "clamp",
        result: Socket | None = None, **arguments: Argument,
    ) -> Drawn:
        """Call `function` for every pixel of `size`.

        Inputs, and keyword arguments that are pixels, are read through accessors named after the socket or
        keyword: `image_at(ivec2)`, `image_near(vec2)` (bilinear, pixel positions, centers at .5) and
        `image_size`. The other keyword arguments are the function's parameters, in order.
        """
        ...

    def point(self, function: str, /, *inputs: Socket, result: Socket | None = None, **arguments: Argument) -> Drawn:
        """Call a pointwise `function`; every argument, pixels too, is a parameter, in order. It can fuse."""
        ...

    def blur(self, image: Pixels, sigma: float | tuple[float, float], edge: Edge = "clamp") -> Drawn:
        """Gaussian of `sigma` working pixels: direct where small, decimated where large."""
        ...

    def convolve(self, image: Pixels, weights: tuple[float, ...], axis: Literal["x", "y"], edge: Edge = "clamp") -> Drawn:
        """Correlate along one axis with an odd number of centered weights."""
        ...

    def reduce(self, image: Pixels, operation: Literal["sum", "max"]) -> Drawn:
        """Sum or maximum of every channel over all pixels, as 1x1; exact at any size."""
        ...

    def read(self, path: str, layer: str, result: Socket) -> Drawn:
        """The pixels of a layer of an image file, as `result` says."""
        ...


# --- nodes -----------------------------------------------------------------------------------------------------


@dataclass_transform(frozen_default=True, kw_only_default=True)
class Node:
    """One effect. The class body is the declaration; an instance is one set of values."""

    id: ClassVar[str] = ""
    category: ClassVar[str] = ""
    version: ClassVar[int] = 1
    inputs: ClassVar[Mapping[str, Socket]] = {}
    outputs: ClassVar[Mapping[str, Output]] = {}
    values: ClassVar[Mapping[str, Value]] = {}
    order: ClassVar[tuple[str, ...]] = ()
    """Names of inputs and values in declared order: the parameters of a pointwise GLSL function."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        body = vars(cls)
        cls.id = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", cls.__name__).lower()
        cls.category = cls.__module__.rpartition(".")[0].rpartition(".")[2]
        cls.inputs = {name: item for name, item in body.items() if isinstance(item, Socket)}
        outputs = {name: item for name, item in body.items() if isinstance(item, Output)}
        dataclasses.dataclass(frozen=True, kw_only=True)(cls)
        if not outputs:
            implied = Output()
            implied.__set_name__(cls, "out")
            outputs = {"out": implied}
        cls.outputs = outputs
        hints = get_type_hints(cls, include_extras=True)
        cls.values = {
            field.name: _read_value(field.name, hints[field.name], field.default) for field in dataclasses.fields(cls)
        }
        cls.order = tuple(name for name in body if name in cls.inputs or name in cls.values)

    def identity(self) -> str | None:
        """The input that passes through unchanged at these values, or None. Not asked while a value is wired."""
        return None

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        """The size of the outputs: the first linked input's, else the graph's canvas."""
        return next(iter(inputs.values()), canvas)

    @classmethod
    def upgrade(cls, version: int, values: dict[str, Any]) -> dict[str, Any]:
        """Values saved by an older `version` of this node, as the next version would have saved them."""
        return values

    def working(self, scale: float, height: int) -> Self:
        """The same values in working units, as `passes` and GLSL see them: see `Unit`."""
        factor = {"px": scale, "height": float(height), "deg": math.pi / 180.0}
        changed: dict[str, Any] = {}
        for name, value in self.values.items():
            if value.unit in factor:
                now = getattr(self, name)
                by = factor[value.unit]
                changed[name] = tuple(part * by for part in now) if isinstance(now, tuple) else now * by
        return dataclasses.replace(self, **changed) if changed else self


class Pointwise(Node):
    """An output pixel needs only the same pixel of each input, so neighbors fuse into one pass.

    `shaders/<category>/<id>.glsl` holds a function named like the node whose parameters are the sockets and
    values in declared order. One output is returned; several are `out` parameters at the end.
    """


class Filter(Node):
    """Anything that looks at other pixels or takes several passes."""

    def passes(self, draw: Draw) -> Drawn | Mapping[str, Drawn]:
        """What to draw. Several outputs come back by name."""
        raise NotImplementedError


class Source(Filter):
    """Makes pixels from outside the graph."""


class Temporal(Filter):
    """A filter that owns history: `draw.history` gives what it drew for the frame before."""
