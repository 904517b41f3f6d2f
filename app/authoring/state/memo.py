"""A cache of results that depend on immutable objects."""

from __future__ import annotations

from collections.abc import Callable
from operator import is_
from typing import Any, TypeVar

T = TypeVar("T")


class Memo:
    """Caches the last result under each name. Graphs are immutable, so the same objects give the same result."""

    def __init__(self) -> None:
        self._answers: dict[str, tuple[tuple[object, ...], Any]] = {}

    def get(self, name: str, of: tuple[object, ...], compute: Callable[[], T]) -> T:
        """The result of `compute`; it is computed again when one of the objects in `of` is another object."""
        before, answer = self.last(name)
        if len(before) != len(of) or not all(map(is_, before, of)):
            answer = compute()
            self._answers[name] = (of, answer)
        return answer

    def last(self, name: str) -> tuple[tuple[object, ...], Any]:
        """The last objects and the last result under a name; empty and None if there is none."""
        return self._answers.get(name, ((), None))

    def forget(self, name: str) -> None:
        """Compute that result again the next time."""
        self._answers.pop(name, None)

    def clear(self) -> None:
        """Drop all results."""
        self._answers.clear()
