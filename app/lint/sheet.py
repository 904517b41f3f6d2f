"""The facts that rules read: a graph without errors, without nodes that do nothing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import NamedTuple, TypeGuard

from halation.nodes import Node, Reader, Trait, Value
from msgspec import Struct, field

from ..compiler import Library, load_library
from ..graph import Graph, Group, Item, Port, Problem, signature
from ..graph.rules import Rule


class GraphFacts(Struct, frozen=True, dict=True, eq=False):
    """A graph without errors, or the body of a group in its file."""

    graph: Graph
    _bypassed: dict[tuple[Port, object], Port | None] = field(default_factory=dict[tuple[Port, object], "Port | None"])
    """What reaches a port if a node passes its picture through, by the kind of the target."""

    @cached_property
    def readers(self) -> Counter[Port]:
        """How many links start at a port."""
        return Counter(self.graph.links.values())

    @cached_property
    def library(self) -> Library:
        """The shaders of nodes."""
        return load_library()

    @cached_property
    def moving(self) -> frozenset[str]:
        """Nodes with an animated or linked value."""
        nodes = self.graph.nodes
        wired = (
            port.node
            for port in self.graph.links
            if port.node in nodes and port.socket not in getattr(nodes[port.node], "inputs", {port.socket})
        )
        return frozenset((*wired, *(port.node for port in self.graph.animation)))

    def works(self, id: str) -> Item | None:
        """The node with an id; None if it does not exist or passes its picture through."""
        return self._working.get(id)

    def list_having(self, *traits: Trait) -> list[tuple[str, Node]]:
        """The nodes with one of these traits that do not pass their picture through."""
        kinds = {kind for kind in self._kinds if any(trait in kind.traits for trait in traits)}
        return [(id, item) for id, item in self._working.items() if type(item) in kinds and isinstance(item, Node)]

    @cached_property
    def _kinds(self) -> frozenset[type[Node]]:
        return frozenset(type(item) for item in self.graph.nodes.values() if isinstance(item, Node))

    @cached_property
    def _working(self) -> dict[str, Item]:
        return {
            id: item
            for id, item in self.graph.nodes.items()
            if id not in self.graph.muted and not (isinstance(item, Node) and self._neutral(id, item))
        }

    def source(self, target: Port) -> Port | None:
        """The source of an input, skipping nodes that pass their picture through."""
        port = self.graph.links.get(target)
        if port is None or not self._is_passed(port):
            return port
        socket, passed = self.graph.target(target), list[tuple[Port, object]]()
        # The result depends on the kind of the target. Chains are walked once for all targets behind them.
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
        """The source of a node's first input: its picture."""
        return next((self.source(Port(id, name)) for name in signature(self.graph.nodes[id]).inputs), None)

    def _neutral(self, id: str, item: Node) -> bool:
        return id not in self.moving and len(item.outputs) == 1 and item.identity() is not None


def has_trait(item: Item | None, *traits: Trait) -> TypeGuard[Node]:
    """True for a node that has one of these traits."""
    return isinstance(item, Node) and any(trait in item.traits for trait in traits)


def find_layered_path(item: Item) -> Value | None:
    """The path of a node that reads one layer of a picture, or None for other nodes."""
    values = item.values.values() if isinstance(item, Reader) else ()
    return next((value for value in values if value.layer_by), None)


def layer_read(item: Item, output: str) -> str:
    """The layer that a reader shows at an output; "" for other nodes. Outputs of `read_render` are layers."""
    if path := find_layered_path(item):
        return getattr(item, path.layer_by)
    return output if isinstance(item, Reader) else ""


class Check(NamedTuple):
    """A rule and the function that finds its problems in a graph."""

    rule: Rule
    find: Callable[[GraphFacts], Iterator[Problem]]


def bodies(graph: Graph, inside: str = "", at: str = "") -> Iterator[tuple[Graph, str, str]]:
    """The graph and all groups in its file, each with its path and JSON path.

    A group in a file of its own is checked with that file.
    """
    yield graph, inside, at
    for id, item in graph.nodes.items():
        if isinstance(item, Group) and not item.path:
            yield from bodies(item.graph, f"{inside}{id}/", f"{at}nodes.{id}.graph.")
