"""Which values may change, as people write it: `grade.*`, `bloom.intensity=0..2`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fnmatch import fnmatchcase

from msgspec import Struct

from ..errors import UsageError

CURVE_POINTS = 7
"""Points that a curve of two points gets by default. Chosen by judgement: three between the ends make an S, and seven
also bend its foot and shoulder; each one is a number more to look for."""


class ValuePattern(Struct, frozen=True):
    """Values that may change, such as `grade.*`, and the range of their numbers; by default their own ranges."""

    text: str
    low: float | None = None
    high: float | None = None

    @property
    def is_exact(self) -> bool:
        """True for the name of one value."""
        return not any(sign in self.text for sign in "*?[")

    def matches(self, name: str) -> bool:
        """True for a name with as many parts, each of which fits."""
        parts, patterns = name.split("."), self.text.split(".")
        return len(parts) == len(patterns) and all(map(fnmatchcase, parts, patterns))


def parse_patterns(texts: Sequence[str]) -> tuple[ValuePattern, ...]:
    """The values that may change: names and ranges with commas between. Raises UsageError."""
    parts = [part.strip() for text in texts for part in text.split(",")]
    return tuple(_parse_pattern(part) for part in parts)


def _parse_pattern(text: str) -> ValuePattern:
    name, equals, limits = text.partition("=")
    if not name:
        raise UsageError("--values: write NODE.VALUE or the name of a control, with commas between several")
    if not equals:
        return ValuePattern(name)
    first, dots, last = limits.partition("..")
    try:
        low, high = float(first), float(last)
    except ValueError:
        low = high = math.nan
    if not dots or not math.isfinite(low) or not math.isfinite(high) or not low < high:
        raise UsageError(f"--values {text}: write a range as LOW..HIGH, such as {name}=0..2")
    return ValuePattern(name, low, high)
