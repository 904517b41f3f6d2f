"""Looks for values that make the picture like a reference, by `halation fit` in a process of its own."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from msgspec import Struct

from ... import document
from ...graph import Graph
from ...language.translation import translate
from ...resources.sandbox import Sandbox
from ..edits.paths import rebase_paths
from .command_process import CommandEnd, CommandProcess


class FitChoices(Struct, frozen=True):
    """What is fitted, and how: patterns of values such as grade.*, and how long it may take."""

    reference: Path
    patterns: str
    by: str = "pixels"
    seconds: float = 60.0
    frame: int | None = None

    @property
    def words(self) -> list[str]:
        """The choices as words of the command."""
        frame = [] if self.frame is None else [f"--frame={self.frame}"]
        budget = f"--budget={self.seconds:g}s"
        return [f"--to={self.reference}", f"--values={self.patterns}", f"--by={self.by}", budget, *frame]


class FitStep(Struct, frozen=True):
    """The best values so far, by path, with their error. `done` is the part of the time that has passed."""

    settings: Mapping[str, Any]
    error: float
    renders: int
    done: float


class FittedNumberReport(Struct, frozen=True):
    """A number before and after; not `is_determined` where the reference says little about it."""

    name: str
    before: float
    after: float
    is_determined: bool


class FitOutcome(Struct, frozen=True):
    """How a search ended: why it was refused, or errors before and after and all numbers."""

    fault: str = ""
    settings: Mapping[str, Any] = {}
    error: tuple[float, float] = (0.0, 0.0)
    delta_e: tuple[float, float] | None = None
    values: tuple[FittedNumberReport, ...] = ()
    renders: int = 0
    seconds: float = 0.0


class GraphFit:
    """One search, which runs from the beginning on. `outcome` is None until it has ended."""

    def __init__(
        self, graph: Graph, choices: FitChoices, folder: Path, bindings: Mapping[str, str], sandbox: Sandbox
    ) -> None:
        """Begin to search. The graph as it is now, saved or not, goes into the temporary `folder`.

        Raises OutputError, and GraphError for what a file cannot hold.
        """
        self.choices = choices
        self.step: FitStep | None = None
        self.outcome: FitOutcome | None = None
        file = folder / "fit.json"
        document.save(rebase_paths(graph, str(folder)), file, sandbox=sandbox)
        inputs = [f"--input={name}={path}" for name, path in bindings.items()]
        words = ["fit", str(file), f"--output={folder / 'fitted.json'}", "--follow", *choices.words, *inputs]
        self._process = CommandProcess(words, self._read_end, self._read_line)

    def stop(self) -> None:
        """End the search: the best values so far become the outcome."""
        self._process.stop()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until it has ended, at most so long; False if it still runs."""
        return self._process.wait(seconds)

    def _read_line(self, line: str) -> None:
        facts = json.loads(line)
        if "done" in facts:
            self.step = FitStep(facts["settings"], facts["error"], facts["renders"], facts["done"])

    def _read_end(self, end: CommandEnd) -> None:
        facts = end.report
        if end.fault or "settings" not in facts:
            self.outcome = FitOutcome(end.fault or translate("it was stopped before it found anything"))
            return
        values = tuple(
            FittedNumberReport(item["name"], item["before"], item["after"], item["is_determined"])
            for item in facts["values"]
        )
        delta_e = tuple(facts["delta_e"]) if "delta_e" in facts else None
        self.outcome = FitOutcome(
            "", facts["settings"], tuple(facts["error"]), delta_e, values, facts["renders"], facts["seconds"]
        )
