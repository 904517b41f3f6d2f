"""Applies the edit of a field to the values of one or several nodes. Nothing here draws."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, cast

from halation.nodes import REFERENCE_HEIGHT, ItemSet, Node, Plain, Value, is_length, name_reference

from ...authoring.commands import ReplaceGraph, ResetValue, SetValue, SetValues
from ...errors import GraphError, UsageError
from ...graph import Graph, Port, Unknown, find_declaration, signature
from ...graph.named_items import describe_items
from ...graph.scalars import describe_scalar
from ...language.translation import translate
from ..fields.fields import Edit
from ..fields.numbers import parse_number

if TYPE_CHECKING:
    from ...authoring.session import Session

Ports = tuple[Port, ...]


def apply(session: Session, ports: Ports, declaration: Value, edit: Edit) -> None:
    """Apply an edit to the value of every port, as one step; a relative number (`+1`) applies to each old value."""
    if len(ports) == 1:
        session.apply(SetValue(ports[0], edit.value, merge=edit.merge))
        return
    values = {port: _for_one(session, port, declaration, edit) for port in ports}
    session.apply(
        SetValues(
            values, translate("Set {name} of {count} nodes", name=declaration.name, count=len(ports)), merge=edit.merge
        )
    )


def reset(session: Session, ports: Ports) -> None:
    """Set the values of all ports back to their defaults, as one step."""
    if len(ports) == 1:
        session.apply(ResetValue(ports[0]))
        return
    graph = session.graph
    for port in ports:
        graph = graph.animate(port, None).set(port, default_of(graph, port))
    session.apply(
        ReplaceGraph(translate("Reset {socket} of {count} nodes", socket=ports[0].socket, count=len(ports)), graph)
    )


def default_of(graph: Graph, port: Port) -> Plain:
    """The default of a value: its number in a new node."""
    declaration = find_declaration(graph.node(port.node), port.socket)
    return graph.value(port) if declaration is None else declare(graph, port, declaration).default


def declare(graph: Graph, port: Port, declaration: Value) -> Value:
    """The declaration of a value in the unit that its number has in a graph."""
    item = graph.nodes.get(port.node)
    is_general = not is_length(declaration) and not declaration.listed_in
    if is_general or not isinstance(item, Node) or port.socket not in item.values:
        return declaration
    return item.declaration(port.socket, graph.settings.reference_height)


def list_other_units(graph: Graph, port: Port, declaration: Value) -> tuple[str, ...]:
    """The units in which a length could be given instead; empty for other values."""
    item = graph.nodes.get(port.node)
    if not isinstance(item, Node) or port.socket not in item.values or not is_length(item.values[port.socket]):
        return ()
    reference = name_reference(graph.settings.reference_height or REFERENCE_HEIGHT)
    return tuple(unit for unit in (reference, "px", "height") if unit != declaration.unit)


def find_height(graph: Graph, shown: int) -> int:
    """The height of the picture for which numbers are converted: that which is shown, else that of the canvas."""
    return shown if shown > 1 else graph.settings.size[1] if graph.settings.size else REFERENCE_HEIGHT


def common(graph: Graph, ids: tuple[str, ...]) -> tuple[Value, ...]:
    """The values that all nodes have in common by name and type, as the first node declares them."""
    interfaces = [signature(item) for id in ids if not isinstance(item := graph.nodes[id], Unknown)]
    if len(interfaces) < len(ids) or not interfaces:
        return ()
    return tuple(
        value
        for name, value in interfaces[0].values.items()
        if all(name in interface.values and _alike(interface.values[name], value) for interface in interfaces[1:])
    )


def as_text(declaration: Value, value: Plain) -> str:
    """A value for the clipboard."""
    if isinstance(value, ItemSet):
        return json.dumps(describe_items(declaration.items, value) if declaration.items else {})
    return json.dumps(describe_scalar(declaration, value))


def from_text(text: str) -> Any:
    """A value from the clipboard, as JSON holds it. Raises UsageError."""
    try:
        parsed = json.loads(text)
    except ValueError:
        return text.strip()
    if isinstance(parsed, list):
        parsed = tuple(parsed)
    are_items = isinstance(parsed, dict) and all(
        isinstance(part, dict) for part in cast("dict[str, Any]", parsed).values()
    )
    if not are_items and not isinstance(parsed, int | float | bool | str | tuple):
        raise UsageError(translate("the clipboard holds no value: copy one first"))
    return parsed


def _for_one(session: Session, port: Port, declaration: Value, edit: Edit) -> Plain:
    old = session.time.evaluate(port)
    if not edit.text or declaration.type not in ("float", "int") or not isinstance(old, int | float):
        return edit.value
    try:
        return parse_number(edit.text, old, declaration)
    except UsageError as error:
        raise GraphError(f"{port}: {error}") from None


def _alike(first: Value, second: Value) -> bool:
    return (first.type, first.length, first.choices) == (second.type, second.length, second.choices)
