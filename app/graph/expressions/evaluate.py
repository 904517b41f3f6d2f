"""Evaluators of expressions: functions of a scope, made of other such functions. They raise ExpressionError.

Each function here returns an evaluator for one part of an expression, which the parser puts together.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from halation.nodes import Scalar

from ...errors import GraphError
from .fault import ExpressionError
from .functions import OPERATORS, ExpressionFunction, ExpressionResult, NoValueError, apply


class Scope(NamedTuple):
    """What an expression can read: the time, and other values by their names."""

    frame: float
    time: float
    rate: float
    value: Callable[[str], Scalar]


Evaluator = Callable[[Scope], ExpressionResult]

Step = tuple[str, int, Evaluator]
"""An operator, its position, and the operand after it."""

CHANNELS: Mapping[str, int] = MappingProxyType(
    {name: place for letters in ("xyzw", "rgba") for place, name in enumerate(letters)}
)
COMPARISONS: Mapping[str, Callable[[float, float], bool]] = MappingProxyType(
    {
        "<": operator.lt,
        "<=": operator.le,
        ">": operator.gt,
        ">=": operator.ge,
        "==": operator.eq,
        "!=": operator.ne,
    }
)


def make_constant(number: ExpressionResult) -> Evaluator:
    """A number."""
    return lambda scope: number


def make_variable(name: str) -> Evaluator:
    """`frame`, `time` or `rate`."""
    return operator.attrgetter(name)


def make_name(text: str, position: int, name: str) -> Evaluator:
    """The value of a name. An error points at the name here, unless it points into another expression already."""

    def run(scope: Scope) -> ExpressionResult:
        try:
            setting = scope.value(name)
        except GraphError as error:
            if "\n" in str(error):
                raise
            raise ExpressionError(text, position, str(error)) from None
        if isinstance(setting, str):
            raise ExpressionError(text, position, f"'{name}' is a text, not a number")
        try:
            number = setting if isinstance(setting, bool) else _to_floats(setting)
        except OverflowError:
            number = math.inf
        if not (math.isfinite(number) if not isinstance(number, tuple) else all(map(math.isfinite, number))):
            raise ExpressionError(text, position, f"'{name}' is {setting!r:.40}, which is not finite")
        return number

    return run


def make_call(text: str, position: int, function: ExpressionFunction, arguments: Sequence[Evaluator]) -> Evaluator:
    """A call of a function."""

    def run(scope: Scope) -> ExpressionResult:
        try:
            return apply(function.name, function.call, tuple([code(scope) for code in arguments]))
        except NoValueError as fault:
            raise ExpressionError(text, position, str(fault)) from None

    return run


def make_arithmetic(text: str, first: Evaluator, steps: Sequence[Step]) -> Evaluator:
    """Operators of one level, from left to right."""
    rest = [(name, OPERATORS[name], position, code) for name, position, code in steps]

    def run(scope: Scope) -> ExpressionResult:
        total = first(scope)
        for name, call, position, code in rest:
            operand = code(scope)
            try:
                total = apply(name, call, (total, operand))
            except NoValueError as fault:
                raise ExpressionError(text, position, str(fault)) from None
        return total

    return run


def make_comparison(text: str, left: Evaluator, name: str, position: int, right: Evaluator) -> Evaluator:
    """A comparison of two numbers."""
    call = COMPARISONS[name]

    def run(scope: Scope) -> ExpressionResult:
        a, b = left(scope), right(scope)
        if isinstance(a, tuple) or isinstance(b, tuple):
            raise ExpressionError(text, position, "lists cannot be compared: take a channel of each, such as .x")
        return call(a, b)

    return run


def make_logic(text: str, first: Evaluator, steps: Sequence[Step], *, any_of: bool) -> Evaluator:
    """`or` (`any_of`) or `and`; operands after the one that decides are not evaluated."""

    def run(scope: Scope) -> ExpressionResult:
        truth = _to_truth(text, steps[0][1], first(scope))
        for _, position, code in steps:
            if truth == any_of:
                return truth
            truth = _to_truth(text, position, code(scope))
        return truth

    return run


def make_negation(text: str, position: int, code: Evaluator) -> Evaluator:
    """`not`."""
    return lambda scope: not _to_truth(text, position, code(scope))


def make_sign(code: Evaluator, *, minus: bool) -> Evaluator:
    """A sign in front."""

    def run(scope: Scope) -> ExpressionResult:
        operand = code(scope)
        if isinstance(operand, tuple):
            return tuple(-part for part in operand) if minus else operand
        return -float(operand) if minus else float(operand)

    return run


def make_choice(text: str, position: int, condition: Evaluator, yes: Evaluator, no: Evaluator) -> Evaluator:
    """One of two operands; the other one is not evaluated."""
    return lambda scope: (yes if _to_truth(text, position, condition(scope)) else no)(scope)


def make_channel(text: str, position: int, code: Evaluator, name: str) -> Evaluator:
    """A channel of a list."""
    place = CHANNELS[name]

    def run(scope: Scope) -> ExpressionResult:
        channels = code(scope)
        if not isinstance(channels, tuple):
            raise ExpressionError(text, position, f"a number has no channel '{name}'")
        if place >= len(channels):
            raise ExpressionError(text, position, f"a list of {len(channels)} has no channel '{name}'")
        return channels[place]

    return run


def make_list(text: str, position: int, codes: Sequence[Evaluator]) -> Evaluator:
    """A list of numbers."""

    def run(scope: Scope) -> ExpressionResult:
        parts = [code(scope) for code in codes]
        if any(isinstance(part, tuple) for part in parts):
            raise ExpressionError(text, position, "a list holds numbers, not lists")
        return tuple([float(part) for part in parts if not isinstance(part, tuple)])

    return run


def _to_truth(text: str, position: int, number: ExpressionResult) -> bool:
    if isinstance(number, tuple):
        raise ExpressionError(text, position, "a list is neither true nor false: compare a channel of it, such as .x")
    return number != 0.0


def _to_floats(plain: float | tuple[float, ...]) -> float | tuple[float, ...]:
    return tuple([float(part) for part in plain]) if isinstance(plain, tuple) else float(plain)
