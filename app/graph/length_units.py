"""The units of lengths of a node: what its numbers mean in a graph, and how a unit is chosen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from halation.nodes import LengthUnits, Node, Value, is_length, length_unit_fault, resolve_length_unit
from msgspec import structs

from ..errors import GraphError
from .model import Port, Settings, Unknown


def resolve_unit(value: Value, item: object, settings: Settings) -> Value:
    """A value of a node of a body with these settings, in the unit that its number has there: px may be px@1080."""
    if not settings.reference_height or not isinstance(item, Node) or value.unit != "px":
        return value
    if value.name in dict(item.length_units):
        return value
    return structs.replace(value, unit=resolve_length_unit(value.unit, settings.reference_height))


def choose_length_unit(port: Port, item: object, unit: str, settings: Settings) -> Node:
    """The node where the number of a length is in another unit; the number remains. Raises GraphError.

    A unit that the graph says anyway is left out.
    """
    if not isinstance(item, Node):
        why = "its type is unknown" if isinstance(item, Unknown) else "choose it inside the group, at the node itself"
        raise GraphError(f"{port}: its unit cannot be chosen: {why}", node=port.node)
    if port.socket not in item.values:
        raise GraphError(f"node '{port.node}' has no value '{port.socket}'", node=port.node)
    value = item.values[port.socket]
    if fault := length_unit_fault(value, unit):
        raise GraphError(f"{port}: {fault}", node=port.node)
    units = {**dict(item.length_units), port.socket: unit}
    if unit == resolve_length_unit(value.unit, settings.reference_height):
        del units[port.socket]
    return item.with_length_units(tuple(units.items()))


def pin_node(node: Node, reference_height: int | None) -> Node:
    """The node with the units that its lengths have under a reference height."""
    units = {
        name: unit
        for name, value in node.values.items()
        if is_length(value) and value.unit == "px" and (unit := resolve_length_unit(value.unit, reference_height))
    }
    return node.with_length_units(tuple((units | dict(node.length_units)).items()))


def make_node(kind: type[Node], values: Mapping[str, Any], units: LengthUnits) -> Node:
    """A node. A length without a number has its default, converted to the unit that is chosen for it."""
    if not units:
        return kind(**values)
    plain = kind().with_length_units(units)
    return plain.with_values(**{name: plain.declaration(name).default for name, _ in units}).with_values(**values)
