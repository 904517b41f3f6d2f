"""Finds and replaces NaN, infinity and numbers that are too large for half floats, band by band, without copies of
pictures."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import OpenImageIO as oiio

Array = np.ndarray
HALF_MAX = 65504.0
"""The largest finite half float (IEEE 754)."""
_INFINITE = 0x7C00
"""The exponent of half floats that are not finite."""
_SMALLER = np.float32(1.0 / 16.0)
"""With this factor, the sum of any 8 finite numbers stays finite."""
_BAND = 1 << 17
"""Numbers that are checked together. Chosen by judgement: they stay in the caches of a processor."""


def find_non_finite(array: Array) -> Array:
    """Where an array is NaN or infinite. Bits are compared, since numpy is slow on half floats."""
    if array.dtype == np.float16:
        return (array.view(np.uint16) & _INFINITE) == _INFINITE
    return ~np.isfinite(array)


def has_non_finite(array: Array) -> bool:
    """True if anything is NaN or infinite."""
    return any(find_non_finite(array[rows]).any() for rows in _row_slices(array))


def fill_non_finite(array: Array) -> Array:
    """Color [h, w, c] without NaN and infinity: each becomes the mean of its finite neighbors, or 0 without any.

    The sum of large neighbors may be infinite. Then its band of rows, which lies between two rows without repairs, is
    filled again with smaller numbers. Rows outside of it have no influence, so a band may be read alone.
    """
    filled = _average_neighbors(array)
    if not has_non_finite(filled):
        return filled
    most = np.float32(HALF_MAX if array.dtype == np.float16 else np.finfo(np.float32).max)
    is_broken = np.pad(find_non_finite(array).any(axis=(1, 2)), 1)
    starts, ends = (np.flatnonzero(edge) for edge in (is_broken[1:] & ~is_broken[:-1], is_broken[:-1] & ~is_broken[1:]))
    for start, end in zip(starts, ends, strict=True):
        if has_non_finite(filled[start:end]):
            rows = slice(max(start - 1, 0), end + 1)
            with np.errstate(over="ignore", invalid="ignore"):
                means = _average_neighbors(array[rows].astype(np.float32) * _SMALLER)
                means = np.clip(means / _SMALLER, -most, most).astype(array.dtype)
            filled[rows] = np.where(find_non_finite(array[rows]), means, array[rows])
    return filled


def _average_neighbors(array: Array) -> Array:
    """NaN and infinity as the mean of the finite ones among 8 neighbors (OpenImageIO, fixNonFinite BOX3)."""
    # one thread: a filled neighbor counts as finite, so the order decides the result
    filled = oiio.ImageBufAlgo.fixNonFinite(oiio.ImageBuf(array), oiio.NONFINITE_BOX3, nthreads=1)
    return np.array(filled.get_pixels("half" if array.dtype == np.float16 else "float"))


def to_half(array: Array) -> Array:
    """Half floats, rounded to nearest even. Numbers beyond their range are clamped, and NaN always has the same
    bits."""
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
