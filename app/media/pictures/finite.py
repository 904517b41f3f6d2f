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


def not_finite(array: Array) -> Array:
    """Where an array is NaN or infinite; bits are compared, since numpy is slow on halves."""
    if array.dtype == np.float16:
        return (array.view(np.uint16) & _INFINITE) == _INFINITE
    return ~np.isfinite(array)


def has_bad(array: Array) -> bool:
    """True if anything is NaN or infinite."""
    return any(not_finite(array[rows]).any() for rows in _bands(array))


def as_half(array: Array) -> Array:
    """Half floats, rounded to nearest even; what is beyond their range is clamped, and NaN is always the same NaN."""
    if array.dtype == np.float16 and not has_bad(array):
        return array
    made = np.empty(array.shape, np.float16)
    for rows in _bands(array):
        np.clip(array[rows], -HALF_MAX, HALF_MAX, out=made[rows], casting="same_kind")
        if np.isnan(array[rows]).any():
            made[rows][np.isnan(array[rows])] = np.nan
    return made


def _bands(array: Array) -> Iterator[slice]:
    step = max(1, _BAND * len(array) // max(1, array.size))
    return (slice(row, row + step) for row in range(0, len(array), step))
