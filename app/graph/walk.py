"""Walks through links between nodes. Iterative, so that ten thousand nodes in a row work."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from types import MappingProxyType
from typing import Generic, TypeVar

from halation.nodes import Node

from ..errors import GraphError
from .followed_types import fits_as_declared
from .model import Port, Unknown
from .names import INPUTS, OUTPUTS

_REPORTED_LOOPS = 8
"""Loops that are reported at once: more than anybody repairs in one go. Chosen by judgement."""

Steps = Mapping[str, Iterable[str]]
N = TypeVar("N", bound=Hashable)
T = TypeVar("T")

_MAX_NAMED = 40
"""Nodes of a loop that a sentence names: as many as fit into a few lines."""


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


def has_loops(steps: Mapping[N, Collection[N]]) -> bool:
    """True if a name leads to itself. Names that lead nowhere are removed until none is left (Kahn 1962)."""
    befores: dict[N, list[N]] = {name: [] for name in steps}
    for name, afters in steps.items():
        for after in afters:
            if after in befores:
                befores[after].append(name)
    counts = {name: sum(map(befores.__contains__, afters)) for name, afters in steps.items()}
    removed = [name for name, count in counts.items() if not count]
    for name in removed:
        for before in befores[name]:
            counts[before] -= 1
            if not counts[before]:
                removed.append(before)
    return len(removed) < len(steps)


def find_loops(
    steps: Steps, max_count: int = _REPORTED_LOOPS, *, in_order: bool = False
) -> tuple[tuple[str, ...], ...]:
    """Up to `max_count` loops that share no name, each as `a, b, a`: a name is after one that it leads to.

    With `in_order`, names are walked in their order, so that the same loops are always found. In one walk: the names of
    a loop are left out as soon as it is known, and from a name that was left behind without a loop none can come later.
    """
    loops_found, done = list[tuple[str, ...]](), set[str]()
    sort: Callable[[Iterable[str]], Iterable[str]] = sorted if in_order else iter
    for root in sort(steps):
        if len(loops_found) == max_count:
            break
        path, rests = dict[str, None](), list[Iterator[str]]()
        after: str | None = root
        while after is not None and len(loops_found) < max_count:
            if after in path:
                loop = [after]
                while loop[-1] != after or len(loop) == 1:
                    loop.append(path.popitem()[0])
                    rests.pop()
                loops_found.append(tuple(loop))
                done.update(loop)
            elif after not in done and after in steps:
                path[after] = None
                rests.append(iter(sort(steps[after])))
            while rests and (after := next(rests[-1], None)) is None:
                done.add(path.popitem()[0])
                rests.pop()
            after = after if rests else None
    return tuple(loops_found)


def find_cyclic(steps: Mapping[N, Collection[N]]) -> frozenset[N]:
    """Every name that leads to itself. In linear time, by strongly connected components (Tarjan 1972).

    A list of iterators stands in place of recursion, because chains may be longer than Python's stack. Names of a
    component stay in `component` until its first one is left; one name alone is cyclic only if it leads to itself
    directly.
    """
    cyclic, number, lowest = set[N](), dict[N, int](), dict[N, int]()
    component: dict[N, None] = {}
    for root in steps:
        path = [] if root in number else [(root, iter(steps[root]))]
        while path:
            name, rest = path[-1]
            if name not in number:
                number[name] = lowest[name] = len(number)
                component[name] = None
            for after in rest:
                if after in component:
                    lowest[name] = min(lowest[name], number[after])
                elif after not in number and after in steps:
                    path.append((after, iter(steps[after])))
                    break
            else:
                path.pop()
                if path:
                    lowest[path[-1][0]] = min(lowest[path[-1][0]], lowest[name])
                if lowest[name] == number[name]:
                    group = [component.popitem()[0]]
                    while group[-1] != name:
                        group.append(component.popitem()[0])
                    cyclic.update(group if len(group) > 1 or name in steps[name] else ())
    return frozenset(cyclic)


def find_reachable(starts: Iterable[N], steps: Mapping[N, Iterable[N]]) -> dict[N, N]:
    """Every name that `starts` lead to, nearest first, with the name that it was first reached from."""
    reached_from, frontier = dict[N, N](), [*starts]
    while frontier:
        next_frontier: list[N] = []
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
    reached_from = find_reachable([start], steps)
    if goal not in reached_from:
        return ()
    route_back = [goal]
    while route_back[-1] != start:
        route_back.append(reached_from[route_back[-1]])
    return tuple(reversed(route_back))


def describe_loop(loop: Sequence[str]) -> str:
    """A sentence about nodes that form a loop."""
    left_out = len(loop) - _MAX_NAMED
    names = [*loop[:_MAX_NAMED], f"{left_out} more", loop[-1]] if left_out > 1 else loop
    return f"the nodes {' -> '.join(names)} form a loop; remove one of these links"


class Wired(Generic[T]):
    """Nodes by name, and links between them by target."""

    nodes: Mapping[str, T]
    links: Mapping[Port, Port]

    def link_fault(self, source: Port, target: Port) -> str | None:
        """Why a link from `source` cannot feed `target`, loops aside, or None."""
        raise NotImplementedError

    @cached_property
    def link_faults(self) -> Mapping[Port, str]:
        """Why links cannot be, by target, loops aside."""
        return MappingProxyType(dict(self.find_link_faults()))

    def find_link_faults(self) -> Iterator[tuple[Port, str]]:
        """What `link_faults` holds, one after the other: there may be 100,000, and nobody reads them all."""
        for target, source in self.links.items():
            start, end = self.nodes.get(source.node), self.nodes.get(target.node)
            if isinstance(start, Node) and isinstance(end, Node):
                fits = fits_as_declared(type(start), source.socket, type(end), target.socket)
            else:
                fits = isinstance(start, Unknown) and isinstance(end, Unknown)  # whose sockets nobody knows
            if not fits and (fault := self.link_fault(source, target)):
                yield target, fault

    def order(self) -> tuple[str, ...]:
        """All nodes, each after those that feed it; the same for equal graphs. Raises GraphError that names a loop."""
        try:
            return sort_topologically({id: sorted(self.feeding[id]) for id in sorted(self.nodes)})
        except CycleError as error:
            raise GraphError(describe_loop(error.args[1])) from None

    def upstream(self, id: str) -> frozenset[str]:
        """Every node that `id` (or OUTPUTS) depends on."""
        return frozenset(find_reachable([id], self.feeding))

    def downstream(self, id: str) -> frozenset[str]:
        """Every node that depends on `id` (or INPUTS)."""
        return frozenset(find_reachable([id], self.fed))

    @cached_property
    def feeding(self) -> Mapping[str, frozenset[str]]:
        """For each node and OUTPUTS: the nodes that feed it directly."""
        return map_neighbors(self.nodes, OUTPUTS, ((end.node, start.node) for end, start in self.links.items()))

    @cached_property
    def links_into(self) -> Mapping[str, tuple[Port, ...]]:
        """The targets of the links into each node, in order."""
        targets: dict[str, list[Port]] = {}
        for port in sorted(self.links):
            targets.setdefault(port.node, []).append(port)
        return MappingProxyType({id: tuple(ports) for id, ports in targets.items()})

    @cached_property
    def fed(self) -> Mapping[str, frozenset[str]]:
        """For each node and INPUTS: the nodes that it feeds directly."""
        return map_neighbors(self.nodes, INPUTS, ((start.node, end.node) for end, start in self.links.items()))
