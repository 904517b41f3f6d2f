"""What a render begins before its command is imported, which takes one processor a fifth of a short render.

The driver is loaded on another thread. Where the graph may have code, the process is copied before: this one watches
then (`watched_copy.py`), and its copy goes on. A process that has threads could not be copied any more.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path

from ..resources.heartbeat import BEACON_FILE
from ..resources.machine import has_memory_limit
from .watched_copy import go_on_in_copy, has_copies

_CODE_TYPES = b'"glsl"', b'"isf"'
"""Text in each file of a graph with code nodes."""

_START = 1 << 20
"""Bytes of a graph that are looked at: more than most have. Later code is watched too, by a process of its own."""

_LIBRARIES = (
    "_bisect", "_blake2", "_contextvars", "_hashlib", "_heapq", "_json", "_posixsubprocess", "_socket", "bz2",
    "datetime", "decimal", "dis", "fcntl", "lzma", "mmap", "msgspec", "select", "zlib",
)  # fmt: skip
"""Modules that are libraries of the system, or import one, among what a render imports before numpy. The system loads
one at a time: after the driver has begun, the first of them would wait for it, 25 ms, and Python with it."""

_ELSEWHERE = "-j", "--jobs", "--cluster", "--deterministic", "--help"
"""Options of renders that this process does not draw, or by a driver with settings of its own."""


def begin_early(arguments: Sequence[str]) -> int | None:
    """Begin a render whose graph is a file. An exit code, if a copy of this process has done the work, else None."""
    if not _renders_here(arguments) or (graph := _find_graph(arguments)) is None:
        return None
    may_need_watchdog = not os.environ.get(BEACON_FILE) and any(name in graph for name in _CODE_TYPES)
    if may_need_watchdog and (code := go_on_in_copy(as_json="--json" in arguments)) is not None:
        return code
    from ..renderer.opengl.warming import warm

    for name in _LIBRARIES:
        with suppress(ImportError):  # not every Python is built with all of them
            import_module(name)
    with suppress(RuntimeError):  # no thread can be started: the command says so
        warm()
    return None


def _renders_here(arguments: Sequence[str]) -> bool:
    return (
        has_copies()
        and arguments[:1] == ["render"]
        and not has_memory_limit()
        and not any(word.startswith(_ELSEWHERE) for word in arguments)
    )


def _find_graph(arguments: Sequence[str]) -> bytes | None:
    """The start of the first argument that is a file for graphs; None without one. The command says what is wrong."""
    path = next((word for word in arguments[1:] if word.endswith(".json")), "")
    try:
        if not stat.S_ISREG(Path(path).stat().st_mode):
            return None
        with open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as file:
            return file.read(_START)
    except (OSError, ValueError):
        return None
