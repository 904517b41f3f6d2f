"""Sizes of ISF buffers: formulas of `$WIDTH`, `$HEIGHT` and inputs, parsed here so that no file runs code."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import ClassVar

from ...resources.record import Record

MAX_LENGTH = 1000
MAX_DEPTH = 50
"""Letters and nested brackets of a formula: far more than sizes need. A choice, so that reading never runs deep."""

_ROUNDING = 1e-9
"""How far, as a part of it, a length may be from a whole number that it means: formulas are calculated in doubles."""

SizeEvaluator = Callable[[Mapping[str, float]], float]

_TOKENS = re.compile(r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)|(?P<name>\$?[A-Za-z_]\w*)|(?P<sign>.))")
_OPERATORS: Mapping[str, Callable[[float, float], float]] = MappingProxyType(
    {
        "+": operator.add,
        "-": operator.sub,
        "*": operator.mul,
        "/": operator.truediv,
        "%": math.fmod,
        "^": math.pow,
    }
)
FUNCTIONS: Mapping[str, tuple[Callable[..., float], int]] = MappingProxyType(
    {
        "floor": (math.floor, 1),
        "ceil": (math.ceil, 1),
        "trunc": (math.trunc, 1),
        "abs": (abs, 1),
        "round": (lambda x: math.floor(x + 0.5), 1),
        "sqrt": (math.sqrt, 1),
        "exp": (math.exp, 1),
        "log": (math.log, 1),
        "sin": (math.sin, 1),
        "cos": (math.cos, 1),
        "tan": (math.tan, 1),
        "pow": (math.pow, 2),
        "mod": (math.fmod, 2),
        "min": (min, 0),
        "max": (max, 0),
        "clamp": (lambda low, x, high: min(max(x, low), high), 3),
    }
)
"""Functions with their number of arguments, 0 for any. The order of `clamp(low, x, high)` is that of exprtk."""


class SizeError(Exception):
    """A formula cannot be read, or has no value."""


class SizeFormula(Record, frozen=True, eq=False):
    """A formula such as `max(floor($WIDTH * 0.25), 1.0)`. `names` are those that it reads, without the `$`."""

    text: str
    names: frozenset[str]
    _run: SizeEvaluator

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"names", "_run"})

    def pixels(self, values: Mapping[str, float]) -> int:
        """The length, rounded down, at least 1. Raises SizeError where there is none."""
        try:
            length = float(self._run(values))
        except ZeroDivisionError:
            raise SizeError("it divides by 0") from None
        except (ArithmeticError, ValueError):
            raise SizeError("it has no value") from None
        if not math.isfinite(length):
            raise SizeError("it is not finite")
        # A length that is an integer except for rounding errors is meant to be one.
        whole = round(length)
        return max(1, whole if abs(length - whole) <= _ROUNDING * max(1.0, abs(length)) else math.floor(length))


def read_size(text: str) -> SizeFormula:
    """Read a formula. Raises SizeError."""
    if len(text) > MAX_LENGTH:
        raise SizeError(f"it has more than {MAX_LENGTH} characters")
    return _SizeParser(text).parse()


class _SizeParser:
    """A parser; `tokens` are those that are left, in reverse order."""

    def __init__(self, text: str) -> None:
        self.text = text
        matches = [match for match in _TOKENS.finditer(text.strip()) if match[0].strip()]
        self.tokens = [(str(match.lastgroup), str(match[match.lastgroup or 0])) for match in reversed(matches)]
        self.names: set[str] = set()
        self.depth = 0

    def parse(self) -> SizeFormula:
        run = self._parse_sum()
        if self.tokens:
            raise SizeError(f"'{self.tokens[-1][1]}' is not expected there")
        return SizeFormula(self.text, frozenset(self.names), run)

    def _parse_sum(self) -> SizeEvaluator:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise SizeError(f"it nests deeper than {MAX_DEPTH}")
        run = self._parse_chain(("+", "-"), lambda: self._parse_chain(("*", "/", "%"), self._parse_signed))
        self.depth -= 1
        return run

    def _parse_chain(self, signs: tuple[str, ...], part: Callable[[], SizeEvaluator]) -> SizeEvaluator:
        first = part()
        rest: list[tuple[Callable[[float, float], float], SizeEvaluator]] = []
        while self._next_sign() in signs:
            sign = self.tokens.pop()[1]
            rest.append((_OPERATORS[sign], part()))
        if not rest:
            return first

        def run(values: Mapping[str, float]) -> float:
            total = first(values)
            for call, operand in rest:
                total = call(total, operand(values))
            return total

        return run

    def _parse_signed(self) -> SizeEvaluator:
        minus = False
        while self._next_sign() in ("-", "+"):
            minus ^= self.tokens.pop()[1] == "-"
        base = self._parse_operand()
        if self._next_sign() == "^":
            self.tokens.pop()
            self.depth += 1
            if self.depth > MAX_DEPTH:
                raise SizeError(f"it nests deeper than {MAX_DEPTH}")
            base = _raise_to(base, self._parse_signed())
            self.depth -= 1
        return (lambda values: -base(values)) if minus else base

    def _parse_operand(self) -> SizeEvaluator:
        if not self.tokens:
            raise SizeError("it ends too early")
        kind, word = self.tokens.pop()
        if kind == "number":
            number = float(word)
            return lambda values: number
        if word == "(":
            run = self._parse_sum()
            self._take_sign(")")
            return run
        if kind == "name" and self._next_sign() == "(":
            return self._parse_call(word)
        if kind == "name":
            name = word.removeprefix("$")
            self.names.add(name)
            return lambda values: values[name]
        raise SizeError(f"'{word}' is not expected there")

    def _parse_call(self, word: str) -> SizeEvaluator:
        if word not in FUNCTIONS:
            raise SizeError(f"there is no function '{word}': use {', '.join(FUNCTIONS)}")
        self.tokens.pop()
        arguments = [self._parse_sum()]
        while self._next_sign() == ",":
            self.tokens.pop()
            arguments.append(self._parse_sum())
        self._take_sign(")")
        call, count = FUNCTIONS[word]
        if count not in (0, len(arguments)):
            raise SizeError(f"'{word}' takes {count} numbers, not {len(arguments)}")
        return lambda values: (
            call(*[argument(values) for argument in arguments]) if len(arguments) > 1 or count else arguments[0](values)
        )

    def _next_sign(self) -> str:
        return self.tokens[-1][1] if self.tokens else ""

    def _take_sign(self, sign: str) -> None:
        if self._next_sign() != sign:
            raise SizeError(f"a '{sign}' is missing")
        self.tokens.pop()


def _raise_to(base: SizeEvaluator, power: SizeEvaluator) -> SizeEvaluator:
    return lambda values: math.pow(base(values), power(values))
