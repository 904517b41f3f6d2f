"""Walks through links between nodes. Iterative, so that ten thousand nodes in a row work."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from types import MappingProxyType
from typing import Generic, TypeVar

from ..errors import GraphError
from .model import Port
from .names import INPUTS, OUTPUTS

Steps = Mapping[str, Iterable[str]]


def map_neighbors(names: Collection[str], end: str, pairs: Iterable[tuple[str, str]]) -> Mapping[str, frozenset[str]]:
    """For each name and `end`: the names that pairs lead to from there."""
    neighbors_by_node: dict[str, set[str]] = {name: set() for name in (*names, end)}
    for start, after in pairs:
        if start in neighbors_by_node and after in names:
            neighbors_by_node[start].add(after)
    return MappingProxyType({name: frozenset(afters) for name, afters in neighbors_by_node.items()})


def sort_topologically(steps: Steps) -> tuple[str, ...]:
    """All names, each after all names that it leads to. Raises graphlib.CycleError."""
    return tuple(TopologicalSorter(steps).static_order())


def find_loops(steps: Steps, max_count: int = 8) -> tuple[tuple[str, ...], ...]:
    """Up to `max_count` loops that share no name, each as `a, b, a`."""
    remaining, loops_found = {name: set(after) for name, after in steps.items()}, list[tuple[str, ...]]()
    while len(loops_found) < max_count:
        try:
            TopologicalSorter(remaining).prepare()
            break
        except CycleError as error:
            loop = tuple(error.args[1])
            loops_found.append(loop)
            remaining = {name: after.difference(loop) for name, after in remaining.items() if name not in loop}
    return tuple(loops_found)


def find_reachable(start: str, steps: Steps) -> dict[str, str]:
    """Every name that `start` leads to, nearest first, with the name that it was first reached from."""
    reached_from, frontier = dict[str, str](), [start]
    while frontier:
        next_frontier: list[str] = []
        for name in frontier:
            for after in steps.get(name, ()):
                if after not in reached_from:
                    reached_from[after] = name
                    next_frontier.append(after)
        frontier = next_frontier
    return reached_from


def find_route(start: str, goal: str, steps: Steps) -> tuple[str, ...]:
    """A shortest route from `start` to `goal`, both included; empty if there is none."""
    if start == goal:
        return (start,)
    reached_from = find_reachable(start, steps)
    if goal not in reached_from:
        return ()
    route_back = [goal]
    while route_back[-1] != start:
        route_back.append(reached_from[route_back[-1]])
    return tuple(reversed(route_back))


def describe_loop(loop: Iterable[str]) -> str:
    """A sentence about nodes that form a loop."""
    return f"the nodes {' -> '.join(loop)} form a loop; remove one of these links"


T = TypeVar("T")


class Wired(Generic[T]):
    """Nodes by name, and links between them by target."""

    nodes: Mapping[str, T]
    links: Mapping[Port, Port]

    def order(self) -> tuple[str, ...]:
        """All nodes, each after those that feed it; the same for equal graphs. Raises GraphError that names a loop."""
        try:
            return sort_topologically({id: sorted(self.feeding[id]) for id in sorted(self.nodes)})
        except CycleError as error:
            raise GraphError(describe_loop(error.args[1])) from None

    def upstream(self, id: str) -> frozenset[str]:
        """Every node that `id` (or OUTPUTS) depends on."""
        return frozenset(find_reachable(id, self.feeding))

    def downstream(self, id: str) -> frozenset[str]:
        """Every node that depends on `id` (or INPUTS)."""
        return frozenset(find_reachable(id, self.fed))

    @cached_property
    def feeding(self) -> Mapping[str, frozenset[str]]:
        """For each node and OUTPUTS: the nodes that feed it directly."""
        return map_neighbors(self.nodes, OUTPUTS, ((end.node, start.node) for end, start in self.links.items()))

    @cached_property
    def fed(self) -> Mapping[str, frozenset[str]]:
        """For each node and INPUTS: the nodes that it feeds directly."""
        return map_neighbors(self.nodes, INPUTS, ((start.node, end.node) for end, start in self.links.items()))
