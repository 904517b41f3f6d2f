"""Is this a legal setting of that value?"""

from __future__ import annotations

import math
from typing import Any, cast

from ...nodes import Plain, Value

_INT32 = 2**31
_FLOAT32 = 3.4028234663852886e38


def coerced(value: Value, given: object) -> Plain | None:
    """`given` as the plain type that `value` declares (an int serves as a float, a list as a tuple), else None.

    Ranges and choices are not looked at: see `value_fault`.
    """
    match value.type:
        case "float":
            return _number(given)
        case "int":
            return given if isinstance(given, int) and not isinstance(given, bool) else None
        case "bool":
            return given if isinstance(given, bool) else None
        case "choice" | "path" | "text":
            return given if isinstance(given, str) else None
        case "color" | "vector" | "matrix":
            return numbers(given, 4 if value.type == "color" else value.length)


def numbers(given: object, length: int) -> tuple[float, ...] | None:
    """A list or tuple of `length` numbers as floats, else None."""
    if not isinstance(given, list | tuple):
        return None
    parts = [_number(part) for part in cast("tuple[Any, ...]", given)]
    found = tuple(part for part in parts if part is not None)
    return found if len(found) == len(parts) == length else None


def expected(value: Value) -> str:
    """What `value` wants, in words: "a number", "one of a, b"."""
    match value.type:
        case "float":
            return "a number"
        case "int":
            return "a whole number"
        case "bool":
            return "true or false"
        case "choice":
            return f"one of {', '.join(value.choices)}"
        case "path" | "text":
            return "a string"
        case "color":
            return "a list of 4 numbers"
        case "vector" | "matrix":
            return f"a list of {value.length} numbers"


def value_fault(value: Value, given: object) -> str | None:
    """Why `given` is no legal setting (type, hard range, choice, not finite), or None."""
    plain = coerced(value, given)
    if plain is None:
        return f"{given!r} does not fit: it takes {expected(value)}"
    if isinstance(plain, str):
        return f"'{plain}' is no choice: it takes {expected(value)}" if _no_choice(value, plain) else None
    for part in plain if isinstance(plain, tuple) else (plain,):
        if isinstance(part, float) and not math.isfinite(part):
            return f"{part} is not a finite number"
        if not value.minimum <= part <= value.maximum:
            return f"{given!r} is outside the range {_range(value)}"
        if abs(part) > (_FLOAT32 if isinstance(part, float) else _INT32 - 1):
            return f"{given!r} is too large for 32 bits"
    return None


def _number(given: object) -> float | None:
    if isinstance(given, bool) or not isinstance(given, int | float):
        return None
    try:
        return float(given)
    except OverflowError:
        return math.inf if given > 0 else -math.inf


def _no_choice(value: Value, plain: str) -> bool:
    return value.type == "choice" and plain not in value.choices


def _range(value: Value) -> str:
    if math.isinf(value.maximum):
        return f"of {value.minimum:g} and more"
    if math.isinf(value.minimum):
        return f"of {value.maximum:g} and less"
    return f"{value.minimum:g} to {value.maximum:g}"
