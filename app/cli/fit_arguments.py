"""Parses what only `halation fit` takes: `pixels`, `60s`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ..errors import UsageError

if TYPE_CHECKING:
    from ..fit.fitting import Comparison

_DURATION = re.compile(r"([0-9]+(?:\.[0-9]*)?)(s|m|h|)")
_LONGEST_SECONDS = 1e7
"""Four months: more is taken for a typing error."""
_SECONDS = {"": 1.0, "s": 1.0, "m": 60.0, "h": 3600.0}


def parse_duration(text: str) -> float:
    """The seconds of `90s`, `5m` or `1h`. Raises UsageError."""
    match = _DURATION.fullmatch(text.strip().lower())
    seconds = float(match[1]) * _SECONDS[match[2]] if match else 0.0
    if not 0.0 < seconds < _LONGEST_SECONDS:
        raise UsageError(f"--budget {text}: write how long the search may take, such as 90s, 5m or 1h")
    return seconds


def parse_comparison(text: str) -> Comparison:
    """How --by says that pictures are compared. Raises UsageError."""
    if text == "pixels" or text == "look":
        return text
    raise UsageError(f"--by {text}: write pixels for the same frame, or look for any picture")
