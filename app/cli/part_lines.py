"""Lines about the frames or files that a worker of a cluster has finished."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..renderer.jobs.reports import FrameReport


class PartLines:
    """Writes a line for each finished frame or file, with the seconds since the one before."""

    def __init__(self, write_line: Callable[[Mapping[str, Any]], None]) -> None:
        self._write_line, self._started = write_line, time.perf_counter()

    def write(self, part: int, passes: int, *, is_kept: bool, **facts: object) -> None:
        """Write the line."""
        seconds, self._started = time.perf_counter() - self._started, time.perf_counter()
        self._write_line({"frame": part, "seconds": round(seconds, 4), "kept": is_kept, "passes": passes, **facts})


class FrameLines:
    """Has a line written for each finished frame."""

    def __init__(self, lines: PartLines) -> None:
        self._lines = lines

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """Nothing: passes of several machines cannot be shown."""

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """Write the line."""
        self._lines.write(report.frame, report.passes, is_kept=report.is_kept)
