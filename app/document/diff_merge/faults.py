"""Faults that a merge creates: what was correct on its own side is incorrect beside the changes of the other."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ...graph import Graph, Group, Port, find_declaration, signature
from ...graph.walk import find_loops
from .parts import PartPath


def find_merge_faults(merge: Graph, ours: Graph, theirs: Graph, at: PartPath = ()) -> Iterator[PartPath]:
    """Paths of links that no longer fit or are part of a loop, and of keys and controls whose value was deleted.

    Groups are searched too.
    """
    for target, source in merge.links.items():
        sides = (side for side in (ours, theirs) if side.links.get(target) == source)
        if merge.link_fault(source, target) and not any(side.link_fault(source, target) for side in sides):
            yield (*at, "links", str(target))
    for target in _links_in_loops(merge, ours):
        yield (*at, "links", str(target))
    for port in merge.animation:
        if _is_gone(merge, port) and not any(_is_gone(side, port) for side in (ours, theirs) if port in side.animation):
            yield (*at, "animation", str(port))
    for name, control in merge.controls.items():
        before = (side for side in (ours, theirs) if side.controls.get(name) == control)
        if _is_gone(merge, control.target) and not any(_is_gone(side, control.target) for side in before):
            yield (*at, "controls", name)
    for id, item in merge.nodes.items():
        our_item, their_item = ours.nodes.get(id), theirs.nodes.get(id)
        if isinstance(item, Group) and isinstance(our_item, Group) and isinstance(their_item, Group):
            yield from find_merge_faults(item.graph, our_item.graph, their_item.graph, (*at, "nodes", id, "graph"))


def _is_gone(graph: Graph, port: Port) -> bool:
    """True if a port is not a value of a node; a node of an unknown type may have any value."""
    item = graph.nodes.get(port.node)
    return item is None or not (signature(item).anything or find_declaration(item, port.socket))


def _links_in_loops(merge: Graph, ours: Graph) -> Iterator[Port]:
    """Links that are part of a loop and are not in our version."""
    steps = {id: sorted(merge.feeding[id]) for id in sorted(merge.nodes)}
    for loop in find_loops(steps):
        around = set(pairwise(loop))
        for target, source in merge.links.items():
            if (target.node, source.node) in around and ours.links.get(target) != source:
                yield target
