"""What was right on the side that made it and is wrong in what a merge made."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ...graph import Graph, Group, Port, signature
from ...graph.walk import loops
from .parts import At


def faults(made: Graph, ours: Graph, theirs: Graph, at: At = ()) -> Iterator[At]:
    """Where links fit no more or became a loop through theirs, and where keys and controls are of values that are gone.

    Groups are looked into.
    """
    for target, source in made.links.items():
        sides = (side for side in (ours, theirs) if side.links.get(target) == source)
        if made.link_fault(source, target) and not any(side.link_fault(source, target) for side in sides):
            yield (*at, "links", str(target))
    for target in _looping(made, ours):
        yield (*at, "links", str(target))
    for port in made.animation:
        if _is_gone(made, port) and not any(_is_gone(side, port) for side in (ours, theirs) if port in side.animation):
            yield (*at, "animation", str(port))
    for name, control in made.controls.items():
        before = (side for side in (ours, theirs) if side.controls.get(name) == control)
        if _is_gone(made, control.target) and not any(_is_gone(side, control.target) for side in before):
            yield (*at, "controls", name)
    for id, item in made.nodes.items():
        mine, other = ours.nodes.get(id), theirs.nodes.get(id)
        if isinstance(item, Group) and isinstance(mine, Group) and isinstance(other, Group):
            yield from faults(item.graph, mine.graph, other.graph, (*at, "nodes", id, "graph"))


def _is_gone(graph: Graph, port: Port) -> bool:
    """True for what is no value of a node of a known type."""
    item = graph.nodes.get(port.node)
    face = None if item is None else signature(item)
    return face is None or not (face.anything or port.socket in face.values)


def _looping(made: Graph, ours: Graph) -> Iterator[Port]:
    """Links in a loop that are not ours."""
    steps = {id: sorted(made.feeding[id]) for id in sorted(made.nodes)}
    for loop in loops(steps):
        around = set(pairwise(loop))
        for target, source in made.links.items():
            if (target.node, source.node) in around and ours.links.get(target) != source:
                yield target
