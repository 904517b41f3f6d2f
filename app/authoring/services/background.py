"""Things that take time to make, made in a thread and kept."""

from __future__ import annotations

import sys
from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Condition, Thread
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class Background(Generic[K, V]):
    """What was asked for last is made first; of what is made, the `kept` used last stay.

    `make` must not raise. At most `waiting` requests wait, the oldest are forgotten. `begin` runs in the thread first.
    """

    def __init__(
        self,
        name: str,
        make: Callable[[K], V],
        kept: int,
        waiting: int = sys.maxsize,
        begin: Callable[[], object] = lambda: None,
    ) -> None:
        self._name, self._make, self._begin = name, make, begin
        self._most, self._most_waiting = kept, waiting
        self._known: OrderedDict[K, V] = OrderedDict()
        self._wanted: OrderedDict[K, None] = OrderedDict()
        self._changed = Condition()
        self._thread: Thread | None = None
        self._closed = False

    def get(self, key: K) -> V | None:
        """What was made of `key`; None if it is not ready: ask again."""
        with self._changed:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key]
            self._wanted[key] = None
            self._wanted.move_to_end(key)
            while len(self._wanted) > self._most_waiting:
                self._wanted.popitem(last=False)
            self._changed.notify()
        if self._thread is None:
            self._thread = Thread(target=self._work, name=self._name, daemon=True)
            self._thread.start()
        return None

    @property
    def busy(self) -> bool:
        """True while something that was asked for is not ready."""
        return bool(self._wanted)

    def forget(self) -> None:
        """Nothing that was asked for is wanted any more."""
        with self._changed:
            self._wanted.clear()

    def close(self) -> None:
        """End the thread."""
        with self._changed:
            self._closed = True
            self._wanted.clear()
            self._changed.notify()
        if self._thread is not None:
            self._thread.join()

    def _work(self) -> None:
        self._begin()
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._wanted or self._closed)
                if self._closed:
                    return
                key = next(reversed(self._wanted))
            made = self._make(key)
            with self._changed:
                self._known[key] = made
                self._wanted.pop(key, None)
                while len(self._known) > self._most:
                    self._known.popitem(last=False)
