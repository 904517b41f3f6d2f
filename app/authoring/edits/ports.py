"""Ports that the viewer can show."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Port, signature

VIEWER_NUMBERS = range(1, 10)
"""The number keys that recall a port."""


def read_port(text: object) -> Port | None:
    """The port that a text of `graph.ui` names, such as `blur.out`; None if it names none."""
    try:
        return Port.parse(text) if isinstance(text, str) else None
    except GraphError:
        return None


def output_ports(graph: Graph, id: str) -> list[Port]:
    """The outputs of a node."""
    return [Port(id, name) for name in signature(graph.node(id)).outputs]


def is_viewable(graph: Graph, port: Port) -> bool:
    """True for an output of a node and for an end of the graph."""
    if port.node == INPUTS:
        return port.socket in graph.inputs
    if port.node == OUTPUTS:
        return port.socket in graph.outputs
    return port.node in graph.nodes and port.socket in signature(graph.nodes[port.node]).outputs


def default_view(graph: Graph) -> Port | None:
    """What the viewer shows by default: the first linked output, else that of the last node, else an input."""
    for name in graph.outputs:
        if Port(OUTPUTS, name) in graph.links:
            return Port(OUTPUTS, name)
    try:
        order = graph.order()
    except GraphError:
        order = tuple(graph.nodes)
    ports = (port for id in reversed(order) for port in output_ports(graph, id))
    return next(ports, None) or next((Port(INPUTS, name) for name in graph.inputs), None)


def list_numbered_ports(graph: Graph) -> Mapping[int, Port]:
    """The ports that the number keys recall, as far as they exist."""
    section, ports = graph.ui.get("viewers"), dict[int, Port]()
    for number in VIEWER_NUMBERS:
        text = section.get(str(number)) if isinstance(section, Mapping) else None
        port = read_port(text)
        if port is not None and is_viewable(graph, port):
            ports[number] = port
    return MappingProxyType(ports)
