"""The functions and operators of expressions, for numbers and, element by element, for lists."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Collection, Mapping
from types import MappingProxyType

from msgspec import Struct

from ..keys import round_keys
from .noise import noise, random

ExpressionResult = float | bool | tuple[float, ...]
"""The types of results of expressions."""


class NoValueError(Exception):
    """A function has no value for these arguments; the message says why."""


class ExpressionFunction(Struct, frozen=True):
    """A function of expressions: its signature, description, numbers of arguments, and implementation."""

    signature: str
    doc: str
    counts: Collection[int]
    call: Callable[..., float]

    @property
    def name(self) -> str:
        """Its name."""
        return self.signature.partition("(")[0]


def apply(name: str, call: Callable[..., float], arguments: tuple[ExpressionResult, ...]) -> ExpressionResult:
    """Call a function of numbers with numbers and lists: element by element, with a single number for each element.

    Raises NoValueError that names the numbers.
    """
    if tuple not in map(type, arguments):
        return _call_with_numbers(name, call, arguments)
    lengths = {len(part) for part in arguments if isinstance(part, tuple)}
    if len(lengths) > 1:
        few, many = sorted(lengths)[:2]
        raise NoValueError(f"a list of {few} and a list of {many} numbers cannot be combined")
    length = lengths.pop()
    rows = zip(*(part if isinstance(part, tuple) else (part,) * length for part in arguments), strict=True)
    return tuple(_call_with_numbers(name, call, row) for row in rows)


def _call_with_numbers(name: str, call: Callable[..., float], numbers: tuple[ExpressionResult, ...]) -> float:
    try:
        number = float(call(*numbers))
    except ZeroDivisionError:
        raise NoValueError(f"a division by zero: {_format_call(name, numbers)}") from None
    except ValueError:
        raise NoValueError(f"{_format_call(name, numbers)} has no value") from None
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise NoValueError(f"{_format_call(name, numbers)} is too large")
    return number


def _format_call(name: str, numbers: tuple[ExpressionResult, ...]) -> str:
    parts = [f"{part:g}" for part in numbers if not isinstance(part, tuple)]
    if name in OPERATORS and len(parts) == 2:
        return f"{parts[0]} {name} {parts[1]}"
    return f"{name}({', '.join(parts)})"


def _sign(x: float) -> float:
    return float((x > 0.0) - (x < 0.0))


def _fract(x: float) -> float:
    return x - math.floor(x)


def _divide(a: float, b: float) -> float:
    return a / b


def _clamp(x: float, low: float = 0.0, high: float = 1.0) -> float:
    return min(max(x, low), high)


def _mix(a: float, b: float, t: float) -> float:
    return a * (1.0 - t) + b * t


def _step(edge: float, x: float) -> float:
    return 0.0 if x < edge else 1.0


def _smoothstep(low: float, high: float, x: float) -> float:
    if low == high:
        return _step(low, x)
    t = _clamp((x - low) / (high - low))
    return t * t * (3.0 - 2.0 * t)


def _fit(x: float, low: float, high: float, first: float, last: float) -> float:
    return _mix(first, last, _step(low, x) if low == high else _clamp((x - low) / (high - low)))


def _pulse(x: float, start: float, end: float) -> float:
    return 1.0 if start <= x < end else 0.0


OPERATORS: Mapping[str, Callable[[float, float], float]] = MappingProxyType(
    {
        "+": operator.add,
        "-": operator.sub,
        "*": operator.mul,
        "/": _divide,
        "%": operator.mod,
        "^": math.pow,
        "**": math.pow,
    }
)
"""Arithmetic. The rest of a division, %, has the sign of the divisor, as mod() of GLSL."""

_VARIADIC = range(2, 501)
"""How many arguments min and max take. Chosen by judgement: far more than anybody writes."""

FUNCTIONS: Mapping[str, ExpressionFunction] = MappingProxyType(
    {
        item.name: item
        for item in (
            ExpressionFunction("sin(x)", "the sine of an angle in radians", (1,), math.sin),
            ExpressionFunction("cos(x)", "the cosine of an angle in radians", (1,), math.cos),
            ExpressionFunction("tan(x)", "the tangent of an angle in radians", (1,), math.tan),
            ExpressionFunction("asin(x)", "the angle in radians with that sine", (1,), math.asin),
            ExpressionFunction("acos(x)", "the angle in radians with that cosine", (1,), math.acos),
            ExpressionFunction("atan(x)", "the angle in radians with that tangent", (1,), math.atan),
            ExpressionFunction(
                "atan2(y, x)", "the angle in radians from the x axis to the point x, y", (2,), math.atan2
            ),
            ExpressionFunction("degrees(x)", "radians as degrees", (1,), math.degrees),
            ExpressionFunction("radians(x)", "degrees as radians", (1,), math.radians),
            ExpressionFunction("sqrt(x)", "the square root", (1,), math.sqrt),
            ExpressionFunction("exp(x)", "e to the power of x", (1,), math.exp),
            ExpressionFunction("log(x)", "the natural logarithm", (1,), math.log),
            ExpressionFunction("log2(x)", "the logarithm to base 2: photographic stops", (1,), math.log2),
            ExpressionFunction("pow(x, y)", "x to the power of y", (2,), math.pow),
            ExpressionFunction("abs(x)", "x without its sign", (1,), math.fabs),
            ExpressionFunction("sign(x)", "-1, 0 or 1", (1,), _sign),
            ExpressionFunction("floor(x)", "the whole number at or below x", (1,), math.floor),
            ExpressionFunction("ceil(x)", "the whole number at or above x", (1,), math.ceil),
            ExpressionFunction("round(x)", "the nearest whole number, halves away from zero", (1,), round_keys),
            ExpressionFunction("fract(x)", "x without its whole part", (1,), _fract),
            ExpressionFunction("mod(x, y)", "the remainder of x / y, with the sign of y", (2,), operator.mod),
            ExpressionFunction("min(a, b, ...)", "the smallest", _VARIADIC, min),
            ExpressionFunction("max(a, b, ...)", "the largest", _VARIADIC, max),
            ExpressionFunction(
                "clamp(x, low, high)", "x within low and high; within 0 and 1 if they are left out", (1, 3), _clamp
            ),
            ExpressionFunction("mix(a, b, t)", "from a at t = 0 to b at t = 1", (3,), _mix),
            ExpressionFunction("step(edge, x)", "0 below the edge, else 1", (2,), _step),
            ExpressionFunction(
                "smoothstep(low, high, x)", "0 below low, 1 above high, smooth between", (3,), _smoothstep
            ),
            ExpressionFunction(
                "fit(x, low, high, a, b)", "from a where x is low to b where it is high, level outside", (5,), _fit
            ),
            ExpressionFunction("pulse(x, start, end)", "1 from start until before end, else 0", (3,), _pulse),
            ExpressionFunction("noise(x, seed)", "smooth noise, -1 to 1; the seed may be left out", (1, 2), noise),
            ExpressionFunction(
                "random(n, seed)", "0 to 1, another for every whole n; the seed may be left out", (1, 2), random
            ),
        )
    }
)
"""All functions by name."""
