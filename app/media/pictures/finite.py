"""Numbers that are none, and those too large for half floats: looked for band by band, without copies of pictures."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import OpenImageIO as oiio

Array = np.ndarray
HALF_MAX = 65504.0
_INFINITE = 0x7C00
"""The exponent of halves that are not finite."""
_SMALLER = np.float32(1.0 / 16.0)
"""The sum of 8 numbers of any size, made smaller by this, is finite."""
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


def fill_non_finite(array: Array) -> Array:
    """Color [h, w, c] without NaN and infinity: each takes the mean of its finite neighbors, 0 if nothing is finite.

    OpenImageIO goes through the picture from the top left, and what it has filled counts as finite. Two kinds of pixel
    are left: those with nothing finite before them, and those whose neighbors are so large that their sum is infinite.
    Going back from the bottom right, with smaller numbers, fills them.
    """
    filled = _average_neighbors(array)
    if not has_non_finite(filled):
        return filled
    backwards = _average_neighbors(np.ascontiguousarray(filled[::-1, ::-1], np.float32) * _SMALLER)[::-1, ::-1]
    most = np.float32(HALF_MAX if array.dtype == np.float16 else np.finfo(np.float32).max)
    with np.errstate(over="ignore"):
        means = np.nan_to_num(backwards / _SMALLER, nan=0.0, posinf=most, neginf=-most)
    if not np.isfinite(backwards).any():
        means = np.zeros_like(means)
    return np.where(find_non_finite(filled), np.clip(means, -most, most).astype(array.dtype), filled)


def _average_neighbors(array: Array) -> Array:
    """What is not finite as the mean of the finite ones among 8 neighbors (OpenImageIO, fixNonFinite BOX3)."""
    # one thread: a filled neighbor counts as finite, so the order decides the result
    filled = oiio.ImageBufAlgo.fixNonFinite(oiio.ImageBuf(array), oiio.NONFINITE_BOX3, nthreads=1)
    return np.asarray(filled.get_pixels("half" if array.dtype == np.float16 else "float"))


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
