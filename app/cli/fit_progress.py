"""Runs a search on a terminal: a bar with the best error so far, and Ctrl-C, which keeps the best values."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from ..resources.interrupts import redirect_interrupts

if TYPE_CHECKING:
    from types import FrameType

    from ..fit.fitting import FitTask
    from ..fit.results import FitResult
    from ..fit.search import FitMeter
    from ..fit.search_space import SearchSpace

_SECONDS_BETWEEN_LINES = 0.2
"""Five pictures a second look like motion; the editor renders each."""


class FitLines:
    """Prints each better set of values as a line of JSON, at most so many a second that a reader keeps up."""

    def __init__(self, space: SearchSpace) -> None:
        self._space = space
        self._printed: bytes = b""
        self._next_at = 0.0

    def report(self, meter: FitMeter) -> None:
        """Print the best values, if they are others than before."""
        if meter.best is None or meter.elapsed < self._next_at or meter.best.tobytes() == self._printed:
            return
        self._printed, self._next_at = meter.best.tobytes(), meter.elapsed + _SECONDS_BETWEEN_LINES
        facts = {"renders": meter.count, "done": round(_find_progress(meter), 3), "error": meter.error}
        print(json.dumps({**facts, "settings": self._space.settings_at(meter.best)}), flush=True)


def follow_fit(task: FitTask, prints_lines: bool = False) -> FitResult:
    """Run the search and show how far it is. A signal ends it with the best values; a second one ends the command.

    Raises the errors of `fit_values`.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    from ..fit.fitting import fit_values

    signals: list[int] = []

    def interrupt(number: int, frame: FrameType | None) -> None:
        if signals:
            raise KeyboardInterrupt
        signals.append(number)

    console = Console(stderr=True)
    columns = (BarColumn(), TextColumn("{task.description}", markup=False))
    lines = FitLines(task.space) if prints_lines else None
    with (
        Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress,
        redirect_interrupts(interrupt),
    ):
        bar = progress.add_task("", total=1.0)

        def report(meter: FitMeter) -> None:
            text = f"{meter.count} renders, best error {meter.error:.3f}"
            progress.update(bar, completed=_find_progress(meter), description=text)
            if lines is not None:
                lines.report(meter)

        return fit_values(task, lambda: bool(signals), report)


def _find_progress(meter: FitMeter) -> float:
    """The share of the budget that is used up."""
    return max(meter.elapsed / meter.seconds, meter.count / meter.renders)
