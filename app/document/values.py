"""Values of nodes as a file has them, and the units of lengths among them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any

from halation.nodes import LengthUnits, Node, Plain, Value, length_unit_fault

from ..errors import DocumentError
from ..graph.named_items import find_item_faults
from ..graph.names import did_you_mean
from ..graph.values import coerce, describe_type
from .records import NodeRecord
from .syntax import member, word

DAMAGED = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
"""Exceptions that a migration may raise if the old file is damaged."""


def upgrade_values(kind: type[Node], record: NodeRecord, file: str, at: str) -> dict[str, Any]:
    """The values of a node, brought up to the present version of its type. Raises DocumentError."""
    values = record.values
    try:
        for version in range(record.version, kind.version):
            values = dict(kind.upgrade(version, dict(values)))
    except DAMAGED:
        fault = f"the values do not fit version {record.version} of '{kind.id}': correct them, or remove the node"
        raise DocumentError(file, member(at, "values"), fault) from None
    return values


def read_units(raw: Mapping[str, str], declared: Mapping[str, Value], file: str, at: str) -> LengthUnits:
    """The units of lengths. Raises DocumentError for a value that is no length, and for an unknown unit."""
    if not raw:
        return ()
    for name, unit in raw.items():
        fault = (
            length_unit_fault(declared[name], unit)
            if name in declared
            else f"there is no value '{name}'{did_you_mean(name, declared)}"
        )
        if fault:
            raise DocumentError(file, member(member(at, "units"), name), fault)
    return tuple(sorted(raw.items()))


def convert_value(value: Value, setting: object, file: str, at: str) -> Plain:
    """A setting of the node at JSON path `at`, converted to its type. Raises DocumentError.

    Ranges and choices are not checked: `problems` does that.
    """
    plain = coerce(value, setting)
    if plain is not None:
        return plain
    where = member(member(at, "values"), value.name)
    fault = f"expected {describe_type(value)}, got {word(setting)}"
    for place, sentence in find_item_faults(value, setting) if value.items else ():
        where = reduce(member, place, where)
        fault = sentence if isinstance(setting, dict) else fault
        break
    raise DocumentError(file, where, fault)
