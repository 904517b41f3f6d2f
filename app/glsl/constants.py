"""Constants of GLSL: the numbers that expressions have whatever is rendered, where that is sure."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

_EXACT_FLOATS = 2**24
"""Floats of 32 bits hold all whole numbers below it."""

_CLEAR_FRACTION = 1e-3
"""How far a constant must be from a whole number, so that its rounding to 32 bits cannot reach it: chosen by judgement,
since some operations before may each have been rounded."""

Number = int | float | tuple[int, ...]


def is_float_number(text: str) -> bool:
    """True for a literal with a point, an exponent or an `f`."""
    return text[:2] not in ("0x", "0X") and re.search(r"[.eEfF]", text) is not None


def read_number(text: str) -> int | float | None:
    """The number that a literal says; None for a float beyond all bounds."""
    if not is_float_number(text):
        digits = text.rstrip("uU")
        base = 16 if digits[:2] in ("0x", "0X") else 8 if digits[0] == "0" else 10
        return wrap(int(digits, base))
    number = float(re.sub(r"[a-zA-Z]+$", "", text))
    return number if math.isfinite(number) else None


def wrap(number: int) -> int:
    """A whole number of 32 bits with a sign."""
    return (number + (1 << 31)) % (1 << 32) - (1 << 31)


def negate(number: int | float) -> int | float:
    """The number with the other sign."""
    return wrap(-number) if isinstance(number, int) else -number


def combine(sign: str, a: Number | None, b: Number | None) -> Number | None:
    """The number that an operator makes of two, where that is sure: those without a sign may not be negative."""
    if a is None or b is None:
        return None
    if isinstance(a, tuple) or isinstance(b, tuple):
        count = len(a) if isinstance(a, tuple) else len(b) if isinstance(b, tuple) else 0
        first = a if isinstance(a, tuple) else (a,) * count
        second = b if isinstance(b, tuple) else (b,) * count
        parts = [_compute(sign, x, y) for x, y in zip(first, second, strict=True)]
        whole = tuple(part for part in parts if isinstance(part, int))
        return whole if len(whole) == count else None
    return _compute(sign, a, b)


def _compute(sign: str, a: int | float, b: int | float) -> int | float | None:
    if sign in ("+", "-", "*"):
        exact = a + b if sign == "+" else a - b if sign == "-" else a * b
        return wrap(exact) if isinstance(exact, int) else exact if math.isfinite(exact) else None
    if isinstance(a, float) or isinstance(b, float):
        return a / b if sign == "/" and b else None
    if a < 0 or b < 0:
        return None
    match sign:
        case "/" | "%":
            return None if b == 0 else a // b if sign == "/" else a % b
        case "<<":
            return wrap(a << b) if b < 32 else None
        case ">>":
            return a >> b if b < 32 else None
        case "&" | "|" | "^":
            return {"&": a & b, "|": a | b, "^": a ^ b}[sign]
        case "<" | ">" | "<=" | ">=" | "==" | "!=":
            return int({"<": a < b, ">": a > b, "<=": a <= b, ">=": a >= b, "==": a == b, "!=": a != b}[sign])
        case _:
            return None


def construct(name: str, numbers: Sequence[Number | None]) -> Number | None:
    """The number that a constructor or a simple function makes."""
    if not numbers or any(number is None or isinstance(number, tuple) for number in numbers):
        return None
    scalars = [number for number in numbers if isinstance(number, (int, float))]
    if name == "float" and len(scalars) == 1:
        return float(scalars[0])
    if name in ("min", "max"):
        return min(scalars) if name == "min" else max(scalars)
    if name in ("floor", "ceil") and len(scalars) == 1:
        return float(math.floor(scalars[0]) if name == "floor" else math.ceil(scalars[0]))
    wholes = [whole for number in scalars if (whole := _truncate(number)) is not None]
    if len(wholes) < len(scalars):
        return None
    if name in ("int", "uint") and len(wholes) == 1:
        return wholes[0]
    if match := re.fullmatch(r"[iu]vec([234])", name):
        count = int(match[1])
        return tuple(wholes * count if len(wholes) == 1 else wholes) if len(wholes) in (1, count) else None
    return None


def _truncate(number: int | float) -> int | None:
    """A float as a whole number, where rounding to 32 bits cannot change it."""
    if isinstance(number, int):
        return number
    near = round(number)
    if abs(number) >= _EXACT_FLOATS:
        return None
    return near if number == near else math.trunc(number) if abs(number - near) > _CLEAR_FRACTION else None
