"""Names that are near enough to an unknown one to be suggested, and how many are compared.

Each comparison takes time, and a file can hold 100,000 faults.
"""

from __future__ import annotations

import difflib
from collections.abc import Collection, Generator
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


_LEAST_PART = 3
"""Letters of a part of a name that are enough to suggest the whole name. Chosen by judgement: with 2, `in` is a part of
every tenth node; with 6, `blur` suggests nothing."""
_MOST_CANDIDATES = 8
"""Names that difflib finds similar, of which the near ones are suggested."""


def find_near_names(name: str, names: Collection[str], count: int = 1) -> list[str]:
    """The names that somebody may have meant by another one, the nearest first, at most `count`; case counts.

    A name is near if as many letters at most differ as rustc allows (`find_best_match_for_name`): a third of them,
    and one of a short name. A part of a name, from the start of one of its words, is near too: `chroma` of
    `chroma_key`. What is merely somewhat alike, such as `wave` for `water`, would mislead.
    """
    similar = difflib.get_close_matches(name, names, max(count, _MOST_CANDIDATES))
    distances = {candidate: measure_distance(name, candidate) for candidate in similar}
    most = max(len(name), 3) // 3
    near = sorted((item for item in similar if distances[item] <= most), key=lambda item: distances[item])
    if len(name) >= _LEAST_PART:
        near += sorted((item for item in names if item not in near and _starts_word(name, item)), key=len)
    return near[:count]


def _starts_word(part: str, name: str) -> bool:
    """True if a name, or what follows a separator in it, starts with a part."""
    place = name.find(part)
    while place > 0 and name[place - 1].isalnum():
        place = name.find(part, place + 1)
    return place >= 0


def measure_distance(a: str, b: str) -> int:
    """How many letters must be changed, inserted, removed, or swapped with their neighbor, to get from `a` to `b`.

    The optimal string alignment distance: Damerau 1964, "A technique for computer detection and correction of spelling
    errors", by the table of Wagner and Fischer 1974.
    """
    older, old = [], list(range(len(b) + 1))
    for row, letter in enumerate(a, 1):
        new = [row]
        for column, other in enumerate(b, 1):
            new.append(min(old[column] + 1, new[-1] + 1, old[column - 1] + (letter != other)))
            if row > 1 < column and letter == b[column - 2] and a[row - 2] == other:
                new[-1] = min(new[-1], older[column - 2] + 1)
        older, old = old, new
    return old[-1]
