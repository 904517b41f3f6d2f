"""Renders to files in a process of its own: the interface stays quick, and a fault there harms nothing here."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from ... import document
from ...compiler import Precision
from ...errors import OutputError, UsageError
from ...graph import Graph
from ...media.store import part_prefix

State = Literal["running", "done", "failed", "cancelled"]

_PATIENCE = 0.6
"""Seconds that a render may take to stop by itself."""


@dataclass(frozen=True)
class Options:
    """What to render and how to write it, as `halation render` has it."""

    node: str = ""
    size: tuple[int, int] | None = None
    scale: float = 1.0
    frame: int = 1
    precision: Precision | None = None
    view: str = ""
    compression: str = "zip"

    def words(self) -> Iterator[str]:
        """The flags for it."""
        yield from (f"--scale={self.scale!r}", f"--frame={self.frame}", f"--compression={self.compression}")
        if self.size:
            yield f"--size={self.size[0]}x{self.size[1]}"
        for flag, text in (("node", self.node), ("precision", self.precision), ("view", self.view)):
            if text:
                yield f"--{flag}={text}"


class Export:
    """One render that is under way. Everything may be read at any time.

    `done` and `total` count passes and `node` is what was rendered last; after the last pass files are written.
    `sentence` says why it failed, `notes` what else there is to know, `written` what there is now.
    """

    def __init__(self, process: subprocess.Popen[str], text: str, destinations: Sequence[tuple[str, Path]]) -> None:
        self.destinations = tuple(destinations)
        self.started = time.monotonic()
        self.state: State = "running"
        self.done = self.total = 0
        self.node = self.sentence = ""
        self.notes: tuple[str, ...] = ()
        self.written: tuple[Path, ...] = ()
        self._process = process
        self._cancelled = False
        self._thread = threading.Thread(target=self._follow, args=(text,), name="export", daemon=True)
        self._thread.start()

    def cancel(self) -> None:
        """Stop it, within a second; files stay as they were. Nothing happens if it has ended."""
        if self.state != "running" or self._cancelled:
            return
        self._cancelled = True
        # Killed at once, it could not remove what it had begun to write. It may be busy, so it gets a moment.
        if sys.platform != "win32":
            self._process.send_signal(signal.SIGINT)
        deadline = threading.Timer(_PATIENCE if sys.platform != "win32" else 0.0, self._process.kill)
        deadline.daemon = True
        deadline.start()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until it has ended, at most `timeout` seconds; False if it has not."""
        self._thread.join(timeout)
        return not self._thread.is_alive()

    # --- on the thread of its own ------------------------------------------------------------------------------

    def _follow(self, text: str) -> None:
        with self._process as process:
            assert process.stdin and process.stdout and process.stderr
            with contextlib.suppress(OSError):  # it may end before it has read everything
                process.stdin.write(text)
            with contextlib.suppress(OSError):
                process.stdin.close()
            for line in process.stderr:
                self._hear(line.rstrip())
            said = process.stdout.read()
        self._tidy()
        self._end(process.returncode, said)

    def _hear(self, line: str) -> None:
        """One line of what the process tells."""
        with contextlib.suppress(ValueError, KeyError, TypeError, IndexError):
            told = json.loads(line)
            self.node, self.done, self.total = str(told["nodes"][-1]), int(told["pass"]), int(told["passes"])
            return
        if line:
            self.notes = (*self.notes, line.removeprefix("-: "))

    def _end(self, code: int, said: str) -> None:
        report: dict[str, Any] = {}
        with contextlib.suppress(ValueError):
            report = json.loads(said)
        if code == 0:
            self.written = tuple(Path(path) for path in report.get("written", ()))
            self.state = "done"
        elif self._cancelled:
            self.state = "cancelled"
        else:
            fault = report.get("error", {}).get("message") or (self.notes[-1] if self.notes else "it gave no reason")
            self.sentence = str(fault).removeprefix("-: ") if code > 0 else f"the export was ended by signal {-code}"
            self.state = "failed"

    def _tidy(self) -> None:
        """Remove what the process had not finished when it was killed."""
        for folder in {Path(os.path.realpath(path)).parent for _, path in self.destinations}:
            for part in folder.glob(f"{part_prefix(self._process.pid)}*"):
                with contextlib.suppress(OSError):
                    part.unlink()


class Exports:
    """The exports of one editor."""

    def __init__(self) -> None:
        self.all: tuple[Export, ...] = ()

    @property
    def running(self) -> tuple[Export, ...]:
        """Those that have not ended."""
        return tuple(one for one in self.all if one.state == "running")

    def start(
        self, graph: Graph, destinations: Sequence[tuple[str, Path]], bindings: Mapping[str, object] | None = None,
        options: Options = Options(),
    ) -> Export:
        """Render the graph as it is now, saved or not, to pairs of an output's name and a file; "" is all outputs.

        `bindings` are files for graph inputs. Raises UsageError, OutputError, and GraphError for what JSON cannot hold.
        """
        if not destinations:
            raise UsageError("nothing says where to write: choose a file")
        files = [(name, path.absolute()) for name, path in destinations]
        words = [
            # -P: a folder with graphs in it is no place to import modules from.
            sys.executable, "-P", "-m", "halation.app.cli", "render", "-", "--json", "--progress=json",
            *options.words(),
        ]
        for name, path in files:
            words += ["-o", f"{name}={path}" if name else str(path)]
        for name, item in (bindings or {}).items():
            if not isinstance(item, str | Path):
                raise UsageError(f"input '{name}' is filled from memory, which an export cannot see: save it to a file")
            words += ["-i", f"{name}={os.path.abspath(item)}"]  # noqa: PTH100 - a layer may follow the path
        text, folder = document.dumps(graph), graph.folder or "."
        try:
            process = subprocess.Popen(
                words, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                encoding="utf-8", errors="surrogateescape", env={**os.environ, "PYTHONIOENCODING": "utf-8"},
                start_new_session=True,
            )
        except OSError as fault:
            raise OutputError(f"the export cannot be started: {fault.filename or ''} {fault.strerror}") from None
        self.all = (*self.all, Export(process, text, files))
        return self.all[-1]

    def clear(self) -> None:
        """Forget those that have ended."""
        self.all = self.running

    def close(self, wait: bool = False) -> None:
        """Cancel what is running, or wait for it."""
        for one in self.running:
            if not wait:
                one.cancel()
        for one in self.all:
            one.wait()
