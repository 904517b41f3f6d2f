"""A copy of this process that does the work while this one watches. Linux alone has what it takes.

It needs no more than the standard library and `heartbeat`, so that a process can be copied before it imports a command.
"""

from __future__ import annotations

import os
import select
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from ..errors import DeviceError, HalationError
from ..resources.heartbeat import Watchdog, explain_end
from .signals import end_with_parent_thread, ignore_interrupts, relay_requests

CHECK_INTERVAL = 0.05
"""Seconds between two checks of the other process. A compiler takes at most 0.2 GB of memory in that time, measured
with Mesa 22.3."""


def has_copies() -> bool:
    """True if this system has all that a watched copy takes."""
    return sys.platform == "linux" and hasattr(os, "pidfd_open") and hasattr(os, "memfd_create")


def count_threads() -> int:
    """The threads of this process that the system lists, Python's and others."""
    return len([*Path("/proc/self/task").iterdir()])


class Judge(Protocol):
    """Says when a process has to end, and why it has ended."""

    def check(self, process: int) -> DeviceError | None:
        """The error to raise if the process has to end, else None."""
        ...

    def explain_end(self, code: int) -> HalationError:
        """The error to raise after a signal or a library has ended the process: its exit code, or minus the signal."""
        ...


class LateWatchdog:
    """A watchdog of a copy that was made before anyone knew its limits: the copy says them when it needs a watchdog."""

    def __init__(self) -> None:
        self._heartbeat = make_heartbeat()
        self._limits, self._orders = os.pipe()
        os.set_blocking(self._limits, False)
        self._watchdog: Watchdog | None = None

    def begin(self, timeout: float, memory: int) -> None:
        """Called in the copy: be watched from now on, with the limits of `Watchdog`."""
        os.environ.update(Watchdog(self._heartbeat, timeout, memory).environment)
        os.write(self._orders, f"{timeout!r} {memory}".encode())

    def check(self, process: int) -> DeviceError | None:
        """As `Watchdog.check`, once the limits are known."""
        watchdog = self._find()
        return watchdog.check(process) if watchdog else None

    def explain_end(self, code: int) -> HalationError:
        """As `Watchdog.explain_end`."""
        watchdog = self._find()
        return watchdog.explain_end(code) if watchdog else explain_end(code)

    def _find(self) -> Watchdog | None:
        if self._watchdog is None:
            try:
                timeout, memory = os.read(self._limits, select.PIPE_BUF).split()
            except (BlockingIOError, ValueError):  # nothing was said yet, or the copy has ended without a word
                return None
            self._watchdog = Watchdog(self._heartbeat, float(timeout), int(memory))
        return self._watchdog


class _Watch:
    """The watchdog of this process, if it is a copy that was made early."""

    late: LateWatchdog | None = None


def go_on_in_copy(*, as_json: bool) -> int | None:
    """Copy this process, which has printed nothing. None in the copy; here its exit code, in time.

    What ends the copy is reported here. The copy can be watched from then on: `begin_late_watchdog`. Where the system
    allows no other process, or this one has threads, which would be missing, there is no copy, and this one goes on.
    """
    if count_threads() > 1:
        return None
    try:
        watchdog = LateWatchdog()
        process = os.fork()
    except OSError:
        return None
    if process == 0:
        enter_copy()
        _Watch.late = watchdog
        return None
    try:
        return watch_copy(process, watchdog)
    except (HalationError, KeyboardInterrupt) as fault:
        from .outcome import flush_output, report_failure

        return flush_output(report_failure(fault, as_json))


def begin_late_watchdog(timeout: float, memory: int) -> bool:
    """Have the process that this one was copied from watch it from now on; False if there is none."""
    if _Watch.late is None:
        return False
    _Watch.late.begin(timeout, memory)
    return True


def make_heartbeat() -> Path:
    """A file that lies in memory, and ends with this process. Others reach it by its path."""
    return Path(f"/proc/{os.getpid()}/fd/{os.memfd_create('heartbeat')}")


def enter_copy() -> None:
    """Called in a copy: end with the process that watches, and leave interrupts to it."""
    end_with_parent_thread()
    ignore_interrupts()


def wait_for_end(handle: int, seconds: float) -> bool:
    """Wait for a process for some time; True if it has ended."""
    return bool(select.select([handle], [], [], seconds)[0])


def watch_copy(process: int, judge: Judge, wait: Callable[[int, float], bool] = wait_for_end) -> int:
    """Watch a copy of this process until it ends, and return its exit code. `wait` may do more than to wait.

    Raises what `judge` finds, and KeyboardInterrupt if this process was asked to end.
    """
    handle = os.pidfd_open(process)
    try:
        with relay_requests(process, is_copy=True) as requests:
            while not wait(handle, CHECK_INTERVAL):
                if fault := judge.check(process):
                    os.kill(process, signal.SIGKILL)
                    os.waitpid(process, 0)
                    raise fault
            code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    finally:
        os.close(handle)
    if code < 0:
        raise KeyboardInterrupt if requests else judge.explain_end(code)
    return code
