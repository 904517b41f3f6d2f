"""How many pixels the lengths of a graph are, for pictures of the size that is rendered."""

from __future__ import annotations

from collections.abc import Iterator

from halation.nodes import Plain, is_length
from msgspec import Struct

from ..graph import Graph, Port
from ..resources.provider import ResourceProvider
from .lowering.lower import lower
from .planner import graph_library
from .request import Request


class ResolvedLength(Struct, frozen=True):
    """A length of a node: its number, the unit of that, and how many pixels it is."""

    port: Port
    number: Plain
    unit: str
    pixels: Plain

    def __str__(self) -> str:
        return f"{self.port}  {_spell(self.number)} {self.unit} = {_spell(self.pixels)} pixels"


def resolve_lengths(graph: Graph, request: Request, provider: ResourceProvider) -> tuple[ResolvedLength, ...]:
    """The lengths of all nodes that are rendered, in the order of the nodes. Raises GraphError."""
    return tuple(_list_lengths(graph, request, provider))


def _list_lengths(graph: Graph, request: Request, provider: ResourceProvider) -> Iterator[ResolvedLength]:
    record = lower(graph, request, graph_library(graph, provider), provider)
    flat = record.frames.flat_at(record.frame)
    for key, step in record.steps.items():
        if key is None or key[1] or not step.length_height:
            continue
        path = key[0]
        node, reference_height = record.frames.node_at(path, record.frame), flat.find_reference_height(path)
        working = node.to_working_units(request.scale, step.length_height, reference_height)
        for name, value in node.values.items():
            port = Port(path, name)
            if is_length(value) and flat.find_source(port) is None:
                unit = node.declaration(name, reference_height).unit or ""
                yield ResolvedLength(port, node.setting(name), unit, working.setting(name))


def _spell(plain: Plain) -> str:
    return ", ".join(f"{part:.6g}" for part in (plain if isinstance(plain, tuple) else (plain,)))
