"""Reuses arrays, because the operating system takes longer to supply fresh memory than a download takes to fill it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable

import numpy as np

from .decoding import Array

MAX_SPARE_ARRAYS = 3
"""Unused arrays that are kept: the write queue holds two frames while a third one is downloaded. More would never be
used for a graph of one output, and fewer would make every frame allocate memory."""


ArrayMaker = Callable[[tuple[int, ...], type[np.floating]], Array]
"""Makes an array of a shape and type with undefined numbers."""


class ArrayPool:
    """Lends arrays, and lends them again after they were given back. Any thread may give them back.

    `create` makes new ones. Those that are lent once and never given back are best made by numpy, whose allocator finds
    memory of the last one.
    """

    def __init__(self, create: ArrayMaker = np.empty) -> None:
        self._create = create
        self._spare: deque[Array] = deque(maxlen=MAX_SPARE_ARRAYS)

    def take(self, shape: tuple[int, ...], dtype: type[np.floating]) -> Array:
        """An array of this shape with undefined numbers."""
        for _ in range(len(self._spare)):
            array = self._spare.popleft()
            if array.shape == shape and array.dtype == dtype:
                return array
            self._spare.append(array)
        return self._create(shape, dtype)

    def give(self, arrays: Iterable[Array]) -> None:
        """Give back arrays, or views of them, that nobody reads any more."""
        self._spare.extend(array.base if isinstance(array.base, np.ndarray) else array for array in arrays)
