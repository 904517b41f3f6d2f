"""Frames whose results are written while the next ones are computed: some may wait, in arrays that are used again."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, TypeVar

from ..execution.arrays import Arrays
from ..execution.decoding import Array

BEHIND = 2
"""Frames whose results may wait to be written."""

BEHIND_BYTES = 2**28
"""What they may take together; one frame may be larger."""

Said = TypeVar("Said")


class Behind(Generic[Said]):
    """Writes on one other thread, in order. `arrays` lend what results come in."""

    def __init__(self) -> None:
        self.arrays = Arrays()
        self._writer = ThreadPoolExecutor(1, thread_name_prefix="write")
        self._writes: deque[tuple[Future[Said], int]] = deque()

    def put(self, write: Callable[[Mapping[str, Array]], Said], outputs: Mapping[str, Array]) -> None:
        """Have `write` called with outputs that `arrays` lent, which go back to them."""

        def work() -> Said:
            try:
                return write(outputs)
            finally:
                self.arrays.give(outputs.values())

        self._writes.append((self._writer.submit(work), sum(array.nbytes for array in outputs.values())))

    def written(self) -> Iterator[Said]:
        """What was said of writes that are through, after waiting while too many are not. Raises what they raised."""
        while self._writes and (self._writes[0][0].done() or self._is_full()):
            yield self._writes.popleft()[0].result()

    def rest(self) -> Iterator[Said]:
        """The same of all that are left."""
        while self._writes:
            yield self._writes.popleft()[0].result()

    def close(self) -> None:
        """Let what is being written come to its end, and forget the rest."""
        self._writer.shutdown(cancel_futures=True)

    def _is_full(self) -> bool:
        nbytes = sum(size for _, size in self._writes)
        return len(self._writes) > BEHIND or (len(self._writes) > 1 and nbytes > BEHIND_BYTES)
