"""What rules look at: a graph that can be rendered, without what does nothing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple, TypeGuard

from halation.nodes import Node, Reader, Trait, Value

from ..compiler import Library, load_library
from ..graph import Graph, Group, Item, Port, Problem, signature
from ..graph.rules import Rule


@dataclass(frozen=True)
class GraphFacts:
    """A graph, or the body of a group that is part of its file, that has no errors."""

    graph: Graph
    _bypassed: dict[tuple[Port, object], Port | None] = field(default_factory=dict[tuple[Port, object], "Port | None"])
    """What reaches a port in place of a node that passes its picture through, by the kind of the target."""

    @cached_property
    def readers(self) -> Counter[Port]:
        """How many links start at a port."""
        return Counter(self.graph.links.values())

    @cached_property
    def library(self) -> Library:
        """What the shaders of nodes are."""
        return load_library()

    @cached_property
    def moving(self) -> frozenset[str]:
        """Nodes of which a value changes over time or is wired."""
        nodes = self.graph.nodes
        wired = (
            port.node
            for port in self.graph.links
            if port.node in nodes and port.socket not in getattr(nodes[port.node], "inputs", {port.socket})
        )
        return frozenset((*wired, *(port.node for port in self.graph.animation)))

    def works(self, id: str) -> Item | None:
        """The node of that id, unless there is none or it passes its picture through."""
        return self._working.get(id)

    @cached_property
    def _working(self) -> dict[str, Item]:
        return {
            id: item
            for id, item in self.graph.nodes.items()
            if id not in self.graph.muted and not (isinstance(item, Node) and self._neutral(id, item))
        }

    def source(self, target: Port) -> Port | None:
        """What feeds an input, past all nodes that pass their picture through."""
        port = self.graph.links.get(target)
        if port is None or not self._is_passed(port):
            return port
        socket, passed = self.graph.target(target), list[tuple[Port, object]]()
        # What fits depends on the target, by its kind. Many targets behind one long chain walk it once.
        kind = socket if isinstance(socket, Value) or socket is None else (socket.kind, socket.channels)
        while port is not None and self._is_passed(port):
            passed.append((port, kind))
            if passed[-1] in self._bypassed:
                port = self._bypassed[passed[-1]]
                break
            port = self.graph.bypass(port.node, socket)
        self._bypassed.update(dict.fromkeys(passed, port))
        return port

    def _is_passed(self, port: Port) -> bool:
        return port.node in self.graph.nodes and self.works(port.node) is None

    def first(self, id: str) -> Port | None:
        """What feeds the first input of a node: its picture."""
        return next((self.source(Port(id, name)) for name in signature(self.graph.nodes[id]).inputs), None)

    def _neutral(self, id: str, item: Node) -> bool:
        return id not in self.moving and len(item.outputs) == 1 and item.identity() is not None


def has_trait(item: Item | None, *traits: Trait) -> TypeGuard[Node]:
    """True for a node that has one of these traits."""
    return isinstance(item, Node) and not set(traits).isdisjoint(item.traits)


def find_layered_path(item: Item) -> Value | None:
    """The path of a node that reads one layer of a picture, or None for other nodes."""
    values = item.values.values() if isinstance(item, Reader) else ()
    return next((value for value in values if value.layer_by), None)


def layer_read(item: Item, output: str) -> str:
    """The layer that a reader shows at an output, "" for other nodes. Outputs of a reader of renders are layers."""
    if path := find_layered_path(item):
        return getattr(item, path.layer_by)
    return output if isinstance(item, Reader) else ""


class Check(NamedTuple):
    """A rule and what finds its problems in a graph."""

    rule: Rule
    find: Callable[[GraphFacts], Iterator[Problem]]


def bodies(graph: Graph, inside: str = "", at: str = "") -> Iterator[tuple[Graph, str, str]]:
    """The graph and all groups that are part of its file, each with the path of the group and its JSON path.

    A group from a file of its own is for whoever looks at that file.
    """
    yield graph, inside, at
    for id, item in graph.nodes.items():
        if isinstance(item, Group) and not item.path:
            yield from bodies(item.graph, f"{inside}{id}/", f"{at}nodes.{id}.graph.")
