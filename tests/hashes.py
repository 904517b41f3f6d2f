"""pcg3d in numpy, from the paper: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering"."""

from __future__ import annotations

import numpy as np


def pcg3d(v: np.ndarray) -> np.ndarray:
    """Hashed uint32 [..., 3] of uint32 [..., 3]."""
    with np.errstate(over="ignore"):
        v = v.astype(np.uint32) * np.uint32(1664525) + np.uint32(1013904223)
        x, y, z = stir(v[..., 0], v[..., 1], v[..., 2])
        return np.stack(stir(*(part ^ (part >> np.uint32(16)) for part in (x, y, z))), -1)


def stir(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Half of the hash. As a loop in `pcg3d` it takes pyright ten seconds, which tries all kinds of numbers."""
    x = x + y * z
    y = y + z * x
    return x, y, z + x * y


def hash3(cell: tuple[object, object, object], seed: tuple[int, int, int] = (0, 0, 0)) -> np.ndarray:
    """Three uniform numbers for lattice cells, along a new first axis."""
    parts = np.stack(np.broadcast_arrays(*(np.asarray(part, np.int64) for part in cell)), -1)
    with np.errstate(over="ignore"):
        hashed = pcg3d(parts.astype(np.uint32) + np.array(seed, np.int64).astype(np.uint32))
    return np.moveaxis(hashed >> np.uint32(8), -1, 0) / 2.0**24


def normal3(cell: tuple[object, object, object], seed: tuple[int, int, int] = (0, 0, 0)) -> np.ndarray:
    """Three normal numbers for lattice cells, along a new first axis (Box and Muller 1958)."""
    parts = np.stack(np.broadcast_arrays(*(np.asarray(part, np.int64) for part in cell)), -1)
    with np.errstate(over="ignore"):
        bits = pcg3d(parts.astype(np.uint32) + np.array(seed, np.int64).astype(np.uint32))
    first, second = ((hashed >> np.uint32(8)) / 2.0**24 for hashed in (bits, pcg3d(bits)))
    return np.moveaxis(np.sqrt(-2 * np.log1p(-first)) * np.cos(2 * np.pi * second), -1, 0)
