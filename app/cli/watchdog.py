"""The watchdog: code of a graph runs in a process that another one ends if it never comes back."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from ..graph import Graph

PATIENCE = 60.0
_LOOK = 0.2
"""Seconds between two looks at the other process."""

Timeout = Annotated[
    float,
    typer.Option(
        "--timeout",
        min=0.0,
        metavar="SECONDS",
        help="How long a pass of code that is written in the graph may take; 0 for as long as it likes.",
    ),
]


def watched(context: typer.Context, graph: Graph, timeout: float, text: str = "") -> int | None:
    """Run this very command in another process, if code of the graph could keep it for ever; its exit code.

    None if there is nothing to fear, or this is that process: then go on. `context` holds the words of the command,
    `text` is what it reads from standard input. Raises DeviceError once a pass has taken longer than `timeout` seconds.
    """
    from ..renderer.opengl.heartbeat import HEARTBEAT

    if not timeout or os.environ.get(HEARTBEAT) or not has_loops(graph):
        return None
    import tempfile

    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        beat = Path(folder, "heartbeat")
        beat.touch()
        return _watch([sys.executable, "-P", "-m", "halation.cli", *context.obj], beat, timeout, text)


def has_loops(graph: Graph) -> bool:
    """True if somebody wrote code with loops in it, or in one of its groups: only those can take for ever."""
    from ..custom_nodes import Written
    from ..glsl import words
    from ..graph import Group

    return any(
        has_loops(item.graph)
        if isinstance(item, Group)
        else isinstance(item, Written) and bool({"for", "while", "do"} & words(item.code.text, item.code.vertex))
        for item in graph.nodes.values()
    )


def _watch(command: list[str], beat: Path, timeout: float, text: str) -> int:
    from ..errors import DeviceError
    from ..renderer.opengl.heartbeat import HEARTBEAT

    environment = {**os.environ, HEARTBEAT: str(beat)}
    with _undisturbed(), subprocess.Popen(command, stdin=subprocess.PIPE if text else None, env=environment) as process:
        if process.stdin:
            process.stdin.write(text.encode())
            process.stdin.close()
        said, since = "", time.monotonic()
        while True:
            try:
                return process.wait(_LOOK)
            except subprocess.TimeoutExpired:
                now = beat.read_text(encoding="utf-8")
            if now != said:
                said, since = now, time.monotonic()
            elif said and time.monotonic() - since > timeout:
                process.kill()
                nodes = said.partition(" ")[2]
                raise DeviceError(
                    f"node '{nodes}': its code has not ended after {timeout:g} seconds, so the rendering was stopped: "
                    "look for a loop without an end, or allow more with --timeout",
                    node=nodes,
                )


@contextmanager
def _undisturbed() -> Iterator[None]:
    """An interrupt is for the other process, which hears it too, and ends as it should."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
