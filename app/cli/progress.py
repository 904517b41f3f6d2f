"""Reports the progress of a render: as a bar on terminals, or as lines of JSON."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Literal

from .outcome import print_note

if TYPE_CHECKING:
    from rich.progress import Progress as RichProgress

    from ..renderer.jobs.reports import FrameReport

_PATIENCE = 0.3
"""Seconds that work may take without a bar: a choice, so that short renderings do not flicker."""


@contextmanager
def progress_reporter(
    kind: Literal["bar", "json"], count: int, unit: Literal["frames", "files"] = "frames"
) -> Iterator[ProgressReporter]:
    """Open what a job of so many frames or files reports its progress to: a bar, or lines of JSON."""
    if kind == "json":
        yield JsonLines()
        return
    bar = ProgressBar(count, unit)
    try:
        yield bar
    finally:
        bar.close()


class JsonLines:
    """One JSON object on standard error for every pass and every frame."""

    def report_helpers(self, processes: Sequence[int]) -> None:
        """Print the ids of the processes that share the frames: who kills this process has to kill them too."""
        print_note(json.dumps({"processes": list(processes)}))

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """Print which pass has ended."""
        print_note(json.dumps({"frame": frame, "pass": passes_done, "passes": total, "nodes": nodes}))

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """Print which frame has been written."""
        written = [str(path) for path in report.written]
        print_note(
            json.dumps(
                {
                    "frame": report.frame,
                    "done": frames_done,
                    "frames": total,
                    "written": written,
                    "kept": report.is_kept,
                    "passes": report.passes,
                }
            )
        )

    def report_entry(self, facts: Mapping[str, Any], done_count: int, total: int) -> None:
        """Print which of several files is finished or has failed."""
        print_note(json.dumps({**facts, "done": done_count, "files": total}))


class ProgressBar:
    """A progress bar on standard error, where that is a terminal and the work is long enough to watch.

    It counts frames, the passes of a single one, or files.
    """

    def __init__(self, frames: int, unit: Literal["frames", "files"] = "frames") -> None:
        self._quiet = not sys.stderr.isatty()
        self._frames = frames
        self._unit = "passes" if frames == 1 and unit == "frames" else unit
        self._progress: RichProgress | None = None
        self._started = time.perf_counter()

    def report_helpers(self, processes: Sequence[int]) -> None:
        """Nothing: a bar does not show processes."""

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """Show which nodes are computed."""
        if self._frames == 1:
            self._show(nodes[-1], passes_done, total)
        else:
            self._show(f"frame {frame}  {nodes[-1]}", None, self._frames)

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """Show how many frames are written."""
        if total > 1:
            self._show(f"frame {report.frame}", frames_done, total)

    def report_entry(self, facts: Mapping[str, Any], done_count: int, total: int) -> None:
        """Show how many files are finished."""
        self._show(PurePath(facts["file"]).name, done_count, total)

    def close(self) -> None:
        """Remove the bar."""
        if self._progress is not None:
            self._progress.stop()

    def _show(self, word: str, count: int | None, total: int) -> None:
        if self._quiet or time.perf_counter() - self._started < _PATIENCE:
            return
        if self._progress is None:
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

            counter = TextColumn("{task.completed}/{task.total} " + self._unit)
            time_left = () if self._unit == "passes" else (TimeRemainingColumn(), TextColumn("left"))
            columns = (TextColumn("{task.description:<24}", markup=False), BarColumn(), counter, *time_left)
            self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
            self._progress.start()
            self._progress.add_task("render", total=total)
        self._progress.update(self._progress.task_ids[0], completed=count, description=word)


ProgressReporter = JsonLines | ProgressBar
"""What the frames of a job, and the processes that share them, are reported to."""
