"""How many names are compared for suggestions: each comparison takes time, and a file can hold 100,000 faults."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from contextvars import ContextVar

MAX_COMPARISONS = 40_000
"""Names that are compared for all faults of one graph together."""
_LEAST_COMPARISONS = 20
"""What the shortest list counts as: starting to compare takes as long as comparing this many names (measured). To list
a folder takes longer."""

_COMPARISONS_LEFT: ContextVar[list[int] | None] = ContextVar("_COMPARISONS_LEFT", default=None)


@contextmanager
def limit_suggestions() -> Generator[None]:
    """Inside this context only the first of many faults get suggestions."""
    token = None if _COMPARISONS_LEFT.get() else _COMPARISONS_LEFT.set([MAX_COMPARISONS])
    try:
        yield
    finally:
        if token:
            _COMPARISONS_LEFT.reset(token)


def can_compare() -> bool:
    """False if nothing may be compared any more, which is sooner known than whether so many names may be."""
    left = _COMPARISONS_LEFT.get()
    return left is None or left[0] >= _LEAST_COMPARISONS


def may_compare(count: int = 0) -> bool:
    """True if an unknown name may be compared with so many others, which then count as compared."""
    left = _COMPARISONS_LEFT.get() or [MAX_COMPARISONS]
    cost = max(count, _LEAST_COMPARISONS)
    if cost > left[0]:
        left[0] = 0  # the faults that follow need not ask
        return False
    left[0] -= cost
    return True
