"""Evaluates the text of a number field: arithmetic, units, and changes relative to the old number."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from types import MappingProxyType

from halation.nodes import Unit, read_reference

from ...errors import UsageError
from ...language.translation import mark, translate

LONGEST = 200
"""The most characters of an expression: a choice, so that evaluating never takes long."""

_TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)\s*([a-zA-Z°%]*)|(\*\*|[-+*/^()])|(\S))")
_RELATIVE = re.compile(r"\s*(?:([-+*/])=|(\+|\*\*|\*|/))")
_UNITS: Mapping[str, tuple[Unit, float]] = MappingProxyType(
    {
        "px": ("px", 1.0),
        "deg": ("deg", 1.0),
        "°": ("deg", 1.0),
        "rad": ("deg", 180.0 / math.pi),
        "turn": ("deg", 360.0),
        "ev": ("EV", 1.0),
        "stops": ("EV", 1.0),
        "stop": ("EV", 1.0),
        "s": ("s", 1.0),
        "ms": ("s", 1e-3),
        "h": ("height", 1.0),
        "height": ("height", 1.0),
        "x": ("ratio", 1.0),
        "k": ("K", 1.0),
        "mm": ("mm", 1.0),
    }
)
_WORDS: Mapping[str, str] = MappingProxyType(
    {
        "px": mark("pixels (px)"),
        "height": mark("fractions of the picture's height (h)"),
        "deg": mark("degrees (deg)"),
        "EV": mark("stops (EV)"),
        "ratio": mark("a plain factor"),
        "count": mark("whole numbers"),
        "s": mark("seconds (s)"),
        "scene": mark("scene units"),
        "K": mark("kelvin (K)"),
        "mm": mark("millimeters (mm)"),
    }
)
_FAULTS = (ZeroDivisionError, OverflowError)


def evaluate(text: str, old: float = 0.0, unit: str | None = None) -> float:
    """Evaluate a text: `0.5+1`, `(2-3)*4**2`, `30deg`, `50%`; `+1`, `*2`, `/3` and `-=1` change `old`.

    A minus sign at the beginning makes a negative number. Nothing but arithmetic is understood.

    Raises:
        UsageError: the text is no valid expression.
    """
    if len(text) > LONGEST:
        raise UsageError(translate("this is too long for a number: use at most {most} characters", most=LONGEST))
    if not text.strip():
        raise UsageError(translate("type a number"))
    start: list[float | str] = []
    if relative := _RELATIVE.match(text):
        start, text = [old, relative[1] or relative[2]], text[relative.end() :]
    reader = _ExpressionReader([*start, *_read_tokens(text, unit)])
    try:
        number = reader.read_sum()
    except _FAULTS as error:
        divides = isinstance(error, ZeroDivisionError)
        raise UsageError(translate("this divides by zero") if divides else translate("this is too large")) from None
    if reader.next is not None:
        raise UsageError(
            translate("'{token}' is not expected here", token=reader.next)
            if reader.next != ")"
            else translate("a '(' is missing")
        )
    if not math.isfinite(number):
        raise UsageError(translate("this is too large"))
    return number


def _read_tokens(text: str, unit: str | None) -> list[float | str]:
    tokens: list[float | str] = []
    for match in _TOKEN.finditer(text.rstrip()):
        number, word, operator, unknown_sign = match.groups()
        if unknown_sign is not None:
            raise UsageError(
                translate(
                    "'{unknown_sign}' is not valid in a number: use digits, + - * / ** and ( )",
                    unknown_sign=unknown_sign,
                )
            )
        tokens.append(operator if operator else float(number) * find_factor(word or "", unit))
    return tokens


def find_factor(word: str, unit: str | None) -> float:
    """The factor of a unit after a number. In a field of pixels at a height, px is that unit."""
    unit = "px" if read_reference(unit) else unit
    if not word:
        return 1.0
    if word == "%":
        if unit in (None, "ratio", "height"):
            return 0.01
        raise UsageError(translate("% does not fit this value: its unit is {meaning}", meaning=translate(_WORDS[unit])))
    if word.casefold() not in _UNITS:
        raise UsageError(translate("'{word}' is not a known unit", word=word))
    counted_unit, factor = _UNITS[word.casefold()]
    if counted_unit != unit:
        raise UsageError(
            translate(
                "'{word}' does not fit this value: its unit is {meaning}",
                word=word,
                meaning=translate(_WORDS[unit]) if unit else translate("a plain number"),
            )
        )
    return factor


class _ExpressionReader:
    """Recursive descent over tokens; powers bind tighter than signs, and to the right, as in Python."""

    def __init__(self, tokens: list[float | str]) -> None:
        self._tokens = tokens
        self._at = 0

    @property
    def next(self) -> float | str | None:
        return self._tokens[self._at] if self._at < len(self._tokens) else None

    def read_sum(self) -> float:
        return self._read_chain(self._read_product, {"+": lambda a, b: a + b, "-": lambda a, b: a - b})

    def _read_product(self) -> float:
        return self._read_chain(self._read_signed, {"*": lambda a, b: a * b, "/": lambda a, b: a / b})

    def _read_chain(self, part: Callable[[], float], operators: Mapping[str, Callable[[float, float], float]]) -> float:
        number = part()
        while isinstance(operator := self.next, str) and operator in operators:
            self._at += 1
            number = operators[operator](number, part())
        return number

    def _read_signed(self) -> float:
        if self.next in ("+", "-"):
            sign = -1.0 if self.next == "-" else 1.0
            self._at += 1
            return sign * self._read_signed()
        return self._read_power()

    def _read_power(self) -> float:
        base = self._read_atom()
        if self.next not in ("**", "^"):
            return base
        self._at += 1
        exponent = self._read_signed()
        try:
            return math.pow(base, exponent)
        except ValueError:
            raise UsageError(
                translate("{base:g} ** {exponent:g} is not a number", base=base, exponent=exponent)
            ) from None

    def _read_atom(self) -> float:
        token = self.next
        self._at += 1
        if isinstance(token, float | int):
            return float(token)
        if token != "(":
            raise UsageError(
                translate("a number is missing at the end")
                if token is None
                else translate("a number is missing before {token!r}", token=token)
            )
        number = self.read_sum()
        if self.next != ")":
            raise UsageError(translate("a ')' is missing"))
        self._at += 1
        return number
