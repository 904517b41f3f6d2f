"""What a node shows depends on everything upstream of it: one hash per node says whether any of that changed."""

from __future__ import annotations

from hashlib import blake2b

from ..errors import GraphError
from ..graph import INPUTS, OUTPUTS, Graph, Port
from .expand import Flat, expand


def upstream_hashes(graph: Graph) -> dict[str, str]:
    """A hash by path of every node (`glow/bloom`), group (`glow`) and input (`inputs.beauty`, `glow/inputs.image`).

    It changes with the node, its values and links, and with those of all that feed it; not with pictures bound to the
    graph. What cannot be rendered, because it goes in a circle say, has none.
    """
    try:
        return _Hashes(graph).found
    except GraphError:
        return {}


class _Hashes:
    """The work in progress."""

    def __init__(self, graph: Graph) -> None:
        self.flat: Flat = expand(graph)
        self.settings = repr(graph.settings)
        self.found: dict[str, str] = {}
        for path in self._order():
            self._node(path)
        for end in (*self.flat.inputs, *self.flat.links):
            group, _, side = end.node.rpartition("/")
            if side == INPUTS:
                self.found[f"{end}"] = self._of(self.flat.behind(end))
            elif side == OUTPUTS and group:
                self.found[group] = _hash(self.found.get(group, ""), end.socket, self._of(self.flat.behind(end)))

    def _order(self) -> list[str]:
        paths = [Port(path, "") for path in self.flat.nodes]
        try:
            return self.flat.order(paths)
        except GraphError:  # something is wrong somewhere: take what can be had
            found: dict[str, None] = {}
            for path in paths:
                try:
                    found |= dict.fromkeys(self.flat.order((path,)))
                except GraphError:
                    continue
            return list(found)

    def _node(self, path: str) -> None:
        node = self.flat.nodes[path]
        values = {name: getattr(node, name) for name in node.values}
        sources = [self.flat.source(Port(path, name)) for name in (*node.inputs, *node.values)]
        read = [f"{source} {self._of(source)}" if source else "-" for source in sources]
        self.found[path] = _hash(node.category, node.id, values, path in self.flat.muted, self.settings, *read)

    def _of(self, source: Port) -> str:
        """The hash of what a link starts at."""
        if source in self.flat.inputs:
            return _hash(f"{source}", self.flat.inputs[source], self.settings)
        return self.found.get(source.node, "")


def _hash(*parts: object) -> str:
    return blake2b("\0".join(str(part) for part in parts).encode(), digest_size=16).hexdigest()
