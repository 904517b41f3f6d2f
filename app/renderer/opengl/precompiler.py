"""Compiles programs side by side on threads before they run, where the driver of a software rasterizer is without them.

Mesa's llvmpipe compiles a program on the thread that first runs it: nine tenths of the time of a first frame with an
empty cache. Programs cannot be handed from one context to another, but all contexts share the cache on disk, so what
a thread has compiled, the renderer loads from there. What is in the cache would only be loaded twice: `ProgramRecord`
tells.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from concurrent.futures import Future
from contextlib import suppress

from ...resources.machine import available_cores, count_busy_threads, has_memory_limit
from ..device import ProgramVariant
from .shader_cache import ProgramRecord
from .thread_context import ThreadContext, find_display

MAX_THREADS = 8
"""A compiler takes 30 to 60 MB of memory (llvmpipe, Mesa 22.3), and few graphs have more slow programs. A choice."""

CACHE_THREAD = "disk$0"
"""How the name of the thread ends on which Mesa writes its cache: another one reads a program when this one rests."""

CACHE_DELAY, MAX_CACHE_DELAY = 0.005, 1.0
"""Seconds between two looks at that thread, and after which nobody waits for it. On a busy machine it takes 0.1 s."""


class Precompiler:
    """Threads that compile programs for the context of one device, as long as there are any."""

    def __init__(self, driver: str) -> None:
        self._record = ProgramRecord.load(driver)
        self._display = find_display()
        self._waiting: list[tuple[ProgramVariant, Future[float]]] = []
        self._threads: list[threading.Thread] = []
        self._lock = threading.Lock()
        self._closed = False

    def begin(self, variants: Sequence[ProgramVariant]) -> dict[ProgramVariant, Future[float]]:
        """Begin to compile those that the driver does not have, large ones first; empty where that gains nothing.

        A future has the time from which on the program is in the cache, by `time.monotonic`.
        """
        if self._record.path is None or self._display is None:
            return {}
        unknown = [variant for variant in dict.fromkeys(variants) if variant.identity not in self._record]
        cores = 1 if has_memory_limit() else available_cores()
        if cores == 1 or len(unknown) < 2:  # the renderer compiles them itself
            self._record.add(variant.identity for variant in unknown)
            return {}
        futures = {variant: Future[float]() for variant in unknown}
        with self._lock:
            self._waiting += futures.items()
            self._waiting.sort(key=lambda job: len(job[0].source.split()))
            self._threads = [thread for thread in self._threads if thread.is_alive()]
            for _ in range(min(cores, MAX_THREADS, len(self._waiting)) - len(self._threads)):
                thread = threading.Thread(target=self._work, args=(self._display,), name="precompiler")
                self._threads.append(thread)
                thread.start()
        return futures

    def close(self) -> None:
        """Drop what waits, and wait for what is being compiled: no driver survives the end of its process meanwhile."""
        self._closed = True
        for thread in self._threads:
            thread.join()

    def _work(self, display: int) -> None:
        context: ThreadContext | None = None
        with suppress(OSError):
            context = ThreadContext(display)
        while job := self._take():
            variant, future = job
            if context is not None and not self._is_ending():
                context.compile(variant)
                self._wait_for_cache()
                self._record.add([variant.identity])
            future.set_result(time.monotonic())
        if context is not None:
            context.close()

    def _wait_for_cache(self) -> None:
        limit, looks_at_rest = time.monotonic() + MAX_CACHE_DELAY, 0
        while looks_at_rest < 2 and time.monotonic() < limit:
            time.sleep(CACHE_DELAY)
            looks_at_rest = 0 if count_busy_threads(CACHE_THREAD) else looks_at_rest + 1

    def _take(self) -> tuple[ProgramVariant, Future[float]] | None:
        with self._lock:
            return self._waiting.pop() if self._waiting else None

    def _is_ending(self) -> bool:
        return self._closed or not threading.main_thread().is_alive()
