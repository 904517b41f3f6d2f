"""The code of expressions: small functions of a scope, each made of others. All of them raise ExpressionError."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from halation.nodes import Plain

from ...errors import GraphError
from .fault import ExpressionError
from .functions import OPERATORS, ExpressionFunction, Made, NoValueError, apply


class Scope(NamedTuple):
    """What an expression reads: the time, and other values by their names."""

    frame: float
    time: float
    rate: float
    value: Callable[[str], Plain]


Code = Callable[[Scope], Made]

Step = tuple[str, int, Code]
"""An operator, where it stands, and the operand after it."""

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


def constant(made: Made) -> Code:
    """A number."""
    return lambda scope: made


def variable(name: str) -> Code:
    """`frame`, `time` or `rate`."""
    return operator.attrgetter(name)


def named(text: str, position: int, name: str) -> Code:
    """The value of another name. What is wrong with it is said with the character here, unless it points at one."""

    def run(scope: Scope) -> Made:
        try:
            found = scope.value(name)
        except GraphError as error:
            if "\n" in str(error):
                raise
            raise ExpressionError(text, position, str(error)) from None
        if isinstance(found, str):
            raise ExpressionError(text, position, f"'{name}' is a text, which is no number")
        try:
            made = found if isinstance(found, bool) else _floats(found)
        except OverflowError:
            made = math.inf
        if not (math.isfinite(made) if not isinstance(made, tuple) else all(map(math.isfinite, made))):
            raise ExpressionError(text, position, f"'{name}' is {found!r:.40}, which is not finite")
        return made

    return run


def call(text: str, position: int, function: ExpressionFunction, arguments: Sequence[Code]) -> Code:
    """A function of arguments."""

    def run(scope: Scope) -> Made:
        try:
            return apply(function.name, function.call, tuple([code(scope) for code in arguments]))
        except NoValueError as fault:
            raise ExpressionError(text, position, str(fault)) from None

    return run


def arithmetic(text: str, first: Code, steps: Sequence[Step]) -> Code:
    """Operators of one level from left to right."""
    rest = [(name, OPERATORS[name], position, code) for name, position, code in steps]

    def run(scope: Scope) -> Made:
        made = first(scope)
        for name, call, position, code in rest:
            other = code(scope)
            try:
                made = apply(name, call, (made, other))
            except NoValueError as fault:
                raise ExpressionError(text, position, str(fault)) from None
        return made

    return run


def comparison(text: str, left: Code, name: str, position: int, right: Code) -> Code:
    """Two numbers compared."""
    call = COMPARISONS[name]

    def run(scope: Scope) -> Made:
        a, b = left(scope), right(scope)
        if isinstance(a, tuple) or isinstance(b, tuple):
            raise ExpressionError(text, position, "lists cannot be compared: take a channel of each, such as .x")
        return call(a, b)

    return run


def logic(text: str, first: Code, steps: Sequence[Step], *, any_of: bool) -> Code:
    """`or` (any of them) or `and`: what comes after the answer is known is not looked at."""

    def run(scope: Scope) -> Made:
        made = _truth(text, steps[0][1], first(scope))
        for _, position, code in steps:
            if made == any_of:
                return made
            made = _truth(text, position, code(scope))
        return made

    return run


def negation(text: str, position: int, code: Code) -> Code:
    """`not`."""
    return lambda scope: not _truth(text, position, code(scope))


def signed(code: Code, *, minus: bool) -> Code:
    """A sign in front."""

    def run(scope: Scope) -> Made:
        made = code(scope)
        if isinstance(made, tuple):
            return tuple(-part for part in made) if minus else made
        return -float(made) if minus else float(made)

    return run


def choice(text: str, position: int, condition: Code, yes: Code, no: Code) -> Code:
    """One of two; the other is not looked at."""
    return lambda scope: (yes if _truth(text, position, condition(scope)) else no)(scope)


def channel(text: str, position: int, code: Code, name: str) -> Code:
    """One number of a list."""
    place = CHANNELS[name]

    def run(scope: Scope) -> Made:
        made = code(scope)
        if not isinstance(made, tuple):
            raise ExpressionError(text, position, f"a number has no channel '{name}'")
        if place >= len(made):
            raise ExpressionError(text, position, f"a list of {len(made)} has no channel '{name}'")
        return made[place]

    return run


def listed(text: str, position: int, codes: Sequence[Code]) -> Code:
    """A list of numbers."""

    def run(scope: Scope) -> Made:
        parts = [code(scope) for code in codes]
        if any(isinstance(part, tuple) for part in parts):
            raise ExpressionError(text, position, "a list holds numbers, not lists")
        return tuple([float(part) for part in parts if not isinstance(part, tuple)])

    return run


def _truth(text: str, position: int, made: Made) -> bool:
    if isinstance(made, tuple):
        raise ExpressionError(text, position, "a list is neither true nor false: compare a channel of it, such as .x")
    return made != 0.0


def _floats(found: float | tuple[float, ...]) -> float | tuple[float, ...]:
    return tuple([float(part) for part in found]) if isinstance(found, tuple) else float(found)
