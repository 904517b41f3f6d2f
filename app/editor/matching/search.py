"""A search for better values as the window sees it: what may change, what runs, and the one step of the history."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from ...authoring.background.graph_fit import FitChoices, FitOutcome, FitStep, GraphFit
from ...authoring.commands.values import OverrideValues
from ...errors import HalationError
from ...language.translation import translate

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ...graph import Graph


class MatchSearch:
    """Values of the document follow the best ones that a search has found, as one step that can be undone."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._fit: GraphFit | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._shown: FitStep | FitOutcome | None = None
        self._merge = ""
        self._count = 0
        self._counted: tuple[Graph, str] | None = None
        self._count_text: tuple[int, str] = (0, "")

    @property
    def step(self) -> FitStep | None:
        """The best values so far; None before the first ones, and without a search."""
        return self._fit.step if self._fit else None

    @property
    def outcome(self) -> FitOutcome | None:
        """How the search has ended; None while it runs, and without a search."""
        return self._fit.outcome if self._fit else None

    @property
    def is_running(self) -> bool:
        """True while values are looked for."""
        return self._fit is not None and self._fit.outcome is None

    @property
    def is_open(self) -> bool:
        """True from the start of a search until its values are kept or put back."""
        return self._fit is not None

    def count_numbers(self, patterns: str) -> tuple[int, str]:
        """How many numbers patterns name, or 0 and why they name none."""
        question = self._session.root, patterns
        if question != self._counted:
            self._counted, self._count_text = question, _count_numbers(*question)
        return self._count_text

    def start(self, choices: FitChoices) -> None:
        """Begin. Raises OutputError, and GraphError for what a file cannot hold."""
        self.end()
        self._folder = tempfile.TemporaryDirectory(prefix="halation-match-", ignore_cleanup_errors=True)
        bindings = {name: str(path) for name, path in self._session.bindings.items()}
        session = self._session
        self._fit = GraphFit(session.root, choices, Path(self._folder.name), bindings, session.sandbox)
        self._count += 1
        self._merge, self._shown = f"match {self._count}", None

    def follow(self) -> None:
        """Give the document the best values so far, if there are new ones. Raises GraphError where it has changed."""
        if self._fit is None:
            return
        newest = self._fit.outcome or self._fit.step
        if newest is None or newest is self._shown:
            return
        self._shown = newest
        if newest.settings:
            self._session.apply(OverrideValues(newest.settings, translate("Match the reference"), self._merge))

    def stop(self) -> None:
        """End looking; the best values so far stay."""
        if self._fit is not None:
            self._fit.stop()

    def put_back(self) -> None:
        """End, with the values of before."""
        if self._merge:
            self._session.abandon(self._merge)
        self.end()

    def end(self) -> None:
        """End, with the values as they are now."""
        self.stop()
        self._session.seal()
        if self._folder is not None:
            self._folder.cleanup()
        self._fit = self._folder = None
        self._merge = ""


def _count_numbers(graph: Graph, patterns: str) -> tuple[int, str]:
    from ...fit.search_space import find_search_space
    from ...fit.value_patterns import CURVE_POINTS, parse_patterns

    try:
        return len(find_search_space(graph, parse_patterns([patterns]), CURVE_POINTS).numbers), ""
    except HalationError as fault:
        return 0, str(fault).removeprefix("--values ").removeprefix("--values: ")
