"""What the proofs of warps share: sampling a picture at positions that were computed in 64 bits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.ndimage import map_coordinates

Source = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Positions x and y (pixel centers at .5) to the positions in the image that are shown there."""


def sample_bilinear(picture: np.ndarray, x: np.ndarray, y: np.ndarray, mode: str) -> np.ndarray:
    """Bilinear, by scipy."""
    channels = np.moveaxis(picture.astype(np.float64), -1, 0)
    return np.stack([map_coordinates(c, [y - 0.5, x - 0.5], order=1, mode=mode) for c in channels], -1)


def warp_picture(picture: np.ndarray, source: Source, mode: str = "nearest") -> tuple[np.ndarray, np.ndarray]:
    """The picture through a warp, and where it is certain how finely each pixel was sampled.

    A pixel whose sides lie more than 1 apart in the image averages a grid, as fine as they lie apart.
    """
    height, width = picture.shape[:2]
    y, x = np.mgrid[:height, :width] + 0.5
    across, down = (
        np.hypot(*np.subtract(source(x + dx, y + dy), source(x - dx, y - dy))) for dx, dy in ((0.5, 0.0), (0.0, 0.5))
    )
    span = (np.maximum(across, down) - 0.01).clip(1, 8)
    count = np.ceil(span).astype(int)
    out = np.zeros(picture.shape)
    for n in np.unique(count):
        offsets = (np.arange(n) + 0.5) / n - 0.5
        samples = [sample_bilinear(picture, *source(x + dx, y + dy), mode) for dy in offsets for dx in offsets]
        out = np.where((count == n)[..., None], np.mean(samples, 0), out)
    return out, (np.abs(span - np.round(span)) > 1e-3) | (span == 1) | (span == 8)


def waves(width: int, height: int) -> np.ndarray:
    """A smooth picture, for round trips: opaque, between 0 and 1."""
    y, x = np.mgrid[:height, :width] / max(width, height)
    light = 0.5 + 0.25 * np.sin(9 * x + np.arange(3)[:, None, None]) + 0.25 * np.cos(7 * y)
    return np.concatenate([np.moveaxis(light, 0, -1), np.ones((height, width, 1))], -1).astype(np.float32)
