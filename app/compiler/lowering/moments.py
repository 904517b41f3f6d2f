"""A graph at one frame or several: what changes over time stands still in each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set

from halation.nodes import Node
from msgspec.structs import replace

from ...errors import GraphError
from ...graph import Graph, Port, evaluate_at_frame, is_animated
from .expand import FlatGraph, expand, find_changed_nodes

Moment = tuple[str, int]
"""A node, as a path through groups, at a frame."""

Feed = tuple[Port, tuple[int, ...]]
"""What a link starts at, and the frames at which that is seen."""


class Moments:
    """The flat graph of every frame that is asked for. All have the same nodes and links; values differ."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._moves = is_animated(graph)
        self._flats: dict[int, tuple[Graph, FlatGraph]] = {}
        self._changed: dict[int, Set[str]] = {}
        self._feeding: dict[Moment, Mapping[str, Feed]] = {}

    def flat(self, frame: int) -> FlatGraph:
        """The graph at a frame."""
        key = frame if self._moves else 0
        if key not in self._flats:
            graph = evaluate_at_frame(self._graph, frame)
            self._flats[key] = graph, expand(graph)
        return self._flats[key][1]

    def follow(self, graph: Graph, frame_before: int, frame_after: int) -> Moments | None:
        """The same of a graph that differs in values of nodes only, which `changed` tells; else None.

        `now` is looked from instead of `before`. Where these are two frames, no node may look at others.
        """
        after = Moments(graph)
        if after._moves != self._moves:
            return None
        if frame_before == frame_after:
            after._feeding = self._feeding
        elif len(self._flats) > 1 or any(map(looks_around, self.flat(frame_before).nodes.values())):
            return None
        for key, (old, flat) in self._flats.items():
            frame = key if frame_before == frame_after or not self._moves else frame_after
            new = evaluate_at_frame(graph, frame)
            changed = find_changed_nodes(old, new)
            if changed is None:
                return None
            after._flats[frame] = new, replace(flat, nodes={**flat.nodes, **changed})
            after._changed[frame] = changed.keys()
        return after

    def changed_nodes(self, frame: int) -> Set[str]:
        """The nodes that are others at a frame than they were at that one, or before now, in the graph followed."""
        return self._changed[frame if self._moves else 0]

    def node(self, path: str, frame: int) -> Node:
        """A node at a frame."""
        return self.flat(frame).nodes[path]

    def find_feeds(self, moment: Moment) -> Mapping[str, Feed]:
        """What a node reads, by input or value. Raises GraphError for links that cannot be."""
        if moment not in self._feeding:
            self._feeding[moment] = self._collect_feeds(moment)
        return self._feeding[moment]

    def order(self, starts: Iterable[Port], frame: int) -> list[Moment]:
        """Every node that `starts` need at `frame`, at the frames at which it is needed, after what it reads.

        Raises GraphError for a node of unknown type, and for one that feeds itself.
        """
        order: list[Moment] = []
        visited: set[Moment] = set()
        open_: set[str] = set()
        todo: list[tuple[Moment, bool]] = [((port.node, frame), False) for port in starts]
        while todo:
            moment, leaving = todo.pop()
            path = moment[0]
            if leaving:
                open_.discard(path)
                visited.add(moment)
                order.append(moment)
                continue
            flat = self.flat(moment[1])
            if path in flat.unknown:
                item = flat.unknown[path]
                fault = item.fault or f"its type '{item.type}' is unknown to this version of Halation"
                raise GraphError(f"node '{path}': {fault}", node=path)
            if moment in visited or path not in flat.nodes:
                continue
            if path in open_:
                raise GraphError(f"node '{path}' feeds itself: cut one link of the loop", node=path)
            open_.add(path)
            todo.append((moment, True))
            for source, frames in self.find_feeds(moment).values():
                todo.extend(((source.node, at), False) for at in frames if (source.node, at) not in visited)
        return order

    def _collect_feeds(self, moment: Moment) -> dict[str, Feed]:
        path, frame = moment
        flat = self.flat(frame)
        node = flat.nodes[path]
        times = node.times(frame)
        feeds: dict[str, Feed] = {}
        for name in (*node.inputs, *node.values):
            source = flat.source(Port(path, name))
            if source is not None:
                feeds[name] = (source, times.get(name, (frame,)))
        return feeds


def looks_around(node: Node) -> bool:
    """True for a node that may see other frames than its own."""
    return type(node).times is not Node.times
