"""A graph at one frame or several: animated values are evaluated at each of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set

from halation.nodes import Node
from msgspec.structs import replace

from ...errors import GraphError
from ...graph import Graph, Port, evaluate_at_frame, is_animated
from ...graph.unknown_nodes import explain_unknown
from .expand import FlatGraph, expand, find_changed_nodes

NodeAtFrame = tuple[str, int]
"""The path of a node through groups, and a frame."""

Feed = tuple[Port, tuple[int, ...]]
"""Where a link starts, and the frames at which its pictures are read."""


class GraphAtFrames:
    """The flat graph at every frame that is asked for. All have the same nodes and links; values differ."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._is_animated = is_animated(graph)
        self._flats: dict[int, tuple[Graph, FlatGraph]] = {}
        self._between: dict[float, FlatGraph] = {}
        self._changed: dict[int, Set[str]] = {}
        self._feeding: dict[NodeAtFrame, Mapping[str, Feed]] = {}

    def flat_at(self, frame: int) -> FlatGraph:
        """The graph at a frame."""
        key = frame if self._is_animated else 0
        if key not in self._flats:
            graph = evaluate_at_frame(self._graph, frame)
            self._flats[key] = graph, expand(graph)
        return self._flats[key][1]

    def follow(self, graph: Graph, frame_before: int, frame_after: int) -> GraphAtFrames | None:
        """The flat graphs of an edited graph, made of these ones; None if more than values of nodes differ.

        It is evaluated at `frame_after`, where this one was at `frame_before`. If these differ, no node may read other
        frames than its own. `nodes_changed_at` then says which nodes differ.
        """
        after = GraphAtFrames(graph)
        if after._is_animated != self._is_animated:
            return None
        if frame_before == frame_after:
            after._feeding = self._feeding
        elif len(self._flats) > 1 or any(map(sees_other_frames, self.flat_at(frame_before).nodes.values())):
            return None
        for key, (old, flat) in self._flats.items():
            frame = key if frame_before == frame_after or not self._is_animated else frame_after
            new = evaluate_at_frame(graph, frame)
            changed = find_changed_nodes(old, new)
            if changed is None:
                return None
            after._flats[frame] = new, replace(flat, nodes={**flat.nodes, **changed})
            after._changed[frame] = changed.keys()
        return after

    def nodes_changed_at(self, frame: int) -> Set[str]:
        """The nodes that differ at a frame from those of the graph that this one follows."""
        return self._changed[frame if self._is_animated else 0]

    def node_at(self, path: str, frame: int) -> Node:
        """A node at a frame."""
        return self.flat_at(frame).nodes[path]

    def node_between(self, path: str, time: float) -> Node:
        """A node at a time in frames, which may lie between two of them."""
        if not self._is_animated or time.is_integer():
            return self.node_at(path, int(time))
        if time not in self._between:
            self._between[time] = expand(evaluate_at_frame(self._graph, time))
        return self._between[time].nodes[path]

    def find_feeds(self, moment: NodeAtFrame) -> Mapping[str, Feed]:
        """What a node reads, by input or value. Raises GraphError for an invalid link."""
        if moment not in self._feeding:
            self._feeding[moment] = self._collect_feeds(moment)
        return self._feeding[moment]

    def find_order(self, starts: Iterable[Port], frame: int) -> list[NodeAtFrame]:
        """Every node that `starts` need at `frame`, at the frames at which it is needed, after what it reads.

        A search in depth, with a list in place of recursion, because graphs may be deeper than Python's stack. Every
        node is on the list twice: to be entered, and to be left after all that it reads. One that is entered again
        before it is left feeds itself.

        Raises GraphError for a node of unknown type, and for one that feeds itself.
        """
        order: list[NodeAtFrame] = []
        visited: set[NodeAtFrame] = set()
        open_: set[str] = set()
        todo: list[tuple[NodeAtFrame, bool]] = [((port.node, frame), False) for port in starts]
        while todo:
            moment, leaving = todo.pop()
            path = moment[0]
            if leaving:
                open_.discard(path)
                visited.add(moment)
                order.append(moment)
                continue
            flat = self.flat_at(moment[1])
            if path in flat.unknown:
                raise GraphError(explain_unknown(path, flat.unknown[path])[0], node=path)
            if moment in visited or path not in flat.nodes:
                continue
            if path in open_:
                raise GraphError(f"node '{path}' feeds itself: cut one link of the loop", node=path)
            open_.add(path)
            todo.append((moment, True))
            for source, frames in self.find_feeds(moment).values():
                todo.extend(((source.node, at), False) for at in frames if (source.node, at) not in visited)
        return order

    def _collect_feeds(self, moment: NodeAtFrame) -> dict[str, Feed]:
        path, frame = moment
        flat = self.flat_at(frame)
        node, linked = flat.nodes[path], flat.linked.get(path, ())
        times: Mapping[str, tuple[int, ...]] = {} if path in flat.muted else node.times(frame)
        feeds: dict[str, Feed] = {}
        if len(linked) == 1:  # the usual case
            names = linked if linked[0] in node.inputs or linked[0] in node.values else ()
        else:
            names = (*node.inputs, *node.values) if linked else ()
        for name in names:
            source = flat.find_source(Port(path, name))
            if source is not None:
                feeds[name] = (source, times.get(name, (frame,)))
        return feeds


def sees_other_frames(node: Node) -> bool:
    """True for a node that may read other frames than its own."""
    return type(node).times is not Node.times
