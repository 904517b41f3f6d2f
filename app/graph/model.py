"""What a graph is made of, besides nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, cast

from halation.nodes import ColorSettings, Kind, Missing, Plain, Size, Socket, Value
from msgspec import Struct

from ..errors import GraphError
from .conversion import make_socket


class Port(Struct, frozen=True, order=True):
    """One end of a link, written `bloom.image`. The nodes `inputs` and `outputs` are the ends of the graph."""

    node: str
    socket: str

    def __str__(self) -> str:
        return f"{self.node}.{self.socket}"

    @classmethod
    def parse(cls, text: str) -> Port:
        """Read `node.socket`. Raises GraphError."""
        node, _, socket = text.partition(".")
        if not node or not socket or "." in socket:
            raise GraphError(f"'{text}' names no socket: write node.socket, such as 'bloom.image'")
        return cls(node, socket)


@dataclass(frozen=True)
class Input:
    """Where something enters the graph: bound by name, else `default`, else layer `layer` of `file`.

    `width` counts the channels of a Vector. `default` is one number, or one per channel. `missing` says what a frame
    shows that has no file, where `file` names a sequence. `color_space` is what color in a file is in, by name or role;
    "" finds out.
    """

    kind: Kind = Kind.IMAGE
    width: int = 4
    file: str = ""
    layer: str = ""
    default: Plain | None = None
    doc: str = ""
    missing: Missing = "error"
    color_space: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "width", _width(self.kind, self.width))

    def socket(self, name: str = "") -> Socket:
        """How a link sees it. Outside a group it may stay unlinked if there is a default or a file."""
        fallback = 0.0 if self.default is None and self.file else self.default
        return make_socket(self.kind, self.width, fallback, name=name, doc=self.doc)


@dataclass(frozen=True)
class Output:
    """Where something leaves the graph. `layer` names it in a file of several layers (default: its own name).

    `view` is how to show it unless someone chooses: `none` for light that a tone map made ready for the display.
    """

    kind: Kind = Kind.IMAGE
    width: int = 3
    layer: str = ""
    view: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "width", _width(self.kind, self.width))

    def socket(self, name: str = "") -> Socket:
        """How a link sees it."""
        return make_socket(self.kind, self.width, name=name)


@dataclass(frozen=True)
class Control:
    """A value of a node (or a control of a group) that the graph shows under a name of its own."""

    target: Port
    label: str = ""
    doc: str = ""


@dataclass(frozen=True)
class Unknown:
    """A node of a type that is not installed, or of code that has a `fault`.

    It does nothing, and is saved back as it was read.
    """

    type: str
    raw: Mapping[str, Any] = field(default_factory=dict[str, Any])
    fault: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "raw", freeze(self.raw))


@dataclass(frozen=True)
class Settings:
    """What holds for the graph as a whole.

    `size`: the canvas of nodes without image inputs; by default that of the first image read, else 1920x1080.
    `frames`: the first and last frame; by default those of the first sequence that is read, else frame 1 alone.
    `rate`: frames per second. `preroll`: how many frames before the one that is wanted nodes with a memory look back;
    by default to the first frame, so that a frame is the same wherever a rendering begins. `color`: how colors are
    managed, groups included. `allow`: reasons why what a rule warns of is meant, by `rule` or `rule:node`.
    """

    size: Size | None = None
    frames: tuple[int, int] | None = None
    rate: float = 24.0
    preroll: int | None = None
    color: ColorSettings = field(default_factory=ColorSettings)
    allow: Mapping[str, str] = field(default_factory=dict[str, str], repr=False)  # no picture depends on it

    def __post_init__(self) -> None:
        object.__setattr__(self, "allow", freeze(self.allow))


class Signature(Struct, frozen=True):
    """What a node shows to links: its sockets and values by name. `anything`: its type is unknown."""

    inputs: Mapping[str, Socket]
    outputs: Mapping[str, Socket]
    values: Mapping[str, Value]
    pointwise: bool = False
    anything: bool = False


def freeze(item: Any) -> Any:
    """The same JSON tree, read-only: objects as mapping proxies, lists as tuples."""
    if isinstance(item, Mapping):
        return MappingProxyType({key: freeze(part) for key, part in cast("Mapping[str, Any]", item).items()})
    if isinstance(item, list | tuple):
        return tuple(freeze(part) for part in cast("list[Any]", item))
    return item


def _width(kind: Kind, width: int) -> int:
    """Channels of an end of the graph; only those of a Vector are free."""
    if kind is not Kind.VECTOR:
        return make_socket(kind).channels
    if width not in (2, 3, 4):
        raise GraphError(f"a Vector has 2, 3 or 4 channels, not {width}")
    return width
