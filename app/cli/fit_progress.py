"""Runs a search on a terminal: a bar with the best error so far, and Ctrl-C, which keeps the best values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..resources.interrupts import redirect_interrupts

if TYPE_CHECKING:
    from types import FrameType

    from ..fit.fitting import FitTask
    from ..fit.results import FitResult
    from ..fit.search import FitMeter


def follow_fit(task: FitTask) -> FitResult:
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
    with (
        Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress,
        redirect_interrupts(interrupt),
    ):
        bar = progress.add_task("", total=1.0)

        def report(meter: FitMeter) -> None:
            done = max(meter.elapsed / meter.seconds, meter.count / meter.renders)
            progress.update(bar, completed=done, description=f"{meter.count} renders, best error {meter.error:.3f}")

        return fit_values(task, lambda: bool(signals), report)
