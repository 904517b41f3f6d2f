"""Arrays that are used again: touching fresh memory for the first time takes longer than filling it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import numpy as np

from .decoding import Array

MAX_SPARE_ARRAYS = 3
"""Arrays that wait to be used again: one is filled while two are written."""


class ArrayPool:
    """Lends arrays, and lends them again once they were given back. Any thread may give."""

    def __init__(self) -> None:
        self._spare: deque[Array] = deque(maxlen=MAX_SPARE_ARRAYS)

    def take(self, shape: tuple[int, ...], dtype: type[np.floating]) -> Array:
        """An array of any numbers."""
        for _ in range(len(self._spare)):
            array = self._spare.popleft()
            if array.shape == shape and array.dtype == dtype:
                return array
            self._spare.append(array)
        return np.empty(shape, dtype)

    def give(self, arrays: Iterable[Array]) -> None:
        """Arrays that were taken, or parts of them, which nobody reads any more."""
        self._spare.extend(array if array.base is None else array.base for array in arrays)
