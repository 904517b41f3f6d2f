"""pcg3d in numpy, from the paper: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering"."""

from __future__ import annotations

import numpy as np


def hash3(cell: tuple[object, object, object], seed: tuple[int, int, int] = (0, 0, 0)) -> np.ndarray:
    """Three uniform numbers for lattice cells, along a new first axis."""
    with np.errstate(over="ignore"):
        x, y, z = (
            np.asarray(part, np.int64).astype(np.uint32) + np.uint32(start)
            for part, start in zip(np.broadcast_arrays(*cell), seed, strict=True)
        )
        x, y, z = (part * np.uint32(1664525) + np.uint32(1013904223) for part in (x, y, z))
        x = x + y * z
        y = y + z * x
        z = z + x * y
        x, y, z = (part ^ (part >> np.uint32(16)) for part in (x, y, z))
        x = x + y * z
        y = y + z * x
        z = z + x * y
    return np.stack([x >> np.uint32(8), y >> np.uint32(8), z >> np.uint32(8)]) / 2.0**24
