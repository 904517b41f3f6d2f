"""Signals that interrupt this process: the key of a terminal, and requests to end."""

from __future__ import annotations

import signal
from collections.abc import Generator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType

END_REQUESTS = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals of this system with which others ask a process to end."""


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

    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, *END_REQUESTS)}
    try:
        for number, handler in handlers.items():
            if callable(handler):
                signal.signal(number, delay)
        yield
    finally:
        for number, handler in handlers.items():
            if callable(handler):
                signal.signal(number, handler)
        for number, frame in delayed:
            if callable(handler := handlers[signal.Signals(number)]):
                handler(number, frame)
