"""What the editor wants to see, and what its ports mean."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from halation.nodes import Kind, Size

from ...compiler import Region, Upstream
from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Group, Port
from ...renderer import RenderRequest
from .takes import Take

if TYPE_CHECKING:
    from ...inputs.provider import Binding


@dataclass(eq=False)
class Wish:
    """Ports of a graph that panels want to show, by the panels' names. `world` counts changes outside of the graph."""

    graph: Graph
    ports: Mapping[str, Port]
    bindings: Mapping[str, Binding]
    scale: float
    frame: int
    size: Size | None
    world: int = 0
    known: Upstream | None = None
    """What each node depends on, in this graph or in an earlier one."""
    take: Take = field(default_factory=Take)
    """What is known of all frames of it."""

    def wanted(self, ports: Mapping[str, Port], frame: int, region: Region | None = None) -> RenderRequest:
        """The same for the renderer."""
        return RenderRequest(self.bindings, ports, self.size, self.scale, frame, region=region)

    def follows(self, before: Wish) -> bool:
        """True where nothing but the frame differs."""
        return replace(self, frame=before.frame).equals(before)

    def equals(self, other: Wish) -> bool:
        """True where the same pixels are wanted; layout does not matter."""
        return (
            self.ports == other.ports
            and self.scale == other.scale
            and self.same_world(other)
            and (self.graph is other.graph or _logic(self.graph) == _logic(other.graph))
        )

    def same_world(self, other: Wish) -> bool:
        """True where all that comes from outside of the graph is the same."""
        return (
            (self.frame, self.size) == (other.frame, other.size)
            and self.bindings.keys() == other.bindings.keys()
            and all(_same(item, other.bindings[name]) for name, item in self.bindings.items())
        )

    def mark(self, path: str) -> object:
        """Something that changes when anything upstream of a node does."""
        if self.known is None or self.known.graph is not self.graph:
            self.known = Upstream(self.graph, known=self.known)
        return self.known.hashes.get(path), self.world


def _logic(graph: Graph) -> tuple[Any, ...]:
    """All of a graph that pixels depend on."""
    return (
        graph.nodes,
        graph.links,
        graph.inputs,
        graph.outputs,
        graph.controls,
        graph.animation,
        graph.settings,
        graph.muted,
        graph.folder,
    )


def _same(one: Binding, other: Binding) -> bool:
    """Arrays are the same where they are one object: comparing all pixels in every frame would be slow."""
    plain = (str, PurePath, float, int, tuple)
    return one is other or (isinstance(one, plain) and isinstance(other, plain) and one == other)


def path_of(port: Port) -> str:
    """Where a port is on the canvas: inputs are boxes of their own."""
    return f"{port}" if port.node.rpartition("/")[2] == INPUTS else port.node


def kind_of(graph: Graph, port: Port, channels: int) -> Kind:
    """What the pixels of a port mean."""
    *groups, last = port.node.split("/")
    for name in groups:
        item = graph.nodes.get(name)
        if not isinstance(item, Group):
            break
        graph = item.graph
    try:
        socket = graph.target(Port(last, port.socket)) if last == OUTPUTS else graph.source(Port(last, port.socket))
    except GraphError:
        socket = None
    kind = getattr(socket, "kind", None)
    if isinstance(kind, Kind):
        return kind
    return Kind.FIELD if channels == 1 else Kind.IMAGE if channels == 4 else Kind.VECTOR
