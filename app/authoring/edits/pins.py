"""How far below the top of an element its sockets are."""

from __future__ import annotations

from collections.abc import Mapping

from ...graph import Graph, Port, signature
from .element_id import ElementId
from .elements import entry
from .sizes import HEADER, ROW

Pins = Mapping[tuple[Port, bool], float]
"""The heights of sockets below the tops of their elements, by port and whether it is an output; in canvas units."""


def pin_height(graph: Graph, port: Port, output: bool, measured: Pins | None = None) -> float:
    """How far below the top of its element a socket is: as measured, or a guess from the order of sockets."""
    if measured and (port, output) in measured:
        return measured[port, output]
    item = graph.nodes.get(port.node)
    if item is None or entry(graph, ElementId(port.node)).get("collapsed") is True:
        return HEADER / 2
    interface = signature(item)
    inputs = interface.unfolded_inputs
    names = [*interface.outputs] if output else [*inputs]
    if port.socket in names:
        return HEADER + ROW * (names.index(port.socket) + 0.5)
    if output or port.socket not in interface.values:
        return HEADER / 2
    return HEADER + ROW * (max(len(inputs), len(interface.outputs)) + 0.5)
