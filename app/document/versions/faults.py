"""Links that were right on the side that made them and are wrong in what a merge made."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ...graph import Graph, Group, Port
from ...graph.walk import loops
from .parts import At


def faulty_links(made: Graph, ours: Graph, theirs: Graph, at: At = ()) -> Iterator[At]:
    """Where the links are that fit no more, or that theirs brought into a loop; groups included."""
    for target, source in made.links.items():
        sides = (side for side in (ours, theirs) if side.links.get(target) == source)
        if made.link_fault(source, target) and not any(side.link_fault(source, target) for side in sides):
            yield (*at, "links", str(target))
    for target in _looping(made, ours):
        yield (*at, "links", str(target))
    for id, item in made.nodes.items():
        mine, other = ours.nodes.get(id), theirs.nodes.get(id)
        if isinstance(item, Group) and isinstance(mine, Group) and isinstance(other, Group):
            yield from faulty_links(item.graph, mine.graph, other.graph, (*at, "nodes", id, "graph"))


def _looping(made: Graph, ours: Graph) -> Iterator[Port]:
    """Links in a loop that are not ours."""
    steps = {id: sorted(made.feeding[id]) for id in sorted(made.nodes)}
    for loop in loops(steps):
        around = set(pairwise(loop))
        for target, source in made.links.items():
            if (target.node, source.node) in around and ours.links.get(target) != source:
                yield target
