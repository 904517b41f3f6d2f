"""Values of nodes and of groups: defaults, animation, controls and colors."""

from __future__ import annotations

from dataclasses import replace

from halation.nodes import Node

from ...errors import GraphError
from ...graph import (
    ANIMATED,
    Expression,
    Graph,
    Group,
    Port,
    animation_fault,
    find_declaration,
    list_sockets,
    signature,
)


def animatable_values(graph: Graph, id: str) -> tuple[Port, ...]:
    """The values of a node that can change over time."""
    if id not in graph.nodes:
        return ()
    item = graph.nodes[id]
    sockets = (socket for name in signature(item).values for socket in list_sockets(item, name))
    return tuple(Port(id, socket) for socket in sockets if can_animate(graph, Port(id, socket)))


def can_animate(graph: Graph, port: Port) -> bool:
    """True if a value can change over time."""
    try:
        return graph.declaration(port).type in ANIMATED
    except GraphError:
        return False


def find_expression_fault(graph: Graph, port: Port, text: str) -> str | None:
    """Why a value cannot follow an expression that the user typed, with a caret below its text, or None."""
    return animation_fault(graph, port, Expression(text.strip().removeprefix("=").strip()))


def find_control(graph: Graph, port: Port) -> str | None:
    """The name of the control of a group that shows a value, if any."""
    return next((name for name, control in graph.controls.items() if control.target == port), None)


def is_default(graph: Graph, port: Port) -> bool:
    """True if a value is as it is in a new node, at all frames."""
    is_animated = port in graph.animation or port in graph.keyed_points
    return not is_animated and graph.value(port) == reset_value(graph, port).value(port)


def fit_color(graph: Graph, port: Port, value: object) -> object:
    """A color as the value takes it: pickers give four numbers, one too many for a color without alpha."""
    item = graph.nodes.get(port.node)
    declaration = None if item is None else find_declaration(item, port.socket)
    is_rgb = declaration is not None and declaration.type == "color" and declaration.length == 3
    return value[:3] if is_rgb and isinstance(value, tuple) and len(value) == 4 else value


def reset_value(graph: Graph, port: Port) -> Graph:
    """A graph where a value is at its default, at all frames."""
    graph.value(port)
    graph = graph.animate(port, None) if port in graph.animation else graph
    item = graph.node(port.node)
    declaration = find_declaration(item, port.socket)
    if port != port.whole and declaration:
        return graph.put(port, declaration.default)
    if isinstance(item, Group):
        values = {name: plain for name, plain in item.values.items() if name != port.socket}
        return replace(graph, nodes={**graph.nodes, port.node: replace(item, values=values)})
    return graph.put(port, item.declaration(port.socket).default) if isinstance(item, Node) else graph
