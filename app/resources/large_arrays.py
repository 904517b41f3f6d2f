"""Arrays as large as pictures, in pages of their own.

The allocator keeps much of what is freed for later, and two pictures that were decoded one after the other took four
times the memory of one. Pages of their own go back to the system with the array. Huge ones are a hundredth as many, and
the first touch of a page costs 2 microseconds: measured at 2560x1440, half a picture's copy.

Work that makes arrays of the same sizes again and again, as the frames of a sequence, has their pages kept
(`reuse_pages`): the system clears all that it gives out, which takes 6 ms of a frame of 1280x720.
"""

from __future__ import annotations

import mmap
import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from math import prod
from threading import RLock
from typing import Any
from weakref import finalize

import numpy as np

LARGE = 2**22
"""Bytes from which an array has its own pages. Chosen by judgement: two huge pages of 2 MiB."""

MAX_SPARE = 4
"""Pages of so many arrays are kept for others: of a sequence, three frames that are written or downloaded, and one that
is decoded. More would hardly be used, and take memory."""

MAX_SPARE_BYTES = 2**28
"""Bytes of all of these together: as many as frames take that wait to be written."""

ArrayMaker = Callable[[tuple[int, ...], type[np.floating[Any]]], np.ndarray]
"""Makes an array of a shape and type with undefined numbers."""


class _SparePages:
    """Pages that no array has, while somebody has them kept. Any thread may take and give."""

    def __init__(self) -> None:
        self.users = 0
        self._pages: list[mmap.mmap] = []
        self._lock = RLock()  # an array that dies while it is held gives its pages

    def take(self, nbytes: int) -> mmap.mmap | None:
        with self._lock:
            place = next((place for place, pages in enumerate(self._pages) if len(pages) == nbytes), None)
            return None if place is None else self._pages.pop(place)

    def give(self, pages: mmap.mmap) -> None:
        with self._lock:
            if self.users and len(pages) <= MAX_SPARE_BYTES:
                self._pages.append(pages)
                while len(self._pages) > MAX_SPARE or sum(map(len, self._pages)) > MAX_SPARE_BYTES:
                    del self._pages[0]

    def add_users(self, change: int) -> None:
        """There are more or fewer who want pages to be kept. Without any, none are."""
        with self._lock:
            self.users += change
            if not self.users:
                self._pages.clear()


_SPARE = _SparePages()
"""The pages of this process."""


def create_array(shape: tuple[int, ...], dtype: np.dtype[Any] | type[np.generic]) -> np.ndarray:
    """An array with undefined numbers. Raises MemoryError."""
    kind = np.dtype(dtype)
    nbytes = prod(shape) * kind.itemsize
    if nbytes < LARGE or not (sys.platform == "linux" or _SPARE.users):
        return np.empty(shape, kind)
    pages = _SPARE.take(nbytes) or _create_pages(nbytes)
    array = np.ndarray(shape, kind, pages)
    if _SPARE.users:
        finalize(array, _SPARE.give, pages).atexit = False  # views of the array keep it alive
    return array


@contextmanager
def reuse_pages() -> Generator[None]:
    """Keep pages of arrays that nothing refers to any more for the next ones of their size, until this ends."""
    _SPARE.add_users(1)
    try:
        yield
    finally:
        _SPARE.add_users(-1)


def _create_pages(nbytes: int) -> mmap.mmap:
    """Memory that is no array: views would refer to that, and not to the array that lends it."""
    try:
        if sys.platform != "linux":
            return mmap.mmap(-1, nbytes)
        pages = mmap.mmap(-1, nbytes, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    except OSError as error:
        raise MemoryError(f"{nbytes} bytes") from error
    with suppress(OSError):  # a kernel without huge pages
        pages.madvise(mmap.MADV_HUGEPAGE)
    return pages
