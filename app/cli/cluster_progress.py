"""Shows how far the frames on a cluster are: as a bar on terminals, or as lines of JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal

from .outcome import print_note, write_count

if TYPE_CHECKING:
    from rich.progress import Progress

_SLOWEST = 3
"""Frames that the bar names: those that take longest, which is what a user looks for."""


class ClusterProgress:
    """Shows finished frames, workers, the time left and the slowest frames. `dashboard` is Dask's page, if any."""

    def __init__(self, total: int, kind: Literal["bar", "json"], dashboard: str) -> None:
        self._total, self._kind, self._dashboard = total, kind, dashboard
        self._reported = set[int]()
        self._progress: Progress | None = None

    def __enter__(self) -> ClusterProgress:
        """Show the bar, where there is a terminal."""
        if self._dashboard:
            print_note(f"dashboard {self._dashboard}")
        if self._kind == "bar" and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

            counter = TextColumn("{task.completed}/{task.total} frames")
            words = TextColumn("{task.description}", markup=False)
            columns = (BarColumn(), counter, TimeRemainingColumn(), TextColumn("left"), words)
            self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
            self._progress.start()
            self._progress.add_task("", total=self._total)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Remove the bar."""
        if self._progress is not None:
            self._progress.stop()

    def report_progress(self, frames: Mapping[int, float], workers: int) -> None:
        """Show the finished frames."""
        if self._kind == "json":
            for frame in [frame for frame in frames if frame not in self._reported]:
                self._reported.add(frame)
                facts: dict[str, Any] = {"frame": frame, "done": len(self._reported), "frames": self._total}
                print_note(json.dumps({**facts, "seconds": frames[frame], "workers": workers}))
        if self._progress is not None:
            slowest = sorted(frames.items(), key=lambda pair: -pair[1])[:_SLOWEST]
            names = ", ".join(f"{frame} ({seconds:.1f} s)" for frame, seconds in slowest)
            words = f"{write_count(workers, 'worker')}, slowest {names}"
            self._progress.update(self._progress.task_ids[0], completed=len(frames), description=words)

    def report_note(self, sentence: str) -> None:
        """Print a sentence above the bar."""
        if self._progress is not None:
            self._progress.console.print(sentence, soft_wrap=True, markup=False, highlight=False)
        else:
            print_note(sentence)
