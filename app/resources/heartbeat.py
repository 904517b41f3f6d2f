"""Judges from outside whether code of a graph runs for too long, or takes too much memory.

The renderer writes to a file, the heartbeat, before and after it runs code of a graph (`ProgressBeacon`). A device that
is stuck blocks the process that uses it, so another process has to read the file and kill the first one.
"""

from __future__ import annotations

import signal
import time
from pathlib import Path

from ..errors import DeviceError, HalationError, RenderError, describe_owner
from .machine import has_memory_limit, machine_memory, resident_memory

BEACON_FILE = "HALATION_HEARTBEAT"
"""The environment variable with the path of the file."""

BEACON_TRIALS = "HALATION_TRIALS"
"""The environment variable that is not empty where a watched process tries programs in another one all the same."""

OWN_MEMORY = 256 << 20
"""Bytes that a driver may take for itself when it compiles, besides the limit: Mesa takes 120 MiB at first."""


class Watchdog:
    """Watches the heartbeat of one process.

    `timeout` is how many seconds code may run, 0 for no limit; `memory` how many bytes the process may grow by then.
    With `tries_first` it tries programs in a third process, as it would unwatched: more than one render ends with it.
    """

    def __init__(self, file: Path, timeout: float, memory: int = 0, tries_first: bool = False) -> None:
        self._file, self._timeout, self._tries_first = file, timeout, tries_first
        self._memory, self._has_memory_option = (memory or machine_memory() / 2) + OWN_MEMORY, memory > 0
        self._beat, self._since, self._idle_memory = "", time.monotonic(), 0
        file.touch()

    @property
    def environment(self) -> dict[str, str]:
        """The environment variables that tell the process where to write its heartbeat."""
        return {BEACON_FILE: str(self._file), BEACON_TRIALS: "1" if self._tries_first else ""}

    def check(self, process: int) -> DeviceError | None:
        """The error to raise if code has run for too long, or takes too much memory, else None."""
        heartbeat, memory = self._file.read_text(encoding="utf-8"), resident_memory(process)
        if not heartbeat:
            self._idle_memory = memory
        if heartbeat != self._beat:
            self._beat, self._since = heartbeat, time.monotonic()
        elif heartbeat and 0.0 < self._timeout < time.monotonic() - self._since:
            return self._fault(
                f"has not ended after {self._timeout:g} seconds, so the render was stopped: "
                "look for an endless loop, make the code smaller, or raise --timeout"
            )
        if heartbeat and memory - self._idle_memory > self._memory:
            return self._fault(
                f"takes more than {self._memory / 2**30:.1f} GiB of memory, so the render was stopped: "
                f"make the code smaller{', or raise --memory' if self._has_memory_option else ''}"
            )
        return None

    def explain_end(self, code: int) -> HalationError:
        """The error to raise after a signal or a library has ended the process: its exit code, or minus the signal."""
        name = name_end(code)
        self._beat = self._file.read_text(encoding="utf-8")
        if has_memory_limit():
            return explain_memory_limit(name)
        if self._beat:
            return self._fault(f"has ended the process ({name}) while it compiled or ran: make the code simpler")
        return explain_end(code)

    def _fault(self, sentence: str) -> DeviceError:
        nodes = self._beat.partition(" ")[2]
        return DeviceError(f"{describe_owner(nodes)}: its code {sentence}", node=nodes)


def name_end(code: int) -> str:
    """What has ended a process: the name of a signal, of which `code` is minus the number, or the exit code."""
    if code >= 0:
        return f"code {code}"
    try:
        return signal.Signals(-code).name
    except ValueError:
        return f"signal {-code}"


def explain_end(code: int) -> RenderError:
    """The error of a process that had not come to its end: a signal comes from outside, a code from a library."""
    where = "from outside" if code < 0 else "by a library"
    return RenderError(f"the render was ended {where} ({name_end(code)})")


def explain_memory_limit(name: str) -> RenderError:
    """The error of a process with limited memory that ended by a signal or with a code."""
    return RenderError(
        f"the driver ended the process ({name}), as drivers do without enough memory: allow more (ulimit -v), "
        "or render a smaller picture with --scale or --size"
    )
