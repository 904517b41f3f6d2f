"""The conditions of `#if`: whole numbers of 32 bits, computed by ourselves."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

from .tokens import GlslFault

DEEPEST = 64
"""Brackets and signs inside each other."""

_LEVELS: tuple[tuple[str, ...], ...] = (
    ("||",),
    ("&&",),
    ("|",),
    ("^",),
    ("&",),
    ("==", "!="),
    ("<", ">", "<=", ">="),
    ("<<", ">>"),
    ("+", "-"),
    ("*", "/", "%"),
)
_COMPUTE: Mapping[str, Callable[[int, int], int]] = MappingProxyType(
    {
        "||": lambda a, b: int(bool(a or b)),
        "&&": lambda a, b: int(bool(a and b)),
        "|": operator.or_,
        "^": operator.xor,
        "&": operator.and_,
        "==": lambda a, b: int(a == b),
        "!=": lambda a, b: int(a != b),
        "<": lambda a, b: int(a < b),
        ">": lambda a, b: int(a > b),
        "<=": lambda a, b: int(a <= b),
        ">=": lambda a, b: int(a >= b),
        "<<": lambda a, b: a << (b & 31),
        ">>": lambda a, b: a >> (b & 31),
        "+": operator.add,
        "-": operator.sub,
        "*": operator.mul,
        "/": lambda a, b: int(abs(a) // abs(b)) * (1 if (a < 0) == (b < 0) else -1),
        "%": lambda a, b: (abs(a) % abs(b)) * (-1 if a < 0 else 1),
    }
)


def evaluate_condition(tokens: Sequence[str], line: int) -> int:
    """The number that the tokens of a condition stand for; unknown names are 0. Raises GlslFault."""
    return _Condition(tokens, line).evaluate()


class _Condition:
    """The work in progress."""

    def __init__(self, tokens: Sequence[str], line: int) -> None:
        self.tokens, self.line, self.at = tokens, line, 0

    def evaluate(self) -> int:
        """The number of the whole condition."""
        number = self._read_level(0, 0)
        if self.at < len(self.tokens):
            raise self._make_fault()
        return number

    def _make_fault(self) -> GlslFault:
        there = f" at '{self.tokens[self.at]}'" if self.at < len(self.tokens) else ""
        return GlslFault(self.line, f"the condition cannot be read{there}")

    def _read_level(self, level: int, depth: int) -> int:
        if level == len(_LEVELS):
            return self._read_unary(depth)
        number = self._read_level(level + 1, depth)
        while self.at < len(self.tokens) and (sign := self.tokens[self.at]) in _LEVELS[level]:
            self.at += 1
            right = self._read_level(level + 1, depth)
            if sign in "/%" and right == 0:
                # What is not computed is not divided: `defined(N) && 8 / N`.
                number = 0
                continue
            number = (_COMPUTE[sign](number, right) + (1 << 31)) % (1 << 32) - (1 << 31)
        return number

    def _read_unary(self, depth: int) -> int:
        if self.at >= len(self.tokens) or depth > DEEPEST:
            raise self._make_fault()
        token = self.tokens[self.at]
        self.at += 1
        if token in ("-", "+", "!", "~"):
            number = self._read_unary(depth + 1)
            return {"-": -number, "+": number, "!": int(not number), "~": ~number}[token]
        if token == "(":
            number = self._read_level(0, depth + 1)
            if self.tokens[self.at : self.at + 1] != [")"]:
                raise self._make_fault()
            self.at += 1
            return number
        if token[0].isdigit():
            try:
                digits = token.rstrip("uU")
                return int(digits, 8 if digits[0] == "0" and digits.isdigit() else 0)
            except ValueError:
                raise self._make_fault() from None
        if token[0].isalpha() or token[0] == "_":
            return 0
        self.at -= 1
        raise self._make_fault()
