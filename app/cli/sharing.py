"""Frames shared among processes: each renders some of them, with a device of its own."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import LazyResourceProvider
from .outcome import note

if TYPE_CHECKING:
    from ..graph import Graph, Port
    from .progress import Told


def independent(graph: Graph, targets: Mapping[str, Port], inputs: Sequence[str], frame: int) -> bool:
    """True if every frame can be made without the ones before it. Raises the errors of `app.errors`."""
    from ..compiler import Request, compile_graph

    if graph.settings.preroll is not None:
        return True
    outside = LazyResourceProvider()
    plan = compile_graph(graph, Request(targets, outside.bind(graph, inputs), frame=frame), outside)
    for node in plan.remembering:
        note(f"one process renders all frames: node '{node}' makes each of the one before")
        break
    return not plan.memories


def piped(path: Path, graph: Graph) -> str:
    """What the processes shall read from standard input: the graph, if it came from there."""
    from .. import document

    return document.dumps(graph) if str(path) == "-" else ""


def share(words: Sequence[str], frames: Sequence[int], jobs: int, progress: Told, text: str) -> list[dict[str, Any]]:
    """Run `halation render` with those words in several processes, which read `text`; their reports.

    Raises HalationError with the sentence and exit code of the first one that fails; the others are stopped.
    """
    from ..graph.frames import format_frames

    parts = [part for start in range(jobs) if (part := frames[start::jobs])]
    threads = str(max(1, (os.cpu_count() or 1) // len(parts)))
    # Processes that each used all cores would only get into each other's way.
    fewer = {"LP_NUM_THREADS": threads, "OPENIMAGEIO_THREADS": threads}
    environment = {**fewer, **os.environ, "PYTHONIOENCODING": "utf-8"}
    command = [sys.executable, "-P", "-m", "halation.cli", "render", *words, "--json", "--progress=json"]
    crew = [
        subprocess.Popen(
            [*command, f"--frames={format_frames(part)}"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="surrogateescape",
            env=environment,
        )
        for part in parts
    ]
    progress.shared([one.pid for one in crew])
    listener = _Listener(progress, len(frames), text)
    threads_ = [threading.Thread(target=listener.follow, args=(one, crew), daemon=True) for one in crew]
    for thread in threads_:
        thread.start()
    try:
        for thread in threads_:
            thread.join()
    except KeyboardInterrupt:
        _stop(crew)
        for thread in threads_:
            thread.join()
        raise
    if listener.fault:
        raise listener.fault
    return listener.reports


class _Listener:
    """Collects what processes say."""

    def __init__(self, progress: Told, total: int, text: str) -> None:
        self._text = text
        self._progress, self._total, self._lock = progress, total, threading.Lock()
        self._done, self._said = 0, set[str]()
        self.reports: list[dict[str, Any]] = []
        self.fault: Exception | None = None

    def follow(self, process: subprocess.Popen[str], crew: Sequence[subprocess.Popen[str]]) -> None:
        """Listen to one of a crew until it has ended."""
        from ..errors import HalationError

        report: dict[str, Any] = {}
        with process:
            assert process.stdin and process.stdout and process.stderr
            with contextlib.suppress(OSError):  # it may end before it has read everything
                process.stdin.write(self._text)
            with contextlib.suppress(OSError):
                process.stdin.close()
            for line in process.stderr:
                with self._lock:
                    self._line(line.rstrip())
            with contextlib.suppress(ValueError):
                report = json.loads(process.stdout.read())
        code = process.returncode
        with self._lock:
            if code == 0:
                self.reports.append(report)
            elif self.fault is None:
                error = report.get("error", {})
                self.fault = HalationError(error.get("message", f"a process was ended by {code}"))
                self.fault.exit_code = error.get("exit_code", 1)
                _stop(crew)

    def _line(self, line: str) -> None:
        from ..renderer.jobs.job import FrameReport

        with contextlib.suppress(ValueError, KeyError, TypeError):
            told = json.loads(line)
            if "done" in told:
                self._done += 1
                written = tuple(Path(path) for path in told["written"])
                report = FrameReport(told["frame"], written, told["passes"], told["kept"])
                self._progress.finished(report, self._done, self._total)
            return
        if line and line not in self._said and not line.startswith("halation: "):
            self._said.add(line)
            note(line)


def _stop(crew: Sequence[subprocess.Popen[str]]) -> None:
    """Ask all to end: what they have finished stays."""
    for one in crew:
        if one.poll() is None:
            with contextlib.suppress(OSError):
                one.send_signal(signal.SIGINT) if sys.platform != "win32" else one.terminate()
