"""The parts of a graph other than nodes: ports, inputs, outputs, controls, settings."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from types import MappingProxyType
from typing import Any, cast

from halation.nodes import ColorSettings, Kind, Missing, Node, Pointwise, Scalar, Size, Socket, Value
from msgspec import Struct
from msgspec.structs import force_setattr

from ..errors import GraphError
from .conversion import make_socket
from .names import did_you_mean

MAX_GROUP_DEPTH = 32
"""Groups inside groups. Chosen by judgement: graphs in use nest two or three deep. A file can name itself as the body
of a group, and then this limit ends the expansion."""


class Port(Struct, frozen=True, order=True):
    """One end of a link, written `bloom.image`. The nodes `inputs` and `outputs` are the ends of the graph.

    The socket of a field of a named item has dots: `relight.lights.lamp_3.intensity`. That of a point of a spline ends
    with its number: `roto.shapes.face.points.3`.
    """

    node: str
    socket: str

    def __str__(self) -> str:
        return f"{self.node}.{self.socket}"

    def is_held(self, ports: Container[Port]) -> bool:
        """True if it is one of these ports, or a part of one: a field of an item, a point of a spline."""
        if self in ports or "." not in self.socket:
            return self in ports
        return self.whole in ports or Port(self.node, self.socket.rpartition(".")[0]) in ports

    @property
    def whole(self) -> Port:
        """The value that holds the field of a named item; for anything else the port itself."""
        return Port(self.node, self.socket.partition(".")[0]) if "." in self.socket else self

    @classmethod
    def parse(cls, text: str) -> Port:
        """Read `node.socket` or `node.value.item.field`. Raises GraphError."""
        node, _, socket = text.partition(".")
        parts = socket.split(".")
        length = len(parts) - (len(parts) in (2, 4) and parts[-1].isdecimal())
        if not node or length not in (1, 3) or not all(parts):
            raise GraphError(f"'{text}' is not a socket: write node.socket, such as 'bloom.image'")
        return cls(node, socket)


@dataclass(frozen=True)
class Input:
    """An input of the graph: what the caller binds to its name, else `default`, else layer `layer` of `file`.

    `width` counts the channels of a Vector. `default` is one number, or one per channel. `missing` says what a frame
    without a file shows if `file` is a sequence. `color_space` is the color space of the file, by name or role; ""
    means that the file says it.
    """

    kind: Kind = Kind.IMAGE
    width: int = 4
    file: str = ""
    layer: str = ""
    default: Scalar | None = None
    doc: str = ""
    missing: Missing = "error"
    color_space: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "width", _width(self.kind, self.width))

    def socket(self, name: str = "") -> Socket:
        """The socket of this input. In the graph itself it is optional if it has a default or a file."""
        fallback = 0.0 if self.default is None and self.file else self.default
        return make_socket(self.kind, self.width, fallback, name=name, doc=self.doc)


@dataclass(frozen=True)
class Output:
    """An output of the graph. `layer` is its name in a file of several layers; by default the name of the output.

    `view` is the default OpenColorIO view: `none` for display colors, as after a tone map. With `overscan` an EXR file
    gets the pixels that the picture has beyond its frame as well, as far as the overscan of the graph goes.
    """

    kind: Kind = Kind.IMAGE
    width: int = 3
    layer: str = ""
    view: str = ""
    overscan: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "width", _width(self.kind, self.width))

    def socket(self, name: str = "") -> Socket:
        """The socket of this output."""
        return make_socket(self.kind, self.width, name=name)


class Control(Struct, frozen=True):
    """A value of a node (or a control of a group) that the graph exposes under a name."""

    target: Port
    label: str = ""
    doc: str = ""

    def with_target(self, target: Port) -> Control:
        """The same control of another value."""
        return Control(target, self.label, self.doc)


class Unknown(Struct, frozen=True):
    """A node of a type that is not installed, or of code that has a `fault`.

    It does nothing, and is saved as it was read.
    """

    type: str
    raw: Mapping[str, Any] = MappingProxyType({})
    fault: str = ""

    def __post_init__(self) -> None:
        if self.raw:
            force_setattr(self, "raw", freeze(self.raw))

    @property
    def signature(self) -> Signature:
        """Sockets and values that nobody knows: every link is possible."""
        return Signature({}, {}, {}, anything=True)


@dataclass(frozen=True)
class Settings:
    """Settings of the whole graph.

    `size`: the canvas of nodes without image inputs; by default that of the first image read, else 1920x1080.
    `frames`: the first and last frame; by default those of the first sequence that is read, else from 1 to the last
    key. `rate`: frames per second. `preroll`: how many earlier frames are rendered for nodes with a memory; by default
    all from the first one, so that a frame does not depend on where a render starts. `reference_height`: with it,
    numbers of lengths in pixels are pixels of a picture of this height, so that the look is the same at every size;
    without it they are pixels of the picture. It holds for one body: each group has its own. `color`: color management,
    also in groups. `allow`: reasons why a warning is intended, by `rule` or `rule:node`. `overscan`: how far beyond its
    frame a picture is kept, in heights of the frame, where it goes on there; by default every picture ends at its
    frame.
    """

    size: Size | None = None
    frames: tuple[int, int] | None = None
    rate: float = 24.0
    preroll: int | None = None
    color: ColorSettings = field(default_factory=ColorSettings)
    allow: Mapping[str, str] = field(default_factory=dict[str, str], repr=False)  # no picture depends on it
    reference_height: int | None = None
    overscan: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "allow", freeze(self.allow))


class Signature(Struct, frozen=True):
    """The sockets and values of a node by name. `anything` is True if its type is unknown."""

    inputs: Mapping[str, Socket]
    outputs: Mapping[str, Socket]
    values: Mapping[str, Value]
    pointwise: bool = False
    anything: bool = False

    def explain_missing_value(self, id: str, name: str) -> str:
        """Why the node `id` has no value of a name that can be set."""
        if self.anything:
            return f"'{id}.{name}' cannot be set: the type of node '{id}' is unknown"
        if name in self.inputs:
            return f"'{id}.{name}' is an input, not a value: link an output to it"
        return f"node '{id}' has no value '{name}'{did_you_mean(name, self.values)}"

    @property
    def unfolded_inputs(self) -> Mapping[str, Socket]:
        """The inputs without the mask that many nodes have."""
        return {name: socket for name, socket in self.inputs.items() if not socket.folded}


@lru_cache(1024)
def class_signature(kind: type[Node]) -> Signature:
    """What all nodes of a class show to links."""
    outputs = {name: output.socket for name, output in kind.outputs.items()}
    return Signature(kind.inputs, outputs, kind.values, pointwise=issubclass(kind, Pointwise))


_SCALARS = frozenset({str, int, float, bool, type(None)})


def freeze(item: Any) -> Any:
    """A read-only copy of a JSON tree: objects as mapping proxies, lists as tuples."""
    if isinstance(item, (dict, Mapping)):  # a dict first: to ask whether something is a Mapping takes long
        entries = cast("Mapping[str, Any]", item)
        return MappingProxyType(
            {key: part if type(part) in _SCALARS else freeze(part) for key, part in entries.items()}
        )
    if isinstance(item, (list, tuple)):
        parts = cast("Sequence[Any]", item)
        return tuple([part if type(part) in _SCALARS else freeze(part) for part in parts])
    return item


def _width(kind: Kind, width: int) -> int:
    """The number of channels of an input or output: `width` for a Vector, else that of the kind."""
    if kind is not Kind.VECTOR:
        return make_socket(kind).channels
    if width not in (2, 3, 4):
        raise GraphError(f"a Vector has 2, 3 or 4 channels, not {width}")
    return width
