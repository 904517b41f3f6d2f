"""Walks over `steps`: which names lead to which. Iterative, so that ten thousand nodes in a row work."""

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


def neighbors(names: Collection[str], end: str, pairs: Iterable[tuple[str, str]]) -> Mapping[str, frozenset[str]]:
    """For every name and `end`: the names that a pair leads to from there."""
    neighbors_by_node: dict[str, set[str]] = {name: set() for name in (*names, end)}
    for start, after in pairs:
        if start in neighbors_by_node and after in names:
            neighbors_by_node[start].add(after)
    return MappingProxyType({name: frozenset(afters) for name, afters in neighbors_by_node.items()})


def sort(steps: Steps) -> tuple[str, ...]:
    """Every name after all that it leads to. Raises graphlib.CycleError."""
    return tuple(TopologicalSorter(steps).static_order())


def loops(steps: Steps, most: int = 8) -> tuple[tuple[str, ...], ...]:
    """Loops that share no name, at most `most` of them, each written like `a, b, a`."""
    rest, found = {name: set(after) for name, after in steps.items()}, list[tuple[str, ...]]()
    while len(found) < most:
        try:
            TopologicalSorter(rest).prepare()
            break
        except CycleError as error:
            loop = tuple(error.args[1])
            found.append(loop)
            rest = {name: after.difference(loop) for name, after in rest.items() if name not in loop}
    return tuple(found)


def reach(start: str, steps: Steps) -> dict[str, str]:
    """Every name that `start` leads to, with the name it was first reached from. Nearest come first."""
    came, front = dict[str, str](), [start]
    while front:
        ahead: list[str] = []
        for name in front:
            for after in steps.get(name, ()):
                if after not in came:
                    came[after] = name
                    ahead.append(after)
        front = ahead
    return came


def route(start: str, goal: str, steps: Steps) -> tuple[str, ...]:
    """A shortest way from `start` to `goal`, both included; empty if there is none."""
    if start == goal:
        return (start,)
    came = reach(start, steps)
    if goal not in came:
        return ()
    way = [goal]
    while way[-1] != start:
        way.append(came[way[-1]])
    return tuple(reversed(way))


def loop_sentence(loop: Iterable[str]) -> str:
    """What to say about nodes that feed each other."""
    return f"the nodes {' -> '.join(loop)} form a loop; remove one of these links"


T = TypeVar("T")


class Wired(Generic[T]):
    """Things by name, and links between them by target."""

    nodes: Mapping[str, T]
    links: Mapping[Port, Port]

    def order(self) -> tuple[str, ...]:
        """Every node after all that feed it; the same for equal graphs. Raises GraphError that names a loop."""
        try:
            return sort({id: sorted(self.feeding[id]) for id in sorted(self.nodes)})
        except CycleError as error:
            raise GraphError(loop_sentence(error.args[1])) from None

    def upstream(self, id: str) -> frozenset[str]:
        """Every node that `id` (or OUTPUTS) depends on."""
        return frozenset(reach(id, self.feeding))

    def downstream(self, id: str) -> frozenset[str]:
        """Every node that depends on `id` (or INPUTS)."""
        return frozenset(reach(id, self.fed))

    @cached_property
    def feeding(self) -> Mapping[str, frozenset[str]]:
        """For every node and OUTPUTS: the nodes that feed it directly."""
        return neighbors(self.nodes, OUTPUTS, ((end.node, start.node) for end, start in self.links.items()))

    @cached_property
    def fed(self) -> Mapping[str, frozenset[str]]:
        """For every node and INPUTS: the nodes that it feeds directly."""
        return neighbors(self.nodes, INPUTS, ((start.node, end.node) for end, start in self.links.items()))
