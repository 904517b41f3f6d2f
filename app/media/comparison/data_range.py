"""Finds the range in which data is shown. Thumbnails and viewer use the same."""

from __future__ import annotations

import numpy as np

Array = np.ndarray

FAR = 1e8
"""Depths from here on are background: renderers write 1e10 (Blender), 1e30 or infinity there."""

HALF_MAX = 65504.0
"""The number that infinity becomes in files and nodes: the largest half float."""

_OUTLIERS = (0.5, 99.5)
"""Percentiles between which data is shown: a half percent of pixels on each side may be far off. Chosen by eye."""

_ZERO_LENGTH = 1e-4
"""A vector below this is the zero of a background: half floats above it are off by 0.05 % at most."""

_UNIT_LENGTH, _UNIT_SHARE = 0.05, 0.95
"""Vectors are normals if this share of them has a length within so much of 1: averages at edges are shorter, and
normals of 8 bits are off by up to 0.007. Chosen by judgement."""


def find_data_range(pixels: Array) -> tuple[float, float]:
    """The range in which data [h, w, channels] is shown: without outliers, and without numbers that mean infinity."""
    finite = pixels[np.isfinite(pixels)]
    near = finite[(np.abs(finite) < FAR) & (np.abs(finite) != HALF_MAX)]
    finite = near if near.size else finite
    if not finite.size:
        return 0.0, 1.0
    low, high = (float(part) for part in np.percentile(finite, _OUTLIERS))
    if high <= low:
        low, high = float(finite.min()), float(finite.max())
    if high <= low:
        return (low, low + 1.0) if not 0.0 <= low <= 1.0 else (0.0, 1.0)  # a solid matte is as bright as its number
    return low, high


def balance_range(low: float, high: float) -> tuple[float, float]:
    """The same range with zero in its middle, if both signs occur: directions, motion."""
    reach = max(abs(low), abs(high))
    return (-reach, reach) if low < 0.0 < high else (low, high)


def are_normals(pixels: Array) -> bool:
    """True if vectors [h, w, 3 or 4] have unit length wherever they are not zero."""
    if pixels.shape[2] < 3:
        return False
    length = np.linalg.norm(pixels[..., :3].reshape(-1, 3).astype(np.float64), axis=1)
    there = length[np.isfinite(length) & (length > _ZERO_LENGTH)]
    return bool(there.size) and float((np.abs(there - 1.0) < _UNIT_LENGTH).mean()) > _UNIT_SHARE
