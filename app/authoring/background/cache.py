"""A cache whose entries are computed in a thread."""

from __future__ import annotations

import sys
from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Condition, Thread
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class BackgroundCache(Generic[K, V]):
    """Entries computed in a thread, the last requested first; the `kept` most recently used ones stay.

    `make` must not raise. At most `waiting` requests wait, the oldest are forgotten. `begin` runs in the thread first.
    """

    def __init__(
        self,
        name: str,
        make: Callable[[K], V],
        capacity: int,
        max_waiting: int = sys.maxsize,
        begin: Callable[[], object] = lambda: None,
    ) -> None:
        self._name, self._make, self._begin = name, make, begin
        self._capacity, self._max_waiting = capacity, max_waiting
        self._finished: OrderedDict[K, V] = OrderedDict()
        self._requested: OrderedDict[K, None] = OrderedDict()
        self._changed = Condition()
        self._thread: Thread | None = None
        self._closed = False

    def get(self, key: K) -> V | None:
        """The entry of `key`; None if it is not ready yet: ask again later."""
        with self._changed:
            if key in self._finished:
                self._finished.move_to_end(key)
                return self._finished[key]
            self._requested[key] = None
            self._requested.move_to_end(key)
            while len(self._requested) > self._max_waiting:
                self._requested.popitem(last=False)
            self._changed.notify()
        if self._thread is None:
            self._thread = Thread(target=self._work, name=self._name, daemon=True)
            self._thread.start()
        return None

    @property
    def is_busy(self) -> bool:
        """True while a requested entry is not ready."""
        return bool(self._requested)

    def forget(self) -> None:
        """Drop all waiting requests."""
        with self._changed:
            self._requested.clear()

    def close(self) -> None:
        """End the thread."""
        with self._changed:
            self._closed = True
            self._requested.clear()
            self._changed.notify()
        if self._thread is not None:
            self._thread.join()

    def _work(self) -> None:
        self._begin()
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._requested or self._closed)
                if self._closed:
                    return
                key = next(reversed(self._requested))
            product = self._make(key)
            with self._changed:
                self._finished[key] = product
                self._requested.pop(key, None)
                while len(self._finished) > self._capacity:
                    self._finished.popitem(last=False)
