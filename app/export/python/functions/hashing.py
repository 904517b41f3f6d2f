"""Random numbers for cells of a lattice, the same on every machine."""

from __future__ import annotations

import numpy as np

from .pixels import Array


def pcg3d(cells: Array) -> Array:
    """The hash pcg3d (Jarzynski and Olano 2020) of three integers [..., 3], as 32 bits each."""
    v = np.atleast_2d(cells).astype(np.int64).astype(np.uint32) * np.uint32(1664525) + np.uint32(1013904223)
    x, y, z = stir(v[..., 0], v[..., 1], v[..., 2])
    return np.stack(stir(x ^ (x >> 16), y ^ (y >> 16), z ^ (z >> 16)), axis=-1)


def stir(x: Array, y: Array, z: Array) -> tuple[Array, Array, Array]:
    """Half of the hash: each of three integers depends on both others."""
    x = x + y * z
    y = y + z * x
    return x, y, z + x * y


def stream_of(*numbers: int) -> Array:
    """The seed of a stream of random numbers."""
    return pcg3d(np.array(numbers))[0]


def cell_bits(cells: Array, stream: Array) -> Array:
    """The hash of cells [..., 3] in a stream."""
    return pcg3d(cells.astype(np.int64) + np.asarray(stream).astype(np.int64))


def unit(bits: Array) -> Array:
    """Numbers in 0 <= u < 1 with 24 bits."""
    return (bits >> 8) / 16777216.0


def hash3(cells: Array, stream: Array) -> Array:
    """Three independent uniform random numbers for each cell."""
    return unit(cell_bits(cells, stream))


def normal3(cells: Array, stream: Array) -> Array:
    """Three independent normally distributed numbers for each cell (Box and Muller 1958)."""
    bits = cell_bits(cells, stream)
    return np.sqrt(-2.0 * np.log(1.0 - unit(bits))) * np.cos(2.0 * np.pi * unit(pcg3d(bits)))
