"""Arrays as large as pictures, in pages of their own.

The allocator keeps much of what is freed for later, and two pictures that were decoded one after the other took four
times the memory of one. Pages of their own go back to the system with the array. Huge ones are a hundredth as many, and
the first touch of a page costs 2 microseconds: measured at 2560x1440, half a picture's copy.
"""

from __future__ import annotations

import mmap
import sys
from contextlib import suppress
from math import prod

import numpy as np

LARGE = 2**22
"""Bytes from which an array has its own pages. Chosen by judgement: two huge pages of 2 MiB."""


def create_array(shape: tuple[int, ...], dtype: np.dtype | type[np.generic]) -> np.ndarray:
    """An array with undefined numbers. Raises MemoryError."""
    kind = np.dtype(dtype)
    count = prod(shape)
    if sys.platform != "linux" or count * kind.itemsize < LARGE:
        return np.empty(shape, kind)
    try:
        pages = mmap.mmap(-1, count * kind.itemsize, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    except OSError as error:
        raise MemoryError(f"{count * kind.itemsize} bytes") from error
    with suppress(OSError):  # a kernel without huge pages
        pages.madvise(mmap.MADV_HUGEPAGE)
    return np.ndarray(shape, kind, pages)
