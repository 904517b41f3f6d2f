"""Shows how far the frames or files on a cluster are: as a bar on terminals, or as lines of JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal

from .execute_batch import FAILED, BatchReporter, print_batch_report
from .outcome import print_note, write_count

if TYPE_CHECKING:
    from rich.progress import Progress

    from ..cluster.campaign_report import CampaignReport
    from ..renderer.jobs.render_entry import RenderEntry
    from ..renderer.jobs.render_job import RenderJob

_SLOWEST = 3
"""Frames that the bar names: those that take longest, which is what a user looks for."""


class ClusterProgress:
    """Shows finished frames, workers, the time left and the slowest frames. `dashboard` is Dask's page, if any."""

    def __init__(self, job: RenderJob, total: int, kind: Literal["bar", "json"], dashboard: str) -> None:
        self._job, self._total, self._kind, self._dashboard = job, total, kind, dashboard
        self._reported = set[int]()
        self._workers = 0
        self._progress: Progress | None = None

    def __enter__(self) -> ClusterProgress:
        """Show the bar, where there is a terminal."""
        if self._dashboard:
            print_note(f"dashboard {self._dashboard}")
        if self._kind == "bar" and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

            unit = "files" if self._job.entries else "frames"
            counter = TextColumn(f"{{task.completed}}/{{task.total}} {unit}")
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

    def report_progress(self, report: CampaignReport, workers: int) -> None:
        """Show the finished frames."""
        if self._kind == "json":
            for frame in [frame for frame in report.seconds if frame not in self._reported]:
                self._reported.add(frame)
                facts: dict[str, Any] = {
                    "frame": frame,
                    "done": len(self._reported),
                    "frames": self._total,
                    "written": list_written(self._job.destinations, (frame,)),
                    "kept": frame in report.kept,
                    "seconds": report.seconds[frame],
                    "workers": workers,
                }
                print_note(json.dumps(facts))
        self.show(report, workers)

    def show(self, report: CampaignReport, workers: int) -> None:
        """Update the bar."""
        self._workers = workers
        if self._progress is None:
            return
        slowest = sorted(report.seconds.items(), key=lambda pair: -pair[1])[:_SLOWEST]
        entries = self._job.entries
        names = ", ".join(
            f"{entries[part - 1].file if entries else part} ({seconds:.1f} s)" for part, seconds in slowest
        )
        words = f"{write_count(workers, 'worker')}, slowest {names}"
        completed = len({*report.seconds, *(report.faults if entries else ())})
        self._progress.update(self._progress.task_ids[0], completed=completed, description=words)

    def report_entry(self, facts: Mapping[str, Any], done_count: int, total: int) -> None:
        """Print which of several files is finished or has failed."""
        if self._kind == "json":
            print_note(json.dumps({**facts, "done": done_count, "files": total, "workers": self._workers}))

    def report_note(self, sentence: str) -> None:
        """Print a sentence above the bar."""
        if self._progress is not None:
            self._progress.console.print(sentence, soft_wrap=True, markup=False, highlight=False)
        else:
            print_note(sentence)


class EntryListener:
    """Reports the files of a job with many as `render --each` does in one process, and shows the rest in `bar`."""

    def __init__(self, job: RenderJob, bar: ClusterProgress, as_json: bool) -> None:
        self._job, self._bar, self._as_json = job, bar, as_json
        self._counts = BatchReporter(bar, len(job.entries), as_json)
        self._reported = set[int]()

    def report_progress(self, report: CampaignReport, workers: int) -> None:
        """Report the files that are finished or have failed."""
        self._bar.show(report, workers)
        for number in [number for number in (*report.seconds, *report.faults) if number not in self._reported]:
            self._reported.add(number)
            self._counts.report_entry(_describe_part(number, self._job.entries[number - 1], report))

    def report_note(self, sentence: str) -> None:
        """Print a sentence above the bar."""
        self._bar.report_note(sentence)

    def print_report(self, report: CampaignReport, seconds: float) -> int:
        """Print what was done in `seconds`, and every file that failed; the exit code."""
        from .helpers import join_chunk_costs

        nothing: dict[str, Any] = {"repaired": {}, "warnings": {}, "views": {}, "data": [], "seconds": {}}
        costs = join_chunk_costs(report.costs) if report.costs else nothing
        facts = {**costs, "workers": len(report.workers), "chunks": report.chunks}
        print_batch_report(facts, self._counts, seconds, self._as_json)
        return FAILED if self._counts.faults else 0


def _describe_part(number: int, entry: RenderEntry, report: CampaignReport) -> dict[str, Any]:
    """The report of a file, ready for JSON, as that of one process."""
    outcome, fault = report.entries.get(number), report.faults.get(number)
    frames = outcome.frames if outcome else ()
    facts = {
        "file": entry.file,
        "written": list_written(entry.destinations, frames, with_videos=fault is None),
        "frames": list(frames),
        "kept": number in report.kept,
        "passes": outcome.passes if outcome else 0,
    }
    return facts if fault is None else {**facts, "error": dict(fault)}


def list_written(
    destinations: Sequence[tuple[str, str]], frames: Sequence[int], *, with_videos: bool = True
) -> list[str]:
    """The files of frames, as the user names them: those of each frame, then the videos, which hold all of them."""
    from ..graph.frames import Pattern, is_video

    names: list[str] = []
    for frame in frames:
        for _, path in destinations:
            if not is_video(path):
                pattern = Pattern.parse(path)
                names.append(path if pattern is None else pattern.name(frame))
    videos = [path for _, path in destinations if is_video(path)]
    return list(dict.fromkeys([*names, *(videos if with_videos and frames else ())]))
