"""The watchdog: it ends a process whose graph has code that never ends.

The renderer writes to a file, the heartbeat, before and after it runs code of a graph. A device that is stuck blocks
the process that uses it, so another process has to read the file and kill the first one.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import DeviceError

if TYPE_CHECKING:
    from ..graph import Graph

CHECK_INTERVAL = 0.2
"""Seconds between two checks of the other process: a choice, so short that the user sees no delay when it ends."""

Timeout = Annotated[
    float,
    typer.Option(
        "--timeout",
        min=0.0,
        metavar="SECONDS",
        help="The longest that one pass of a code node may take; 0 for no limit.",
    ),
]


class Watchdog:
    """Watches the heartbeat of one process. `timeout` is how many seconds code may run."""

    def __init__(self, file: Path, timeout: float) -> None:
        self._file, self._timeout = file, timeout
        self._beat, self._since = "", time.monotonic()
        file.touch()

    @property
    def environment(self) -> dict[str, str]:
        """The environment variables that tell the process where to write its heartbeat."""
        from ..renderer.execution.progress_beacon import BEACON_FILE

        return {BEACON_FILE: str(self._file)}

    def check(self) -> DeviceError | None:
        """The error to raise if code has run for too long, else None."""
        heartbeat = self._file.read_text(encoding="utf-8")
        if heartbeat != self._beat:
            self._beat, self._since = heartbeat, time.monotonic()
        elif heartbeat and time.monotonic() - self._since > self._timeout:
            nodes = heartbeat.partition(" ")[2]
            return DeviceError(
                f"node '{nodes}': its code has not ended after {self._timeout:g} seconds, so the rendering was "
                "stopped: look for a loop without an end, or allow more with --timeout",
                node=nodes,
            )
        return None


def needs_watchdog(graph: Graph, timeout: float) -> bool:
    """True if code of the graph could run for ever and no process watches this one yet."""
    from ..renderer.execution.progress_beacon import BEACON_FILE

    return timeout > 0.0 and not os.environ.get(BEACON_FILE) and has_loops(graph)


def has_loops(graph: Graph) -> bool:
    """True if a node, also one in a group, has code with loops: only loops can run for ever."""
    from ..custom_nodes import CustomNode
    from ..glsl import words
    from ..graph import Group

    return any(
        has_loops(item.graph)
        if isinstance(item, Group)
        else isinstance(item, CustomNode) and bool({"for", "while", "do"} & words(item.code.text, item.code.vertex))
        for item in graph.nodes.values()
    )


def rerun_watched(context: typer.Context, path: Path, graph: Graph, timeout: float) -> int | None:
    """Run the same command in a watched process if code of the graph could run for ever, and return its exit code.

    Returns None if there is no such code, or if this is the watched process: then the caller goes on. `context` holds
    the arguments of the command. A graph from standard input (`path` is "-") is passed on. Raises DeviceError when a
    pass takes longer than `timeout` seconds.
    """
    if not needs_watchdog(graph, timeout):
        return None
    from .. import document

    text = document.dumps(graph) if str(path) == "-" else ""
    command = [sys.executable, "-P", "-m", "halation.cli", *context.obj]
    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        return _watch(command, Watchdog(Path(folder, "heartbeat"), timeout), text)


def _watch(command: list[str], watchdog: Watchdog, text: str) -> int:
    environment = {**os.environ, **watchdog.environment}
    with (
        _ignore_interrupts(),
        subprocess.Popen(command, stdin=subprocess.PIPE if text else None, env=environment) as process,
    ):
        if process.stdin:
            process.stdin.write(text.encode())
            process.stdin.close()
        while True:
            try:
                return process.wait(CHECK_INTERVAL)
            except subprocess.TimeoutExpired:
                if fault := watchdog.check():
                    process.kill()
                    raise fault from None


@contextmanager
def _ignore_interrupts() -> Iterator[None]:
    """Ignore interrupts here: the other process gets them too, and tidies up before it ends."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
