"""Statements about a graph that are true or false: what the task of a lesson asks for."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from msgspec import Struct

from ...graph import Graph, Group, Port, Unknown
from ...graph.walk import find_route

if TYPE_CHECKING:
    from .moment import Moment


class GraphCondition(Struct, frozen=True):
    """A statement about a graph, which is also the question whether a step is done."""

    def holds(self, graph: Graph) -> bool:
        """True if the statement is true of a graph."""
        raise NotImplementedError

    def __call__(self, before: Moment, now: Moment) -> bool:
        return self.holds(now.graph)


class IsLinked(GraphCondition, frozen=True):
    """A port is fed by another one."""

    target: str
    source: str

    def holds(self, graph: Graph) -> bool:
        return graph.links.get(Port.parse(self.target)) == Port.parse(self.source)


class IsWithin(GraphCondition, frozen=True):
    """A number lies in a range, both ends included."""

    port: str
    low: float
    high: float

    def holds(self, graph: Graph) -> bool:
        number = _find_value(graph, self.port)
        return isinstance(number, float | int) and self.low <= number <= self.high


class IsChosen(GraphCondition, frozen=True):
    """A value is one of several choices."""

    port: str
    choice: str

    def holds(self, graph: Graph) -> bool:
        return _find_value(graph, self.port) == self.choice


class IsUpstream(GraphCondition, frozen=True):
    """A node of one type feeds a node of another type, directly or through others, and not the other way round."""

    type: str
    of: str

    def holds(self, graph: Graph) -> bool:
        return _feeds(graph, self.type, self.of) and not _feeds(graph, self.of, self.type)


class AllHold(GraphCondition, frozen=True):
    """Several conditions hold together."""

    parts: tuple[GraphCondition, ...]

    def holds(self, graph: Graph) -> bool:
        return all(part.holds(graph) for part in self.parts)


def _find_value(graph: Graph, name: str) -> object:
    """The value of a port; None if its node is gone."""
    port = Port.parse(name)
    return graph.value(port) if port.node in graph.nodes else None


def _feeds(graph: Graph, start: str, end: str) -> bool:
    """True if a node of type `start` leads to one of type `end`."""
    readers: defaultdict[str, set[str]] = defaultdict(set)
    for target, source in graph.links.items():
        readers[source.node].add(target.node)
    starts, ends = _list_nodes(graph, start), _list_nodes(graph, end)
    return any(find_route(first, last, readers) for first in starts for last in ends)


def _list_nodes(graph: Graph, type: str) -> list[str]:
    return [id for id, item in graph.nodes.items() if not isinstance(item, Group | Unknown) and item.id == type]
