"""What the rest of the house asks of a video."""

from __future__ import annotations

from .index import Facts, surveyed
from .planes import Signal, signal_of
from .reader import raw_frame


def facts_of(path: str, mark: str) -> Facts:
    """What is known of a version of a file, which `mark` tells. Raises InputError."""
    return surveyed(path, mark)[0]


def signal_at(path: str, mark: str, number: int) -> Signal:
    """A frame; the first is 1. Raises InputError where there is none, or it is damaged."""
    return signal_of(raw_frame(path, mark, number), facts_of(path, mark))
