"""Runs render jobs in helper processes, which share the frames of a job or run code that may never end.

Each helper is a `halation worker`: it reads a `RenderJob` as JSON, renders with a device of its own, and reports in
lines of JSON, which this process shows as if it rendered itself. If code of the graph could run for ever, each helper
has a watchdog here: when one helper is stuck, it is killed and the others are stopped.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import HalationError, rebuild_fault
from ..resources.atomic_write import remove_files_of
from ..resources.heartbeat import Watchdog, name_end
from ..resources.interrupts import delay_interrupts
from ..resources.machine import available_cores
from .outcome import print_note
from .watched_copy import CHECK_INTERVAL

if TYPE_CHECKING:
    from ..renderer.jobs.render_job import RenderJob
    from .progress import ProgressReporter


_PATIENCE = 1.2
"""Seconds that a helper may take to end and to remove its unfinished files: Ctrl-C ends all within two."""


def run_helpers(
    jobs: Sequence[RenderJob],
    watched: bool,
    timeout: float,
    progress: ProgressReporter,
    total: int,
    report_entry: Callable[[Mapping[str, Any]], None] | None = None,
) -> list[dict[str, Any]]:
    """Render each job in a process of its own; their reports. `total` is how many frames they have together.

    `report_entry` takes the report of each file of jobs with many.

    If they are `watched`, a helper whose code takes longer than `timeout` seconds is killed; 0 means no limit. Raises
    HalationError with the message and exit code of the first helper that fails; the others are stopped.
    """
    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        pool = _HelperPool(jobs, watched, timeout, progress, total, Path(folder), report_entry)
        return pool.run()


def join_reports(reports: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """One report from those of several processes. Each has textures of its own, so their bytes are added."""
    total = join_costs(reports)
    for report in reports[1:]:
        for name in ("written", "frames", "kept"):
            total[name] = [*total[name], *report[name]]
    if len(reports) == 1:
        return total
    order = sorted(range(len(total["frames"])), key=lambda place: total["frames"][place])
    files_per_frame = len(total["written"]) // max(1, len(order))
    total["written"] = [
        path for place in order for path in total["written"][place * files_per_frame : (place + 1) * files_per_frame]
    ]
    return {**total, "frames": sorted(total["frames"]), "kept": sorted(total["kept"])}


def join_chunk_costs(reports: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """What chunks on several machines have in their reports of costs, as one: the bytes are those of the largest."""
    data = dict.fromkeys(name for report in reports for name in report["data"])
    return {**join_costs(reports), "peak_bytes": max(report["peak_bytes"] for report in reports), "data": list(data)}


def join_costs(reports: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """What processes that work side by side have in their reports of costs, as one, with all else of the first."""
    total = dict(reports[0])
    for report in reports[1:]:
        for name in ("passes", "programs", "peak_bytes"):
            total[name] += report[name]
        for name in ("repaired", "warnings", "views"):
            total[name] = {**total[name], **report[name]}
        total["seconds"] = {name: max(seconds, report["seconds"][name]) for name, seconds in total["seconds"].items()}
    return total


class _Helper:
    """A process, its job and, if there is a time limit, its watchdog."""

    def __init__(self, job: RenderJob, watchdog: Watchdog | None, environment: Mapping[str, str]) -> None:
        from ..renderer.jobs.render_job import worker_command

        self.job, self.watchdog = job, watchdog
        self._stopped_at: float | None = None
        self.process = subprocess.Popen(
            [*worker_command(), "--share"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="surrogateescape",
            env={**environment, **(watchdog.environment if watchdog else {})},
        )

    def stop(self) -> None:
        """Ask it to end, once: a second signal would interrupt it while it removes what it has begun to write."""
        if self.process.poll() is None and self._stopped_at is None:
            self._stopped_at = time.monotonic()
            with contextlib.suppress(OSError):
                self.process.terminate()

    def end_late(self) -> None:
        """Kill it if it was asked to end some time ago: a long pass of a driver cannot be interrupted."""
        if self._stopped_at is not None and time.monotonic() - self._stopped_at > _PATIENCE:
            self.process.kill()

    def remove_files(self) -> None:
        """Remove the unfinished files of a helper that was killed."""
        destinations = [*self.job.files, *(pair for entry in self.job.entries for pair in entry.destinations)]
        remove_files_of((self.process.pid,), (path for _, path in destinations))


class _HelperPool:
    """The helpers of one render, a thread that listens to each, and their reports so far."""

    def __init__(
        self,
        jobs: Sequence[RenderJob],
        watched: bool,
        timeout: float,
        progress: ProgressReporter,
        total: int,
        folder: Path,
        report_entry: Callable[[Mapping[str, Any]], None] | None,
    ) -> None:
        self._report_entry = report_entry
        self._progress, self._total, self._lock = progress, total, threading.Lock()
        self._done, self._notes = 0, set[str]()
        self._reports: list[dict[str, Any]] = []
        self._fault: HalationError | None = None
        environment = {**_divide_cores(len(jobs)), **os.environ, "PYTHONIOENCODING": "utf-8"}
        self._helpers = [
            _Helper(job, Watchdog(folder / f"heartbeat{number}", timeout, job.memory) if watched else None, environment)
            for number, job in enumerate(jobs)
        ]
        from ..renderer.jobs.reports import FrameReport  # this import is slow, so the helpers start first

        self._frame_report = FrameReport

    def run(self) -> list[dict[str, Any]]:
        """Wait for all helpers and return their reports. Raises HalationError as `run_helpers`."""
        self._progress.report_helpers([helper.process.pid for helper in self._helpers])
        with delay_interrupts():
            threads = ThreadPoolExecutor(len(self._helpers), thread_name_prefix="helper")
            ends = [threads.submit(self._listen, helper) for helper in self._helpers]
        try:
            self._wait(ends)
        except KeyboardInterrupt:
            self._stop()
            self._wait(ends)
            raise
        if self._fault:
            raise self._fault
        return self._reports

    def _wait(self, ends: Iterable[Future[None]]) -> None:
        """Wait for the futures and not for their threads: Python 3.11 takes a thread for ended when an interrupt
        arrives during `Thread.join`."""
        while wait(ends, CHECK_INTERVAL).not_done:
            for helper in self._helpers:
                self._check(helper)
                helper.end_late()

    def _check(self, helper: _Helper) -> None:
        """Kill a helper whose code takes too long, and stop the others."""
        if helper.watchdog is None or helper.process.poll() is not None:
            return
        if fault := helper.watchdog.check(helper.process.pid):
            with self._lock:
                self._fault = self._fault or fault
                helper.process.kill()
                self._stop()

    def _stop(self) -> None:
        for helper in self._helpers:
            helper.stop()

    # --- on the threads that listen ----------------------------------------------------------------------------------

    def _listen(self, helper: _Helper) -> None:
        """Send a helper its job and read what it writes until it ends."""
        report: dict[str, Any] = {}
        with helper.process as process:
            assert process.stdin and process.stdout and process.stderr
            with contextlib.suppress(OSError):  # it may end before it has read all
                process.stdin.write(helper.job.to_json())
            with contextlib.suppress(OSError):
                process.stdin.close()
            for line in process.stderr:
                with self._lock:
                    self._handle_line(line.rstrip())
            with contextlib.suppress(ValueError):
                report = json.loads(process.stdout.read())
        if process.returncode < 0:
            helper.remove_files()
        with self._lock:
            if process.returncode == 0:
                self._reports.append(report)
            elif self._fault is None and helper.watchdog and process.returncode < 0:
                self._fault = helper.watchdog.explain_end(process.returncode)
                self._stop()
            elif self._fault is None:
                end = name_end(process.returncode)
                sentence = f"a process that renders was ended from outside ({end}): use --resume to go on"
                self._fault = rebuild_fault({"message": sentence, **report.get("error", {})})
                self._stop()

    def _handle_line(self, line: str) -> None:
        """One line that a helper writes: progress as JSON, or a note for the user, which is shown once."""
        with contextlib.suppress(ValueError, KeyError, TypeError):
            event = json.loads(line)
            if "file" in event:
                if self._report_entry is not None:
                    del event["done"], event["files"]  # they count what the helper has done, not all
                    self._report_entry(event)
            elif "done" in event:
                self._done += 1
                written = tuple(Path(path) for path in event["written"])
                report = self._frame_report(event["frame"], written, event["passes"], event["kept"])
                self._progress.report_frame(report, self._done, self._total)
            elif len(self._helpers) == 1:  # passes of several frames at once cannot be shown
                self._progress.report_pass(event["frame"], event["pass"], event["passes"], event["nodes"])
            return
        if line and line not in self._notes and not line.startswith("halation: "):
            self._notes.add(line)
            print_note(line)


def _divide_cores(helpers: int) -> dict[str, str]:
    """Environment variables that divide the cores among the helpers; each using all of them is slower."""
    if helpers == 1:
        return {}
    threads = str(max(1, available_cores() // helpers))
    return {"LP_NUM_THREADS": threads, "OPENIMAGEIO_THREADS": threads}
