"""The watchdog: it ends a process whose graph has code that never ends.

The renderer writes to a file, the heartbeat, before and after it runs code of a graph. A device that is stuck blocks
the process that uses it, so another process has to read the file and kill the first one.
"""

from __future__ import annotations

import contextlib
import mmap
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import DeviceError, HalationError
from ..resources.heartbeat import BEACON_FILE, Watchdog, explain_memory_limit, name_end
from ..resources.program import module_command
from .outcome import flush_output, print_note, report_failure
from .signals import end_with_parent_thread, relay_requests
from .watched_copy import (
    CHECK_INTERVAL,
    begin_late_watchdog,
    count_threads,
    enter_copy,
    has_copies,
    make_heartbeat,
    wait_for_end,
    watch_copy,
)

if TYPE_CHECKING:
    from ..graph import Graph

DEVICE_MODULE = "halation.renderer.opengl.device"
"""Loaded where the process may have opened OpenGL, whose threads would be missing in a copy."""

_LINGERING = 0.25
"""Seconds for which the system may still list a thread that has ended: measured, more than 20 ms in one of a thousand
where twelve processes share four processors."""

Timeout = Annotated[
    float,
    typer.Option(
        "--timeout",
        min=0.0,
        metavar="SECONDS",
        help="The longest that one pass of a code node may take; 0 for no limit.",
    ),
]


class PoolWatchdog:
    """Watches processes that work side by side: each writes its heartbeat to a file in `folder`, named by its number.

    `timeout` is as in `Watchdog`.
    """

    def __init__(self, folder: Path, timeout: float) -> None:
        self.folder, self._timeout = folder, timeout
        self._watchdogs: dict[int, Watchdog] = {}

    def check(self) -> None:
        """Kill a process whose code runs too long or takes too much memory, and raise DeviceError."""
        for file in self.folder.iterdir():
            process = int(file.name)
            if process not in self._watchdogs:
                self._watchdogs[process] = Watchdog(file, self._timeout, tries_first=True)
            if fault := self._watchdogs[process].check(process):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
                raise fault


def needs_watchdog(graph: Graph) -> bool:
    """True if the graph has code nodes, also in groups, and no other process watches this one."""
    from ..graph.custom_code import has_code

    return not os.environ.get(BEACON_FILE) and has_code(graph)


def end_with_watchdog() -> None:
    """Have the system end this process with the one that watches it, if one does: nothing else ends a stuck device."""
    if os.environ.get(BEACON_FILE):
        end_with_parent_thread()


def can_fork() -> bool:
    """True if a copy of this process can go on in its place: nothing but its one thread works in it yet.

    A thread that has ended is listed for a moment longer.
    """
    if not has_copies() or DEVICE_MODULE in sys.modules:
        return False
    limit = time.monotonic() + _LINGERING
    while (count := count_threads()) > threading.active_count() and time.monotonic() < limit:
        time.sleep(_LINGERING / 1000)
    return count == 1


def run_session(work: Callable[[], int], timeout: float, as_json: bool) -> int:
    """Do work that renders many times in a copy of this process that this one watches, where there can be a copy."""
    if not _may_watch():
        return work()
    return run_forked(work, timeout, 0, as_json, tries_first=True)


def run_watched(
    work: Callable[[], int], graphs: Iterable[Graph], timeout: float, as_json: bool, *, memory: int = 0
) -> int:
    """Do work that renders these graphs once, and return its exit code.

    It is done in a copy of this process that this one watches, if they have code and there can be a copy.
    """
    if any(map(needs_watchdog, graphs)) and not begin_late_watchdog(timeout, memory) and can_fork():
        return run_forked(work, timeout, memory, as_json)
    return work()


def _may_watch() -> bool:
    """True if no process watches this one, and this one can watch a copy of itself."""
    return not os.environ.get(BEACON_FILE) and can_fork()


def run_service(work: Callable[[], int], timeout: float, as_json: bool) -> int:
    """As `run_session`, for work that serves clients without an end: after code that was stopped it begins again.

    The client whose code it was loses its connection, and so do those that are connected at that time.
    """
    if not _may_watch():
        return work()
    while True:
        try:
            return run_forked(work, timeout, 0, as_json, tries_first=True)
        except DeviceError as fault:
            print_note(f"{fault}; the server begins again")


def run_stream_service(work: Callable[[], int], timeout: float, as_json: bool) -> int:
    """As `run_service`, for work that answers requests on standard input: the one whose code was stopped gets an error.

    This process reads the requests, and hands them to its copy one at a time: the others are answered by the next copy.
    """
    if not _may_watch():
        return work()
    from ..serving.stream_relay import StreamRelay

    with contextlib.suppress(BrokenPipeError), os.fdopen(os.dup(1), "wb") as replies:
        relay = StreamRelay(0, replies)

        def work_behind_relay() -> int:
            relay.enter()
            return work()

        while True:
            try:
                with relay.open_pipes():
                    return run_forked(work_behind_relay, timeout, 0, as_json, tries_first=True, wait=relay.wait)
            except HalationError as fault:
                if not relay.fail_request(fault):
                    raise
                print_note(f"{fault}; the server begins again")
    return 0


def run_forked(
    work: Callable[[], int],
    timeout: float,
    memory: int,
    as_json: bool,
    *,
    tries_first: bool = False,
    wait: Callable[[int, float], bool] = wait_for_end,
) -> int:
    """Do the work in a copy of this process, report what it raises, and return its exit code; this one watches.

    A copy has loaded all that this one has, so it costs a few milliseconds instead of a start. `wait` may do more in
    the meantime than to wait. Raises DeviceError for code that takes too long, takes too much memory, or ends its
    process.
    """
    watchdog = Watchdog(make_heartbeat(), timeout, memory, tries_first)
    sys.stdout.flush()
    sys.stderr.flush()

    def do_watched_work() -> int:
        os.environ.update(watchdog.environment)
        enter_copy()
        return _finish(work, as_json)

    process, has_finished = _start_copy(do_watched_work)
    code = watch_copy(process, watchdog, wait)
    if not has_finished():
        raise watchdog.explain_end(code)
    return code


def _start_copy(work: Callable[[], int]) -> tuple[int, Callable[[], bool]]:
    """Copy this process. The copy does the work, which raises nothing, and ends with its exit code.

    Returns the number of the copy, and what says afterwards whether it has come to its own end: libraries end a process
    with exit codes too, as the loader does with 127, and OpenBLAS with 1, as a command that fails does.
    """
    mark = mmap.mmap(-1, 1)  # shared with the copy
    process = os.fork()
    if process == 0:
        code = work()
        mark[0] = True
        os._exit(code)
    return process, lambda: bool(mark[0])


def _finish(work: Callable[[], int], as_json: bool) -> int:
    """Do the last work of a process, and return the exit code. Nothing is raised."""
    try:
        code = work()
    except (Exception, KeyboardInterrupt) as fault:
        code = report_failure(fault, as_json)
    return flush_output(code)


def run_limited(work: Callable[[], int]) -> int:
    """Do all that a command does, under a limit of memory, in a copy of this process, and return the exit code.

    Drivers and libraries end the process where they are refused memory. Then this one remains to say so: it raises
    RenderError.
    """
    if not can_fork():
        return work()

    def do_limited_work() -> int:
        end_with_parent_thread()
        return work()

    process, has_finished = _start_copy(do_limited_work)
    with relay_requests(process) as requests:
        code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    if code < 0 and requests:
        raise KeyboardInterrupt
    if not has_finished():
        raise explain_memory_limit(name_end(code))
    return code


def rerun_watched(context: typer.Context, path: Path, graph: Graph, timeout: float) -> int | None:
    """Run the same command in a watched process if code of the graph could run for ever, and return its exit code.

    Returns None if there is no such code, or if this is the watched process: then the caller goes on. `context` holds
    the arguments of the command. A graph from standard input (`path` is "-") is passed on. Raises DeviceError when a
    pass takes longer than `timeout` seconds.
    """
    if not needs_watchdog(graph):
        end_with_watchdog()
        return None
    import tempfile

    from .. import document

    text = document.dumps(graph) if str(path) == "-" else ""
    command = [*module_command("halation.cli"), *context.obj]
    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        return _watch(command, Watchdog(Path(folder, "heartbeat"), timeout), text)


def _watch(command: list[str], watchdog: Watchdog, text: str) -> int:
    environment = {**os.environ, **watchdog.environment}
    with (
        subprocess.Popen(command, stdin=subprocess.PIPE if text else None, env=environment) as process,
        relay_requests(process.pid) as requests,
    ):
        if process.stdin:
            process.stdin.write(text.encode())
            process.stdin.close()
        while True:
            try:
                code = process.wait(CHECK_INTERVAL)
            except subprocess.TimeoutExpired:
                if fault := watchdog.check(process.pid):
                    process.kill()
                    raise fault from None
                continue
            if code < 0:
                raise KeyboardInterrupt if requests else watchdog.explain_end(code)
            return code
