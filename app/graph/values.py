"""Checks settings of values, and converts them to the type of the value."""

from __future__ import annotations

from halation.nodes import Plain, Value

from .named_items import coerce_items, items_fault
from .scalars import FLOAT32, coerce_numbers, coerce_scalar, describe_type, scalar_fault, sequence_fault

__all__ = ["coerce", "coerce_numbers", "describe_type", "sequence_fault", "value_fault"]


def coerce(value: Value, setting: object) -> Plain | None:
    """A setting converted to the type of a value (an int to a float, a list to a tuple), or None if it does not fit.

    Ranges and choices are not checked: see `value_fault`.
    """
    if value.type == "float" and type(setting) is float:
        return setting  # the usual case
    return coerce_items(value, setting) if value.items else coerce_scalar(value, setting)


def value_fault(value: Value, setting: object) -> str | None:
    """Why a setting is invalid (type, hard range, choice, not finite), or None."""
    if value.type == "float" and isinstance(setting, float) and _fits(value, setting):
        return None  # the usual case: a graph may have 100,000 of them
    return items_fault(value, setting) if value.items else scalar_fault(value, setting)


def _fits(value: Value, number: float) -> bool:
    return value.minimum <= number <= value.maximum and abs(number) <= FLOAT32
