"""Layers of a render that a new node needs, found behind what feeds it: fog after a bloom takes the depth by itself."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from halation.nodes import Node

from ...graph import INPUTS, Graph, Port, signature
from .element_id import ElementId
from .wiring import why_not_linkable

_LAYERS = frozenset(
    ("albedo", "camera", "depth", "emission", "material_id", "normal", "object_id", "position", "uv", "velocity")
)
"""Sockets that say the same of a pixel wherever they stand: what surface it shows, and how the camera saw it."""

_MOVING = frozenset(("distort", "time"))
"""Categories of nodes whose pixels are no longer where, or when, the layers of their render are."""


def connect_layers(graph: Graph, id: str, feeders: Iterable[ElementId], absent: Collection[Port] = ()) -> Graph:
    """A graph where the free sockets of node `id` for layers are fed by the nearest nodes, or inputs of the graph, that
    offer one of the same name and lie behind `feeders`; not beyond nodes that move pixels. Outputs in `absent` have
    nothing to give.
    """
    wanted = [Port(id, name) for name in signature(graph.nodes[id]).unfolded_inputs if name in _LAYERS]
    for source in _walk_behind(graph, feeders):
        for target in wanted:
            port = Port(source, target.socket)
            if target in graph.links or port in absent or not _offers(graph, port):
                continue
            if why_not_linkable(graph, port, target) is None:
                graph = graph.connect(port, target)
    return graph


def list_behind(graph: Graph, feeders: Iterable[ElementId]) -> list[str]:
    """The nodes whose layers a node that `feeders` feed may take, the nearest first."""
    return [id for id in _walk_behind(graph, feeders) if id != INPUTS]


def _offers(graph: Graph, port: Port) -> bool:
    if port.node == INPUTS:
        return port.socket in graph.inputs
    return port.socket in signature(graph.nodes[port.node]).outputs


def _walk_behind(graph: Graph, feeders: Iterable[ElementId]) -> Iterator[str]:
    """Feeders, then what feeds them, then what feeds that; nothing behind nodes that move pixels."""
    row = list(dict.fromkeys(INPUTS if element.kind == "input" else str(element) for element in feeders))
    seen = set(row)
    while row:
        behind = list[str]()
        for id in row:
            if id != INPUTS and id not in graph.nodes:
                continue  # an output, a frame, a comment
            yield id
            if id != INPUTS and not _moves_pixels(graph, id):
                sources = {start.node for end, start in graph.links.items() if end.node == id}
                behind += sorted(sources - seen)
                seen |= sources
        row = behind


def _moves_pixels(graph: Graph, id: str) -> bool:
    item = graph.nodes[id]
    return isinstance(item, Node) and item.category in _MOVING
