"""Signals that ask a process to end: each ends a command as Ctrl-C does, so that no unfinished file is left."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import ExtensionFileLoader
from types import FrameType

from ..resources.interrupts import END_REQUESTS, redirect_interrupts

_PARENT_INTERVAL = 0.5
"""Seconds between two looks at the parent: a choice, shorter than most frames take."""

_LOADING_INTERVAL = 0.02
"""Seconds until an interrupt is tried again while an extension module is loaded: a choice, shorter than a user sees."""

_PATIENCE = 10.0
"""Seconds that a process without a parent may take to remove what it has begun to write: a choice."""


def raise_on_requests() -> None:
    """Raise KeyboardInterrupt when a signal asks this process to end. Signals that are ignored stay so (`nohup`)."""
    for number in (signal.SIGINT, *END_REQUESTS):
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _interrupt)


def _interrupt(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, but a moment later where it would end the process without a word.

    Extension modules call Python while they are loaded, and most are C++ that aborts at an exception there.
    """
    if not _is_loading_extension(frame):
        raise KeyboardInterrupt
    timer = threading.Timer(_LOADING_INTERVAL, _signal_main_thread, (number,))
    timer.daemon = True
    timer.start()


def _signal_main_thread(number: int) -> None:
    """Send a signal to the main thread, so that a call which waits there ends."""
    main = threading.main_thread().ident
    if main is not None and hasattr(signal, "pthread_kill"):
        signal.pthread_kill(main, number)
    else:
        signal.raise_signal(number)


def _is_loading_extension(frame: FrameType | None) -> bool:
    while frame is not None:
        is_loading = frame.f_code.co_name in ("create_module", "exec_module")
        if is_loading and isinstance(frame.f_locals.get("self"), ExtensionFileLoader):
            return True
        frame = frame.f_back
    return False


@contextmanager
def relay_requests(process: int, *, is_copy: bool = False) -> Iterator[list[int]]:
    """Pass signals that ask this process to end on to another process; yields the list of those received so far.

    An interrupt is not passed on, because a terminal sends it to both processes. A copy of this process ignores those
    (`ignore_interrupts`), and is asked to end instead: an interrupt may also come from a program, to this one alone.
    """
    received: list[int] = []

    def relay(number: int, _: object) -> None:
        received.append(number)
        if number != signal.SIGINT or is_copy:
            with contextlib.suppress(OSError):
                os.kill(process, signal.SIGTERM if number == signal.SIGINT else number)

    with redirect_interrupts(relay):
        yield received


def ignore_interrupts() -> None:
    """Leave interrupts from a terminal to the process that this one is a copy of: it passes them on."""
    if callable(signal.getsignal(signal.SIGTERM)):
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def end_with_parent_thread() -> None:
    """Have the system end this process with the thread that has started it, even while a driver is stuck."""
    if sys.platform == "linux":
        import ctypes

        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, signal.SIGKILL)


def end_with_parent() -> None:
    """End this process when the one that has started it is gone, whichever thread that was."""
    parent = os.getppid()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_PARENT_INTERVAL)
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(_PATIENCE)
        os.kill(os.getpid(), signal.SIGKILL)

    if sys.platform != "win32":
        threading.Thread(target=watch, name="parent", daemon=True).start()
