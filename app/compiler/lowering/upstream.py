"""One hash per node of everything upstream of it: it changes when anything that the node's picture depends on does.

Thumbnails use it: one walk says for every node whether its picture is old, and an edit that is undone finds the hashes
that it had. Animation counts as a whole, also that of other nodes.
"""

from __future__ import annotations

from halation.nodes import Node
from msgspec.structs import replace

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Group, Port, is_animated
from ..ir.identity import hash_parts
from .expand import FlatGraph, find_changed_nodes
from .graph_at_frames import GraphAtFrames


class UpstreamHashes:
    """A hash by path of every node (`glow/bloom`), group (`glow`) and input (`inputs.beauty`, `glow/inputs.image`).

    It changes with the node, its values and links, those of all nodes that feed it, and the frame; not with pictures
    bound to the graph. A node that cannot be rendered, because it is part of a loop say, has none.

    If only values of nodes differ from the graph of `before`, as while a slider is dragged, only the nodes downstream
    of these are hashed again.
    """

    def __init__(self, graph: Graph, frame: int = 1, before: UpstreamHashes | None = None) -> None:
        self.graph, self.frame = graph, frame
        self.hashes: dict[str, str] = {}
        follows = before and before.frame == frame and not is_animated(graph)
        changed = find_changed_nodes(before.graph, graph) if before and follows else None
        try:
            if before is None or changed is None:
                self._find_all()
            else:
                self._follow(before, changed)
        except GraphError:
            self.hashes = {}

    def _find_all(self) -> None:
        frames = GraphAtFrames(self.graph)
        self._flat: FlatGraph = frames.flat_at(self.frame)
        # A node may read other frames, at which animated values differ: so all animation counts.
        self._settings = repr((self.graph.settings, self.frame, _collect_animations(self.graph)))
        self._reads = {path: self._find_sources(path) for path in self._find_order(frames)}
        for path in self._reads:
            self._hash_node(path)
        self._ends = [
            end
            for end in (*self._flat.inputs, *self._flat.links)
            if end.node.rpartition("/")[2] == INPUTS or end.node.endswith(f"/{OUTPUTS}")
        ]
        self._hash_ends()

    def _follow(self, before: UpstreamHashes, changed: dict[str, Node]) -> None:
        self.hashes = dict(before.hashes)
        if not before.hashes:
            return
        self._flat = replace(before._flat, nodes={**before._flat.nodes, **changed})
        self._settings, self._reads, self._ends = before._settings, before._reads, before._ends
        reached = set(changed)
        for path, sources in self._reads.items():
            if path in reached or any(source and source.node in reached for source in sources):
                reached.add(path)
                self._hash_node(path)
        self._hash_ends()

    def _find_order(self, frames: GraphAtFrames) -> list[str]:
        paths = [Port(path, "") for path in self._flat.nodes]
        try:
            return list(dict.fromkeys(path for path, _ in frames.find_order(paths, self.frame)))
        except GraphError:  # some nodes cannot be rendered: take those that can
            paths_: dict[str, None] = {}
            for path in paths:
                try:
                    paths_ |= dict.fromkeys(node for node, _ in frames.find_order((path,), self.frame))
                except GraphError:
                    continue
            return list(paths_)

    def _find_sources(self, path: str) -> list[Port | None]:
        node = self._flat.nodes[path]
        return [self._flat.find_source(Port(path, name)) for name in (*node.inputs, *node.values)]

    def _hash_node(self, path: str) -> None:
        node = self._flat.nodes[path]
        read = [f"{source} {self._hash_source(source)}" if source else "-" for source in self._reads[path]]
        units = node.length_units, self._flat.find_reference_height(path)
        self.hashes[path] = hash_parts(
            node.shader, node.settings, units, path in self._flat.muted, self._settings, *read
        )

    def _hash_ends(self) -> None:
        groups: dict[str, str] = {}
        for end in self._ends:
            group, _, side = end.node.rpartition("/")
            if side == INPUTS:
                self.hashes[f"{end}"] = self._hash_source(self._flat.follow(end))
            else:
                groups[group] = hash_parts(groups.get(group, ""), end.socket, self._hash_source(self._flat.follow(end)))
        self.hashes |= groups

    def _hash_source(self, source: Port) -> str:
        """The hash of the port that a link starts at."""
        if source in self._flat.inputs:
            return hash_parts(f"{source}", self._flat.inputs[source], self._settings)
        return self.hashes.get(source.node, "")


def _collect_animations(graph: Graph) -> list[object]:
    """How values change over time, in groups too."""
    inner = [_collect_animations(item.graph) for item in graph.nodes.values() if isinstance(item, Group)]
    return [
        sorted(graph.animation.items(), key=lambda item: item[0]),
        *(animation for animation in inner if any(animation)),
    ]
