"""Numbers that are none, and what else must not spread."""

from __future__ import annotations

import numpy as np

from .pixels import Array, join


def sanitize(image: Array, repair: str, negative: str, maximum: float, limit_alpha: bool) -> Array:
    """Replace NaN and infinity by the mean of the finite values around, and limit the rest."""
    broken = ~np.isfinite(image)
    if repair == "neighbors":
        height, width = image.shape[:2]
        padded = np.pad(np.where(broken, 0.0, image), ((1, 1), (1, 1), (0, 0)))
        count = np.pad(np.where(broken, 0.0, 1.0), ((1, 1), (1, 1), (0, 0)))
        around = [np.s_[y : y + height, x : x + width] for y in range(3) for x in range(3)]
        total, whole = sum(padded[part] for part in around), sum(count[part] for part in around)
        image = np.where(broken, total / np.maximum(whole, 1.0), image)
    else:
        image = np.where(broken, 0.0, image)
    color = {
        "clip": np.maximum(image[..., :3], 0.0),
        "mirror": np.abs(image[..., :3]),
        "keep": image[..., :3],
    }[negative]
    alpha = np.clip(image[..., 3:], 0.0, 1.0 if limit_alpha else maximum)
    return join(np.clip(color, -maximum, maximum), alpha)
