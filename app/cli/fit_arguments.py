"""Parses what only `halation fit` takes: `grade.*`, `bloom.intensity=0..2`, `60s`."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import UsageError

if TYPE_CHECKING:
    from ..fit.fitting import Comparison
    from ..fit.search_space import ValuePattern

_DURATION = re.compile(r"([0-9]+(?:\.[0-9]*)?)(s|m|h|)")
_SECONDS = {"": 1.0, "s": 1.0, "m": 60.0, "h": 3600.0}


def parse_duration(text: str) -> float:
    """The seconds of `90s`, `5m` or `1h`. Raises UsageError."""
    match = _DURATION.fullmatch(text.strip().lower())
    seconds = float(match[1]) * _SECONDS[match[2]] if match else 0.0
    if not 0.0 < seconds < 1e7:
        raise UsageError(f"--budget {text}: write how long the search may take, such as 90s, 5m or 1h")
    return seconds


def parse_comparison(text: str) -> Comparison:
    """How --by says that pictures are compared. Raises UsageError."""
    if text == "pixels" or text == "look":
        return text
    raise UsageError(f"--by {text}: write pixels for the same frame, or look for any picture")


def parse_patterns(texts: Sequence[str]) -> tuple[ValuePattern, ...]:
    """The values that may change: names and ranges with commas between. Raises UsageError."""
    parts = [part.strip() for text in texts for part in text.split(",")]
    return tuple(_parse_pattern(part) for part in parts)


def _parse_pattern(text: str) -> ValuePattern:
    from ..fit.search_space import ValuePattern

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
