"""One render to files: starts its process, reads its progress, and stops it."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Literal

from msgspec import Struct

from ...graph import Graph
from ...language.translation import translate
from ...renderer.jobs.render_job import RenderJob, worker_command
from ...resources.atomic_write import remove_files_of

RenderState = Literal["waiting", "running", "done", "failed", "cancelled"]

_PATIENCE = 0.6
"""Seconds that a render may take to stop by itself and remove its unfinished files; `cancel` promises a second."""

_CLUSTER_PATIENCE = 1.5
"""The same where workers elsewhere have to be told; `cancel` promises two seconds then."""

_MOST_NOTES = 200
"""Lines of a render's log that are kept, the newest: more than anybody reads. Chosen by judgement."""

_MIN_DONE_FOR_ESTIMATE = 0.3
"""The fraction of the first frame that must be done before the remaining time is shown: earlier estimates jump."""


class QueuedJob(Struct, frozen=True):
    """The job that is sent to the process, and its graph; kept to start it again.

    `cluster` is the address of the workers that render, "" for this machine alone.
    """

    order: RenderJob
    graph: Graph
    cluster: str = ""

    @property
    def command(self) -> list[str]:
        """The command of the process."""
        return [*worker_command(), *(("--on", self.cluster) if self.cluster else ())]


class QueuedRender:
    """One render: it waits, runs, and ends. Everything may be read at any time.

    `done` and `total` count frames, or files where there are many, `kept` those that were there already; `frame` is the
    one under way, `passes` how many of its passes are through and of how many, `node` what was computed last. `faulty`
    counts the files that failed, `workers` the workers of a cluster. `sentence` says why it failed, `notes` what else
    there is to know, `written` the files that are there now.
    """

    def __init__(self, job: QueuedJob, ended: Callable[[], object] = bool) -> None:
        self.job = job
        self.state: RenderState = "waiting"
        self.done = self.reused = self.faulty = self.workers = 0
        self.total = max(len(job.order.entries or job.order.frames), 1)
        self.frame: int | None = None
        self.passes = (0, 0)
        self.node = self.failure = ""
        self.notes: tuple[str, ...] = ()
        self.written_files: tuple[Path, ...] = ()
        self.started_at = self.ended_at = 0.0
        self._first_pass_at = 0.0
        """When the first pass was done."""
        self._report_end, self._has_ended, self._lock = ended, threading.Event(), threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._helpers: tuple[int, ...] = ()
        self._cancelled = False

    @property
    def destinations(self) -> tuple[tuple[str, Path], ...]:
        """The names of outputs, and their files; with {stem} or the like where there are many."""
        return self.job.order.files

    @property
    def has_many_files(self) -> bool:
        """True if files are counted, and not frames."""
        return bool(self.job.order.entries)

    @property
    def folder(self) -> Path:
        """The folder of the files that are written; of many, that of the last one."""
        if not self.has_many_files:
            return self.destinations[0][1].parent
        return (self.written_files or (Path(self.job.order.entries[0].destinations[0][1]),))[-1].parent

    @property
    def fraction(self) -> float:
        """The fraction that is done, 0 to 1."""
        return 1.0 if self.state == "done" else min((self.done + self._partial_frame) / max(self.total, 1), 1.0)

    @property
    def seconds(self) -> float:
        """The running time in seconds."""
        return (self.ended_at or time.monotonic()) - self.started_at if self.started_at else 0.0

    @property
    def seconds_left(self) -> float | None:
        """The remaining seconds, if all frames take equally long; None while that is unknown."""
        finished_frames = self.done - self.reused + self._partial_frame
        if self.state != "running" or finished_frames < _MIN_DONE_FOR_ESTIMATE or not self._first_pass_at:
            return None
        return (
            (time.monotonic() - self._first_pass_at)
            / finished_frames
            * max(self.total - self.done - self._partial_frame, 0.0)
        )

    def begin(self) -> None:
        """Start the process. If that fails, `sentence` says why."""
        with self._lock:
            if self.state != "waiting":
                return
            self.started_at = time.monotonic()
            try:
                self._process = subprocess.Popen(
                    self.job.command,
                    cwd=self.job.graph.folder or ".",
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    encoding="utf-8",
                    errors="surrogateescape",
                    env={**os.environ, "PYTHONIOENCODING": "utf-8"},
                    start_new_session=True,
                )
            except OSError as fault:
                self.failure = translate(
                    "the render process cannot be started: {program} {reason}",
                    program=fault.filename or "",
                    reason=fault.strerror,
                )
                self._finish("failed")
                return
            self.state = "running"
        threading.Thread(target=self._run, args=(self._process,), name="export", daemon=True).start()

    def cancel(self) -> None:
        """Stop the process within a second, or two with a cluster; finished frames are kept.

        Nothing happens if it has ended.
        """
        with self._lock:
            if self.state == "waiting":
                self._finish("cancelled")
            if self._process is None or self.state != "running" or self._cancelled:
                return
            self._cancelled = True
        # A process that is killed cannot remove its unfinished files, so it gets a moment to stop.
        if sys.platform != "win32":
            self._process.terminate()
        patience = _CLUSTER_PATIENCE if self.job.cluster else _PATIENCE
        deadline = threading.Timer(patience if sys.platform != "win32" else 0.0, self._kill)
        deadline.daemon = True
        deadline.start()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the process has ended, at most `timeout` seconds; False if it still runs."""
        return self._has_ended.wait(timeout)

    # --- on the thread of its own ------------------------------------------------------------------------------------

    def _run(self, running: subprocess.Popen[str]) -> None:
        try:
            self._read_output(running)
        finally:
            if not self._has_ended.is_set():
                self.failure = translate(
                    "the render process sent an invalid message: use 'halation render' to see its output"
                )
                self._finish("failed")
            self._report_end()

    def _read_output(self, running: subprocess.Popen[str]) -> None:
        with running as process:
            assert process.stdin and process.stdout and process.stderr
            with contextlib.suppress(OSError):  # the process may end before it has read everything
                process.stdin.write(self.job.order.to_json())
            with contextlib.suppress(OSError):
                process.stdin.close()
            # A report of thousands of frames is longer than a pipe holds, so it is read meanwhile.
            outputs, report = list[str](), process.stdout
            reader = threading.Thread(target=lambda: outputs.append(report.read()), name="report", daemon=True)
            reader.start()
            for line in process.stderr:
                self._read_progress(line.rstrip())
            reader.join()
        self._remove_partial_files(running.pid)
        self._end(running.returncode, "".join(outputs))

    def _read_progress(self, line: str) -> None:
        """Read one line of progress from the process."""
        with contextlib.suppress(ValueError, KeyError, TypeError, IndexError):
            event = json.loads(line)
            if "processes" in event:
                self._helpers = tuple(map(int, event["processes"]))
                self._first_pass_at = time.monotonic()
            elif "done" in event:
                self._note_done(event)
            else:
                passes = int(event["pass"]), int(event["passes"])
                self.frame, self.node, self.passes = int(event["frame"]), str(event["nodes"][-1]), passes
                self._first_pass_at = self._first_pass_at or time.monotonic()
            return
        if line:
            self.notes = (*self.notes, line.removeprefix("-: "))[-_MOST_NOTES:]

    def _note_done(self, event: Mapping[str, Any]) -> None:
        """A frame is finished, or one of many files, which may have failed."""
        self.written_files = (*self.written_files, *map(Path, event["written"]))
        self.reused += bool(event["kept"])
        self.faulty += "error" in event
        self.done, self.workers, self.passes = int(event["done"]), int(event.get("workers", 0)), (0, 0)
        self.total = int(event["files"]) if "files" in event else int(event["frames"])
        self._first_pass_at = self._first_pass_at or self.started_at

    def _end(self, code: int, output: str) -> None:
        report: dict[str, Any] = {}
        with contextlib.suppress(ValueError):
            report = json.loads(output)
        if code == 0:
            self.written_files = tuple(Path(path) for path in report.get("written", ())) or self.written_files
            self._finish("done")
        elif self._cancelled:
            self._finish("cancelled")
        elif code > 0 and self.faulty:
            self.failure = translate("{count} of {total} files failed", count=self.faulty, total=self.total)
            self._finish("failed")
        else:
            fault = report.get("error", {}).get("message") or (
                self.notes[-1] if self.notes else translate("it gave no reason")
            )
            self.failure = (
                str(fault).removeprefix("-: ")
                if code > 0
                else translate("the process was ended by signal {signal}", signal=-code)
            )
            self._finish("failed")

    def _finish(self, state: RenderState) -> None:
        self.ended_at, self.state = time.monotonic(), state
        self._has_ended.set()

    def _kill(self) -> None:
        """Kill the process, and those that share its frames."""
        if self._process is None or self.state != "running":
            return
        with contextlib.suppress(OSError):
            os.killpg(self._process.pid, signal.SIGKILL) if sys.platform != "win32" else self._process.kill()

    def _remove_partial_files(self, process: int) -> None:
        """Remove the unfinished files of killed processes."""
        order = self.job.order
        destinations = [pair for entry in order.entries for pair in entry.destinations] or order.destinations
        remove_files_of((process, *self._helpers), (path for _, path in destinations))

    @property
    def _partial_frame(self) -> float:
        """The fraction of the current frame that is done."""
        finished, total = self.passes
        return finished / total if total else 0.0
