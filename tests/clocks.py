"""A clock for tests of measured times: it goes on only when a test says that something took time."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import pytest


class FakeClock:
    """Stands in for the module `time` in the modules that it is given."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *modules: ModuleType) -> None:
        self._now = 1000.0
        self._monkeypatch = monkeypatch
        for module in modules:
            monkeypatch.setattr(module, "time", self)

    def perf_counter(self) -> float:
        """The time."""
        return self._now

    def spend(self, seconds: float) -> None:
        """Let time pass."""
        self._now += seconds

    def slow_down(self, owner: object, name: str, seconds: float) -> list[tuple[Any, ...]]:
        """Let each call of a function take this long; the arguments of the calls."""
        function: Callable[..., Any] = getattr(owner, name)
        calls: list[tuple[Any, ...]] = []

        def slow(*arguments: Any, **options: Any) -> Any:
            calls.append(arguments)
            self.spend(seconds)
            return function(*arguments, **options)

        self._monkeypatch.setattr(owner, name, slow)
        return calls
