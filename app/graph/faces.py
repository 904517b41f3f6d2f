"""What nodes and groups show to links, and which values they have."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from ...nodes import Node, Pointwise, Value
from ..errors import GraphError
from .group import Group, Item
from .names import did_you_mean
from .parts import Signature, Unknown

if TYPE_CHECKING:
    from .graph import Graph


def signature(item: Item) -> Signature:
    """What a node shows to links. A group shows its body's ends, and its controls as values."""
    if isinstance(item, Node):
        outputs = {name: output.socket for name, output in item.outputs.items()}
        return Signature(item.inputs, outputs, item.values, pointwise=isinstance(item, Pointwise))
    if isinstance(item, Unknown):
        return Signature({}, {}, {}, anything=True)
    inputs = {name: end.socket(name) for name, end in item.graph.inputs.items()}
    outputs = {name: end.socket(name) for name, end in item.graph.outputs.items()}
    values = {name: value for name in item.graph.controls if (value := control_value(item.graph, name))}
    return Signature(inputs, outputs, values)


def control_value(graph: Graph, name: str) -> Value | None:
    """The value behind a control, called by the control's name, its present setting as the default."""
    control = graph.controls[name]
    item = graph.nodes.get(control.target.node)
    value = None if item is None else _present(item, control.target.socket)
    return value and dataclasses.replace(value, name=name, doc=control.doc or value.doc)


def declared(item: Item, name: str, id: str) -> Value:
    """A value of a node or control of a group with its present setting as the default. Raises GraphError."""
    if value := _present(item, name):
        return value
    face = signature(item)
    if face.anything:
        raise GraphError(f"'{id}.{name}' cannot be set: the type of node '{id}' is unknown")
    if name in face.inputs:
        raise GraphError(f"'{id}.{name}' is an input, not a value: link something to it")
    raise GraphError(f"node '{id}' has no value '{name}'{did_you_mean(name, face.values)}")


def _present(item: Item, name: str) -> Value | None:
    if isinstance(item, Node) and name in item.values:
        return dataclasses.replace(item.values[name], default=getattr(item, name))
    if isinstance(item, Group) and name in item.graph.controls and (value := control_value(item.graph, name)):
        return dataclasses.replace(value, default=item.values.get(name, value.default))
    return None


def is_pointwise(item: Item, name: str) -> bool:
    """True if value `name` of a node, or what a control of a group turns, can be wired."""
    while isinstance(item, Group):
        target = item.graph.controls[name].target
        item, name = item.graph.nodes[target.node], target.socket
    return isinstance(item, Pointwise)
