"""The threads that the Python interface renders on.

OpenGL draws on the thread that opened it. So the main thread renders by itself, and all other threads share one that
serves them in turn. A renderer for each thread would open a context for each, which takes longer than most graphs, and
threads of a pool come and go.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, cached_property
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from ..errors import UsageError

if TYPE_CHECKING:
    from ..graph import Graph
    from ..renderer.execution.trials import TrialProcess

P = ParamSpec("P")
R = TypeVar("R")


class DrawingThread:
    """A thread that draws, and the process in which it tries the code of users."""

    def __init__(self, ident: int) -> None:
        self.ident = ident

    @cached_property
    def trial_process(self) -> TrialProcess:
        """Where programs with code of users are tried."""
        from ..renderer.execution.trials import TrialProcess

        return TrialProcess()

    def prepare(self, graph: Graph) -> None:
        """Start the process that tries programs if the graph has code of users: that takes a moment."""
        from ..graph.custom_code import has_code

        if has_code(graph):
            self.trial_process.start()

    def call(self, function: Callable[P, R], *args: P.args, **options: P.kwargs) -> R:
        """Call a function on this thread. Raises UsageError where that cannot be."""
        if threading.get_ident() != self.ident:
            raise UsageError("the first of these frames was rendered on the main thread: render the others there too")
        return function(*args, **options)


class SharedThread(DrawingThread):
    """A thread that draws for others."""

    def __init__(self) -> None:
        self._executor = ThreadPoolExecutor(1, thread_name_prefix="render")
        super().__init__(self._executor.submit(threading.get_ident).result())

    def call(self, function: Callable[P, R], *args: P.args, **options: P.kwargs) -> R:
        """Call a function on this thread and wait for what it returns or raises."""
        if threading.get_ident() == self.ident:  # a function of the user that is called there, and renders too
            return function(*args, **options)
        return self._executor.submit(function, *args, **options).result()


def choose_thread() -> DrawingThread:
    """The thread that draws for the one that asks."""
    is_main = threading.current_thread() is threading.main_thread()
    return _main_thread(threading.get_ident()) if is_main else _get_thread(os.getpid())


@cache
def _main_thread(ident: int) -> DrawingThread:
    return DrawingThread(ident)


@cache
def _get_thread(process: int) -> SharedThread:
    """The thread of a process: one that was forked needs another one."""
    return SharedThread()
