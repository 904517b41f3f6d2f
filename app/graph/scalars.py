"""Checks settings of numbers, texts and lists of numbers, and converts them to the type of the value."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, cast

from halation.nodes import MAX_POINTS, ROWS, Scalar, Value, is_number

from ..errors import UsageError
from .frames import Pattern
from .names import name_several

_INT32 = 2**31
"""One above the largest int of GLSL."""
FLOAT32 = 3.4028234663852886e38
"""The largest number that 32 bits hold."""
_FEW = 16
"""Numbers that are looked at one by one: those of a matrix."""


def coerce_scalar(value: Value, setting: object) -> Scalar | None:
    """A setting converted to the type of a value (an int to a float, a list to a tuple), or None if it does not fit.

    Ranges and choices are not checked: see `scalar_fault`. For named items it is None.
    """
    match value.type:
        case "float":
            return _coerce_number(setting)
        case "int":
            return setting if isinstance(setting, int) and not isinstance(setting, bool) else None
        case "bool":
            return setting if isinstance(setting, bool) else None
        case "choice" | "path" | "text":
            if value.listed_in and isinstance(setting, int) and not isinstance(setting, bool):
                return str(setting)
            return setting if isinstance(setting, str) else None
        case "color" | "vector" | "matrix":
            return coerce_numbers(setting, value.length)
        case "curve" | "ramp":
            return _coerce_points(setting, value.length, 2)
        case "spline" | "stroke":
            return ROWS[value.type].read(setting)
        case "point":
            return ROWS["spline"].read((setting,))
        case "items":
            return None


def coerce_numbers(setting: object, length: int) -> tuple[float, ...] | None:
    """A list or tuple of `length` numbers as floats, else None."""
    if not isinstance(setting, list | tuple) or len(parts := cast("tuple[Any, ...]", setting)) != length:
        return None
    if set(map(type, parts)) == {float}:  # one by one, those of a long outline take a second
        return tuple(parts)
    floats = tuple(number for part in parts if (number := _coerce_number(part)) is not None)
    return floats if len(floats) == length else None


def _coerce_points(setting: object, width: int, least: int) -> tuple[float, ...] | None:
    """The numbers of at least `least` points of `width` numbers each, or None."""
    if not isinstance(setting, list | tuple):
        return None
    parts = cast("tuple[Any, ...]", setting)
    return coerce_numbers(parts, len(parts)) if len(parts) >= least * width and len(parts) % width == 0 else None


def describe_scalar(value: Value, plain: Any) -> Any:
    """A setting as a file holds it: a spline or a stroke as rows, one for each point."""
    if value.type == "point":
        return ROWS["spline"].list(plain)[0]
    return ROWS[value.type].list(plain) if value.type in ROWS else plain


def describe_type(value: Value) -> str:
    """The settings that a value takes, in words: "a number", "one of a, b"."""
    match value.type:
        case "float":
            return "a number"
        case "int":
            return "a whole number"
        case "bool":
            return "true or false"
        case "choice":
            if value.listed_in:
                names = ", ".join(filter(None, value.choices))
                ends = f"one of {names}, or a number up to {value.maximum:g}"
                return ends if names else f"a name in '{value.listed_in}', which lists none"
            return f"one of {', '.join(value.choices)}"
        case "path" | "text":
            return "a string"
        case "color" | "vector" | "matrix":
            return f"a list of {value.length} numbers"
        case "curve":
            return "a list of x, y for every point, at least two"
        case "items":
            assert value.items is not None
            nouns, kind = name_several(value.items.noun), value.items.kinds[0].name
            return f'{nouns} by name, such as {{"{kind}_1": {{"kind": "{kind}"}}}}'
        case "spline" | "stroke":
            return f"a list of points, each a list of x, y, {ROWS[value.type].words}"
        case "point":
            return f"a list of x, y, {ROWS['spline'].words}"
        case "ramp":
            return "a list of t, red, green, blue, alpha for every stop, at least two"


def scalar_fault(value: Value, setting: object) -> str | None:
    """Why a setting is invalid (type, hard range, choice, not finite), or None."""
    plain = coerce_scalar(value, setting)
    if plain is None:
        return f"{setting!r} does not fit: it takes {describe_type(value)}"
    if isinstance(plain, str):
        return _text_fault(value, plain)
    if isinstance(plain, tuple) and len(plain) > _FEW:
        if fault := _count_fault(value, plain):
            return fault
        if value.type != "curve" and _all_fit(value, plain):
            return _order_fault(value, plain)
    for index, part in enumerate(plain if isinstance(plain, tuple) else (plain,)):
        if isinstance(part, float) and not math.isfinite(part):
            return f"{part} is not a finite number"
        if value.type == "curve" and index % 2 == 0:
            continue
        if not value.minimum <= part <= value.maximum:
            return f"{setting!r} is outside the range {_describe_range(value)}"
        if abs(part) > (FLOAT32 if isinstance(part, float) else _INT32 - 1):
            return f"{setting!r} is too large for 32 bits"
    return _order_fault(value, plain) if isinstance(plain, tuple) else None


def _all_fit(value: Value, numbers: tuple[float, ...]) -> bool:
    """True if all of many numbers are in the range of a value and finite: an outline may have 4,000 points."""
    least, most = min(numbers), max(numbers)
    is_small = max(value.minimum, -FLOAT32) <= least and most <= min(value.maximum, FLOAT32)
    return is_small and all(map(math.isfinite, numbers))


def _text_fault(value: Value, text: str) -> str | None:
    if _is_unknown_choice(value, text):
        return f"'{text}' is not a choice: it takes {describe_type(value)}"
    return sequence_fault(text) if value.type == "path" and value.pixels else None


def sequence_fault(path: str) -> str | None:
    """Why the path of a picture cannot stand for a sequence though it has a place for the frame number, or None."""
    try:
        Pattern.parse(path)
    except UsageError as fault:
        return str(fault)
    return None


def _count_fault(value: Value, plain: tuple[float, ...]) -> str | None:
    """Why there are too many points, or None."""
    if value.type not in (*ROWS, "curve", "ramp"):
        return None
    count, most = len(plain) // value.length, ROWS[value.type].most if value.type in ROWS else MAX_POINTS
    return f"{count} points are too many: it takes at most {most}" if count > most else None


def _order_fault(value: Value, plain: tuple[float, ...]) -> str | None:
    """Why the points of a curve or ramp are not in order from 0 to 1, else None."""
    if value.type not in ("curve", "ramp"):
        return None
    places = plain[:: value.length]
    name = "x" if value.type == "curve" else "t"
    for place in places:
        if not 0.0 <= place <= 1.0:
            return f"{name} = {place:g} is outside the range 0 to 1"
    for before, after in pairwise(places):
        if after < before or (after == before and value.type == "curve"):
            return f"{name} = {after:g} follows {before:g}: list the points from left to right"
    return None


def _coerce_number(setting: object) -> float | None:
    if isinstance(setting, bool) or not isinstance(setting, int | float):
        return None
    try:
        return float(setting)
    except OverflowError:
        return math.inf if setting > 0 else -math.inf


def _is_unknown_choice(value: Value, plain: str) -> bool:
    is_unknown = value.type == "choice" and plain not in value.choices
    return is_unknown and not (value.listed_in and is_number(plain) and int(plain) <= value.maximum)


def _describe_range(value: Value) -> str:
    if math.isinf(value.maximum):
        return f"of {value.minimum:g} and more"
    if math.isinf(value.minimum):
        return f"of {value.maximum:g} and less"
    return f"{value.minimum:g} to {value.maximum:g}"
