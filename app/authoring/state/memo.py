"""Answers that are computed once for the objects that they depend on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


class Memo:
    """The last answer under each name. Graphs are immutable, so the same objects give the same answer."""

    def __init__(self) -> None:
        self._answers: dict[str, tuple[tuple[object, ...], Any]] = {}

    def get(self, name: str, of: tuple[object, ...], compute: Callable[[], T]) -> T:
        """What `compute` returns, until one of the objects `of` which it is computed is another object."""
        before, answer = self.last(name)
        if len(before) != len(of) or any(old is not new for old, new in zip(before, of, strict=True)):
            answer = compute()
            self._answers[name] = (of, answer)
        return answer

    def last(self, name: str) -> tuple[tuple[object, ...], Any]:
        """The objects and the answer under a name, as they were the last time; empty and None if there is none."""
        return self._answers.get(name, ((), None))

    def forget(self, name: str) -> None:
        """Compute that answer anew the next time."""
        self._answers.pop(name, None)

    def clear(self) -> None:
        """Forget all answers."""
        self._answers.clear()
