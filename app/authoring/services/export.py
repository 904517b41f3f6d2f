"""One render to files: its process, what that tells, and how it is stopped."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from ...graph import Graph
from ...renderer.jobs.render_job import RenderJob, worker_command
from ...resources.atomic_write import temporary_prefix

State = Literal["waiting", "running", "done", "failed", "cancelled"]

_PATIENCE = 0.6
"""Seconds that a render may take to stop by itself."""

_MOST_NOTES = 200

_TOLD = 0.3
"""The part of a frame that must be done before anybody can say how long the rest takes."""


@dataclass(frozen=True)
class Job:
    """What is rendered, now or again: the job that is sent to a process, and its graph."""

    order: RenderJob
    graph: Graph


class Export:
    """One render: it waits, runs, and ends. Everything may be read at any time.

    `done` and `total` count frames, `kept` those that were there already; `frame` is the one under way, `passes` how
    many of its passes are through and of how many, `node` what was computed last. `sentence` says why it failed,
    `notes` what else there is to know, `written` the files that are there now.
    """

    def __init__(self, job: Job, ended: Callable[[], object] = bool) -> None:
        self.job = job
        self.state: State = "waiting"
        self.done = self.kept = 0
        self.total = max(len(job.order.frames), 1)
        self.frame: int | None = None
        self.passes = (0, 0)
        self.node = self.sentence = ""
        self.notes: tuple[str, ...] = ()
        self.written: tuple[Path, ...] = ()
        self.began = self.ended = 0.0
        self._first = 0.0
        """When the first pass was through."""
        self._tell, self._over, self._lock = ended, threading.Event(), threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._helpers: tuple[int, ...] = ()
        self._cancelled = False

    @property
    def destinations(self) -> tuple[tuple[str, Path], ...]:
        """Names of outputs, and where they go."""
        return self.job.order.files

    @property
    def fraction(self) -> float:
        """How much of it is done, 0..1."""
        return 1.0 if self.state == "done" else min((self.done + self._part) / max(self.total, 1), 1.0)

    @property
    def seconds(self) -> float:
        """How long it has been running, or ran."""
        return (self.ended or time.monotonic()) - self.began if self.began else 0.0

    @property
    def seconds_left(self) -> float | None:
        """How long it still takes, if the frames to come take as long as those before; None where nobody knows."""
        made = self.done - self.kept + self._part
        if self.state != "running" or made < _TOLD or not self._first:
            return None
        return (time.monotonic() - self._first) / made * max(self.total - self.done - self._part, 0.0)

    def begin(self) -> None:
        """Start the process. What it cannot do is its `sentence`."""
        with self._lock:
            if self.state != "waiting":
                return
            self.began = time.monotonic()
            try:
                self._process = subprocess.Popen(
                    worker_command(),
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
                self.sentence = f"the export cannot be started: {fault.filename or ''} {fault.strerror}"
                self._finish("failed")
                return
            self.state = "running"
        threading.Thread(target=self._follow, args=(self._process,), name="export", daemon=True).start()

    def cancel(self) -> None:
        """Stop it, within a second; finished frames stay. Nothing happens if it has ended."""
        with self._lock:
            if self.state == "waiting":
                self._finish("cancelled")
            if self._process is None or self.state != "running" or self._cancelled:
                return
            self._cancelled = True
        # Killed at once, it could not remove what it had begun to write. It may be busy, so it gets a moment.
        if sys.platform != "win32":
            self._process.send_signal(signal.SIGINT)
        deadline = threading.Timer(_PATIENCE if sys.platform != "win32" else 0.0, self._kill)
        deadline.daemon = True
        deadline.start()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until it has ended, at most `timeout` seconds; False if it has not."""
        return self._over.wait(timeout)

    # --- on the thread of its own ------------------------------------------------------------------------------------

    def _follow(self, running: subprocess.Popen[str]) -> None:
        try:
            self._listen(running)
        finally:
            if not self._over.is_set():
                self.sentence = "what the export says cannot be understood"
                self._finish("failed")
            self._tell()

    def _listen(self, running: subprocess.Popen[str]) -> None:
        with running as process:
            assert process.stdin and process.stdout and process.stderr
            with contextlib.suppress(OSError):  # it may end before it has read everything
                process.stdin.write(self.job.order.to_json())
            with contextlib.suppress(OSError):
                process.stdin.close()
            for line in process.stderr:
                self._hear(line.rstrip())
            said = process.stdout.read()
        self._tidy(running.pid)
        self._end(running.returncode, said)

    def _hear(self, line: str) -> None:
        """One line of what the process tells."""
        with contextlib.suppress(ValueError, KeyError, TypeError, IndexError):
            told = json.loads(line)
            if "processes" in told:
                self._helpers = tuple(map(int, told["processes"]))
                self._first = time.monotonic()
            elif "done" in told:
                self.written = (*self.written, *map(Path, told["written"]))
                self.kept += bool(told["kept"])
                self.done, self.total, self.passes = int(told["done"]), int(told["frames"]), (0, 0)
            else:
                passes = int(told["pass"]), int(told["passes"])
                self.frame, self.node, self.passes = int(told["frame"]), str(told["nodes"][-1]), passes
                self._first = self._first or time.monotonic()
            return
        if line:
            self.notes = (*self.notes, line.removeprefix("-: "))[-_MOST_NOTES:]

    def _end(self, code: int, said: str) -> None:
        report: dict[str, Any] = {}
        with contextlib.suppress(ValueError):
            report = json.loads(said)
        if code == 0:
            self.written = tuple(Path(path) for path in report.get("written", ())) or self.written
            self._finish("done")
        elif self._cancelled:
            self._finish("cancelled")
        else:
            fault = report.get("error", {}).get("message") or (self.notes[-1] if self.notes else "it gave no reason")
            self.sentence = str(fault).removeprefix("-: ") if code > 0 else f"the export was ended by signal {-code}"
            self._finish("failed")

    def _finish(self, state: State) -> None:
        self.ended, self.state = time.monotonic(), state
        self._over.set()

    def _kill(self) -> None:
        """End the process, and those that share its frames."""
        if self._process is None or self.state != "running":
            return
        with contextlib.suppress(OSError):
            os.killpg(self._process.pid, signal.SIGKILL) if sys.platform != "win32" else self._process.kill()

    def _tidy(self, process: int) -> None:
        """Remove what the processes had not finished when they were killed."""
        for folder in {Path(os.path.realpath(path)).parent for _, path in self.destinations}:
            for number in (process, *self._helpers):
                for part in folder.glob(f"{temporary_prefix(number)}*"):
                    with contextlib.suppress(OSError):
                        part.unlink()

    @property
    def _part(self) -> float:
        """How much of the frame under way is done."""
        done, total = self.passes
        return done / total if total else 0.0
