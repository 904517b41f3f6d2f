"""Choosing elements of the canvas."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Literal

from ...graph.walk import reach
from ..edits.layout import element_links
from .state import State

Mode = Literal["replace", "add", "remove", "toggle"]
Steps = Callable[[str, str], tuple[tuple[str, str], ...]]
"""The ways to follow along a link, given its source and target."""


class Selecting(State):
    """What a person selects; the last one is active."""

    def select(self, keys: str | Iterable[str], mode: Mode = "replace") -> None:
        """Select elements, or change what is selected by them; keys that mean nothing are left out."""
        self.seal()
        given = [keys] if isinstance(keys, str) else list(keys)
        if mode == "replace":
            self._select(given)
        elif mode == "add":
            self._select([*(self.selection - set(given)), *given])
        elif mode == "remove":
            self._select(sorted(self.selection - set(given)), self.active)
        else:
            added = [key for key in given if key not in self.selection]
            self._select([*sorted(self.selection - set(given)), *added], added[-1] if added else self.active)

    def select_all(self) -> None:
        """Select everything."""
        self._select(self.elements, self.active)

    def select_none(self) -> None:
        """Select nothing."""
        self.select(())

    def select_inverse(self) -> None:
        """Select what is not selected."""
        self._select(key for key in self.elements if key not in self.selection)

    def select_upstream(self) -> None:
        """Also select everything that the selection depends on."""
        self._spread(lambda start, end: ((end, start),))

    def select_downstream(self) -> None:
        """Also select everything that depends on the selection."""
        self._spread(lambda start, end: ((start, end),))

    def select_linked(self) -> None:
        """Also select everything that links hold together with the selection."""
        self._spread(lambda start, end: ((start, end), (end, start)))

    def _spread(self, steps: Steps) -> None:
        ways: dict[str, list[str]] = {}
        for link in element_links(self.graph):
            for start, end in steps(*link):
                ways.setdefault(start, []).append(end)
        found = set(self.selection)
        for key in self.selection:
            found |= reach(key, ways).keys()
        self._select([key for key in self.elements if key in found], self.active)
