"""Signals that interrupt this process: the key of a terminal, and requests to end."""

from __future__ import annotations

import signal
from collections.abc import Callable, Generator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType

END_REQUESTS = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals of this system with which others ask a process to end."""


@contextmanager
def redirect_interrupts(handle: Callable[[int, FrameType | None], object]) -> Generator[None]:
    """Inside, `handle` is called for each signal that interrupts this process. Signals that are ignored stay so.

    A shell starts commands in the background so. Only the main thread may do this.
    """
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, *END_REQUESTS)}
    before = {number: handler for number, handler in handlers.items() if callable(handler)}
    try:
        for number in before:
            signal.signal(number, handle)
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def delay_interrupts() -> Generator[None]:
    """Handle signals that arrive during the block when it ends, so that it is done whole or not at all.

    Python handles signals on its main thread and between two of its instructions, most often right after a call that
    took long: what that call has made would be lost. Other threads are never interrupted. Keep the block short.
    """
    if current_thread() is not main_thread():
        yield
        return
    delayed: list[tuple[int, FrameType | None]] = []

    def delay(number: int, frame: FrameType | None) -> None:
        delayed.append((number, frame))

    try:
        with redirect_interrupts(delay):
            yield
    finally:
        for number, frame in delayed:
            if callable(handler := signal.getsignal(number)):
                handler(number, frame)
