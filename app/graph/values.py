"""Is this a legal setting of that value?"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, cast

from halation.nodes import LIGHT_NUMBERS, MAX_LIGHTS, MAX_POINTS, LightKind, Plain, Value

_INT32 = 2**31
_FLOAT32 = 3.4028234663852886e38


def coerce(value: Value, given: object) -> Plain | None:
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
            return numbers(given, value.length)
        case "curve" | "ramp":
            return _points(given, value.length, 2)
        case "lights":
            return _points(given, value.length, 0)


def numbers(given: object, length: int) -> tuple[float, ...] | None:
    """A list or tuple of `length` numbers as floats, else None."""
    if not isinstance(given, list | tuple):
        return None
    parts = [_number(part) for part in cast("tuple[Any, ...]", given)]
    found = tuple(part for part in parts if part is not None)
    return found if len(found) == len(parts) == length else None


def _points(given: object, width: int, least: int) -> tuple[float, ...] | None:
    """A list of at least so many points of `width` numbers each, else None."""
    if not isinstance(given, list | tuple):
        return None
    parts = cast("tuple[Any, ...]", given)
    return numbers(parts, len(parts)) if len(parts) >= least * width and len(parts) % width == 0 else None


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
        case "color" | "vector" | "matrix":
            return f"a list of {value.length} numbers"
        case "curve":
            return "a list of x, y for every point, at least two"
        case "lights":
            return f"a list of {LIGHT_NUMBERS} numbers for every light"
        case "ramp":
            return "a list of t, red, green, blue, alpha for every stop, at least two"


def value_fault(value: Value, given: object) -> str | None:
    """Why `given` is no legal setting (type, hard range, choice, not finite), or None."""
    plain = coerce(value, given)
    if plain is None:
        return f"{given!r} does not fit: it takes {expected(value)}"
    if isinstance(plain, str):
        return f"'{plain}' is no choice: it takes {expected(value)}" if _no_choice(value, plain) else None
    for index, part in enumerate(plain if isinstance(plain, tuple) else (plain,)):
        if isinstance(part, float) and not math.isfinite(part):
            return f"{part} is not a finite number"
        if value.type == "curve" and index % 2 == 0:
            continue
        if not value.minimum <= part <= value.maximum:
            return f"{given!r} is outside the range {_range(value)}"
        if abs(part) > (_FLOAT32 if isinstance(part, float) else _INT32 - 1):
            return f"{given!r} is too large for 32 bits"
    return _order_fault(value, plain) if isinstance(plain, tuple) else None


def _order_fault(value: Value, plain: tuple[float, ...]) -> str | None:
    """Why the points of a curve or ramp do not follow each other from 0 to 1, or lights are none; else None."""
    if value.type == "lights":
        return _lights_fault(plain)
    if value.type not in ("curve", "ramp"):
        return None
    places = plain[:: value.length]
    if len(places) > MAX_POINTS:
        return f"{len(places)} points are too many: it takes at most {MAX_POINTS}"
    name = "x" if value.type == "curve" else "t"
    for place in places:
        if not 0.0 <= place <= 1.0:
            return f"{name} = {place:g} is outside the range 0 to 1"
    for before, after in pairwise(places):
        if after < before or (after == before and value.type == "curve"):
            return f"{name} = {after:g} follows {before:g}: list the points from left to right"
    return None


def _lights_fault(plain: tuple[float, ...]) -> str | None:
    kinds = {float(kind) for kind in LightKind}
    if len(plain) > MAX_LIGHTS * LIGHT_NUMBERS:
        return f"{len(plain) // LIGHT_NUMBERS} lights are too many: it takes at most {MAX_LIGHTS}"
    for place, kind in enumerate(plain[::LIGHT_NUMBERS]):
        if kind not in kinds:
            return f"light {place + 1} is of kind {kind:g}: 0 is a point, 1 a spot, 2 a sun, 3 a sphere"
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
