"""Names of what lies on the canvas: the only place that knows how such a name is written.

An element is a node (`blur`), an input or output of the graph (`inputs.beauty`), a frame, a comment or a dot
(`frames.f1`). `graph.ui` is keyed by the same text, so an `ElementId` is a `str`: it costs nothing to compare, sort or
look up. It is a type of its own so that the type checker refuses a plain text where an element is expected.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

from ...graph import INPUTS, OUTPUTS, Port

ElementKind = Literal["node", "input", "output", "frame", "comment", "dot"]
DecorKind = Literal["frame", "comment", "dot"]

DECOR: tuple[DecorKind, ...] = ("frame", "comment", "dot")
"""What makes a graph readable and changes no pixel."""

_PREFIXES: Mapping[ElementKind, str] = MappingProxyType(
    {"input": INPUTS, "output": OUTPUTS, "frame": "frames", "comment": "comments", "dot": "dots"}
)
_KINDS: Mapping[str, ElementKind] = MappingProxyType({prefix: kind for kind, prefix in _PREFIXES.items()})


class ElementId(str):
    """The name of one element of the canvas; empty where there is none."""

    __slots__ = ()

    @classmethod
    def of(cls, kind: ElementKind, name: str) -> ElementId:
        """The id of a node, of an input or output of the graph, or of a frame, comment or dot."""
        return cls(name if kind == "node" else f"{_PREFIXES[kind]}.{name}")

    @classmethod
    def of_port(cls, port: Port) -> ElementId:
        """The id of the element that shows a port."""
        return cls(str(port) if port.node in (INPUTS, OUTPUTS) else port.node)

    @property
    def kind(self) -> ElementKind:
        """What kind of element this is."""
        prefix, _, name = self.partition(".")
        return _KINDS.get(prefix, "node") if name else "node"

    @property
    def name(self) -> str:
        """The id of the node, frame, comment or dot, or the name of the input or output."""
        return str(self) if self.kind == "node" else self.partition(".")[2]

    @property
    def port(self) -> Port | None:
        """The port that an input or output of the graph stands for; None for other elements."""
        kind = self.kind
        return Port(_PREFIXES[kind], self.name) if kind in ("input", "output") else None

    @property
    def is_note(self) -> bool:
        """True for what is only there to be read: frames and comments."""
        return self.kind in ("frame", "comment")

    @property
    def is_decor(self) -> bool:
        """True for frames, comments and dots."""
        return self.kind in DECOR

    @property
    def ui_entry(self) -> tuple[str, str]:
        """The section of `graph.ui` that describes the element, and its key there."""
        kind = self.kind
        return (_PREFIXES[kind], self.name) if kind in DECOR else ("nodes", str(self))


NO_ELEMENT = ElementId()


def decor_section(kind: DecorKind) -> str:
    """The section of `graph.ui` that holds all frames, comments or dots."""
    return _PREFIXES[kind]
