"""Processes that tests start: they hear signals, and end with their test.

A shell that runs a command in the background has it ignore interrupts, and children inherit that: a test that sends
one would wait for ever. So every process that runs tests hears the signals that a terminal sends.

A process that a test has left is ended, and the test fails. Those whose parent has ended too are found by an
environment variable, when the last test of a module is over, and when a worker has ended.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Generator
from contextlib import suppress
from pathlib import Path
from typing import Any
from uuid import uuid4

import pytest

MARK = "HALATION_TEST_WORKER"
"""The environment variable that children inherit from the worker that has started them."""

LASTING = ("halation.renderer.opengl.trial_worker", "multiprocessing.resource_tracker", "multiprocessing.spawn")
"""Processes that belong to a renderer or to Python, and that the system ends with the worker."""

_RUN = "HALATION_TEST_RUN"
_PROCESSES = Path("/proc")


def pytest_configure(config: pytest.Config) -> None:
    """Hear signals, and mark what this process starts."""
    worker = os.environ.get("PYTEST_XDIST_WORKER", "")
    runs_tests = bool(worker) or not getattr(config.option, "numprocesses", None)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) == signal.SIG_IGN and runs_tests:
            signal.signal(number, signal.default_int_handler if name == "SIGINT" else signal.SIG_DFL)
    if worker:
        os.environ[MARK] = f"{os.environ.get(_RUN, '')} {worker}"
    else:
        os.environ[_RUN] = uuid4().hex
        os.environ[MARK] = f"{os.environ[_RUN]} alone"


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> Generator[None, None, None]:
    """End what the test has left, and fail."""
    outcome = yield
    is_last = nextitem is None or nextitem.path != item.path
    left = set(list_children()) | (set(list_marked(os.environ[MARK])) if is_last else set[int]())
    names = [name for number in sorted(left) if (name := end_process(number))]
    if names:
        pytest.fail(f"{item.nodeid} has left processes, which were ended: {'; '.join(names)}", pytrace=False)
    return outcome


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: object) -> None:
    """End what a worker has left that has ended, or that was ended by a time limit."""
    for number in list_marked(f"{os.environ[_RUN]} {node.gateway.id}"):
        end_process(number)


def list_children() -> list[int]:
    """The processes that this one has started and that have not ended."""
    numbers: list[int] = []
    for path in _PROCESSES.glob("self/task/*/children"):
        with suppress(OSError):
            numbers += map(int, path.read_text().split())
    return numbers


def list_marked(mark: str) -> list[int]:
    """All processes that a worker, or a child of it, has started."""
    wanted = f"{MARK}={mark}".encode()
    numbers: list[int] = []
    for path in _PROCESSES.glob("[0-9]*/environ"):
        with suppress(OSError):
            if wanted in path.read_bytes().split(b"\0") and int(path.parent.name) != os.getpid():
                numbers.append(int(path.parent.name))
    return numbers


def end_process(number: int) -> str:
    """Kill a process, unless it lasts; its command, or "" where it was gone already."""
    command = ""
    with suppress(OSError):
        command = (_PROCESSES / str(number) / "cmdline").read_bytes().replace(b"\0", b" ").decode("utf-8", "replace")
    if not command or any(name in command for name in LASTING):
        return ""
    with suppress(OSError):
        os.kill(number, signal.SIGKILL if sys.platform != "win32" else signal.SIGTERM)
    with suppress(OSError):  # nobody else may wait for it
        os.waitpid(number, 0)
    return command.strip()
