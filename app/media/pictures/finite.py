"""Numbers that are none, and those too large for half floats: looked for band by band, without copies of pictures."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

Array = np.ndarray
HALF_MAX = 65504.0
_INFINITE = 0x7C00
"""The exponent of halves that are not finite."""
_BAND = 1 << 17
"""Numbers that are looked at together: they stay in the caches of a processor."""


def find_non_finite(array: Array) -> Array:
    """Where an array is NaN or infinite; bits are compared, since numpy is slow on halves."""
    if array.dtype == np.float16:
        return (array.view(np.uint16) & _INFINITE) == _INFINITE
    return ~np.isfinite(array)


def has_non_finite(array: Array) -> bool:
    """True if anything is NaN or infinite."""
    return any(find_non_finite(array[rows]).any() for rows in _row_slices(array))


def to_half(array: Array) -> Array:
    """Half floats, rounded to nearest even; what is beyond their range is clamped, and NaN is always the same NaN."""
    if array.dtype == np.float16 and not has_non_finite(array):
        return array
    halves = np.empty(array.shape, np.float16)
    for rows in _row_slices(array):
        np.clip(array[rows], -HALF_MAX, HALF_MAX, out=halves[rows], casting="same_kind")
        if np.isnan(array[rows]).any():
            halves[rows][np.isnan(array[rows])] = np.nan
    return halves


def _row_slices(array: Array) -> Iterator[slice]:
    step = max(1, _BAND * len(array) // max(1, array.size))
    return (slice(row, row + step) for row in range(0, len(array), step))
