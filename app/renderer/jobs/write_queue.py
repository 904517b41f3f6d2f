"""Writes the results of frames on other threads, while the next frames are rendered."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, TypeVar

from ...resources.interrupts import delay_interrupts
from ..execution.decoding import Array

MAX_WAITING = 1
"""Frames whose results may wait besides those that are being written, which evens out frames that take longer. A
longer queue only takes memory: if writing is the slower stage on average, any queue fills up."""

MAX_WAITING_BYTES = 2**28
"""Bytes that waiting frames may take together; one frame may be larger. As many as pictures that are decoded ahead."""

WriteResult = TypeVar("WriteResult")


class WriteQueue(Generic[WriteResult]):
    """Writes frames on `writers` other threads; a single one writes them in order."""

    def __init__(self, writers: int = 1) -> None:
        self._most = writers + MAX_WAITING
        self._writer = ThreadPoolExecutor(writers, thread_name_prefix="write")
        self._writes: deque[tuple[Future[WriteResult], int]] = deque()

    def submit(self, write: Callable[[Mapping[str, Array]], WriteResult], outputs: dict[str, Array]) -> None:
        """Call `write` with these outputs on another thread. They are empty afterwards: the next frame needs the memory
        as soon as this one is known to be written.
        """
        nbytes = sum(array.nbytes for array in outputs.values())

        def work() -> WriteResult:
            try:
                return write(outputs)
            finally:
                outputs.clear()

        # An interrupt while the thread is started would leave one that nobody waits for.
        with delay_interrupts():
            self._writes.append((self._writer.submit(work), nbytes))

    def collect_finished(self) -> Iterator[WriteResult]:
        """The results of finished writes; waits while too many are unfinished. Raises what they raised."""
        while self._writes and (self._writes[0][0].done() or self._is_full()):
            yield self._writes.popleft()[0].result()

    def collect_all(self) -> Iterator[WriteResult]:
        """The results of all remaining writes."""
        while self._writes:
            yield self._writes.popleft()[0].result()

    def close(self) -> None:
        """Finish the frame that is being written, and forget the others."""
        self._writer.shutdown(cancel_futures=True)

    def _is_full(self) -> bool:
        nbytes = sum(size for _, size in self._writes)
        return len(self._writes) > self._most or (len(self._writes) > 1 and nbytes > MAX_WAITING_BYTES)
