"""Frames whose results are written while the next ones are computed: some may wait, in arrays that are used again."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, TypeVar

from ..execution.array_pool import ArrayPool
from ..execution.decoding import Array

MAX_WAITING = 2
"""Frames whose results may wait to be written."""

MAX_WAITING_BYTES = 2**28
"""What they may take together; one frame may be larger."""

WriteResult = TypeVar("WriteResult")


class WriteQueue(Generic[WriteResult]):
    """Writes on one other thread, in order. `arrays` lend what results come in."""

    def __init__(self) -> None:
        self.arrays = ArrayPool()
        self._writer = ThreadPoolExecutor(1, thread_name_prefix="write")
        self._writes: deque[tuple[Future[WriteResult], int]] = deque()

    def submit(self, write: Callable[[Mapping[str, Array]], WriteResult], outputs: Mapping[str, Array]) -> None:
        """Have `write` called with outputs that `arrays` lent, which go back to them."""

        def work() -> WriteResult:
            try:
                return write(outputs)
            finally:
                self.arrays.give(outputs.values())

        self._writes.append((self._writer.submit(work), sum(array.nbytes for array in outputs.values())))

    def collect_finished(self) -> Iterator[WriteResult]:
        """What was said of writes that are through, after waiting while too many are not. Raises what they raised."""
        while self._writes and (self._writes[0][0].done() or self._is_full()):
            yield self._writes.popleft()[0].result()

    def collect_all(self) -> Iterator[WriteResult]:
        """The same of all that are left."""
        while self._writes:
            yield self._writes.popleft()[0].result()

    def close(self) -> None:
        """Let what is being written come to its end, and forget the rest."""
        self._writer.shutdown(cancel_futures=True)

    def _is_full(self) -> bool:
        nbytes = sum(size for _, size in self._writes)
        return len(self._writes) > MAX_WAITING or (len(self._writes) > 1 and nbytes > MAX_WAITING_BYTES)
