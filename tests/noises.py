"""Lattice noises in 64 bits, from the papers: Perlin 2001 and 2002, Gustavson 2005, on top of pcg3d."""

from __future__ import annotations

import numpy as np
from hashes import pcg3d

PERLIN = np.array(
    [
        (1, 1, 0),
        (-1, 1, 0),
        (1, -1, 0),
        (-1, -1, 0),
        (1, 0, 1),
        (-1, 0, 1),
        (1, 0, -1),
        (-1, 0, -1),
        (0, 1, 1),
        (0, -1, 1),
        (0, 1, -1),
        (0, -1, -1),
        (1, 1, 0),
        (0, -1, 1),
        (-1, 1, 0),
        (0, -1, -1),
    ],
    np.float64,
)
"""The sixteen cases of Perlin's reference implementation (2002): x, y and z of each edge."""

DENSITY = 0.5
"""How many tetrahedra of simplex noise go along the side of a cell."""


def stream(*parts: int) -> np.ndarray:
    """The hash that tells layers apart."""
    return pcg3d(np.array([*parts, 0, 0][:3], np.int64).astype(np.uint32))


def places(width: int, height: int, size: float, z: float) -> np.ndarray:
    """Pixel centers in units of the noise: [h, w, 3]."""
    y, x = (np.mgrid[:height, :width] + 0.5) / size
    return np.stack([x, y, np.full_like(x, z)], -1)


def lattice(cell: np.ndarray, seed: np.ndarray) -> np.ndarray:
    """The hashed bits of integer cells [..., 3]."""
    return pcg3d(cell.astype(np.int64).astype(np.uint32) + seed)


def unit(bits: np.ndarray) -> np.ndarray:
    """24 bits of 32 as 0..1."""
    return (bits >> np.uint32(8)) * 2.0**-24


def edges(bits: np.ndarray, away: np.ndarray) -> np.ndarray:
    """Three dot products of a way [..., 3] with the edges that hashed bits [..., 3] pick."""
    return np.einsum("...cj,...j->...c", PERLIN[bits >> np.uint32(28)], away)


ENDLESS = (np.inf, np.inf, np.inf)
"""The periods of a noise that does not repeat, in cells along x, y and z."""


def wrap(place: np.ndarray, period: tuple[float, ...]) -> np.ndarray:
    """Places within the periods."""
    repeats = np.isfinite(period)
    return np.where(repeats, place % np.where(repeats, period, 1.0), place)


def value_noise(p: np.ndarray, seed: np.ndarray, period: tuple[float, ...] = ENDLESS) -> np.ndarray:
    return _cubes(p, lambda cell, away: unit(lattice(wrap(cell, period), seed)) * 2 - 1)


def gradient_noise(p: np.ndarray, seed: np.ndarray, period: tuple[float, ...] = ENDLESS) -> np.ndarray:
    return 0.9649214 * _cubes(p, lambda cell, away: edges(lattice(wrap(cell, period), seed), away))


def _cubes(p: np.ndarray, corner) -> np.ndarray:
    cell, inside = np.floor(p), p - np.floor(p)
    fade = inside**3 * (inside * (inside * 6 - 15) + 10)
    weights = ((np.prod(np.where(c, fade, 1 - fade), -1)[..., None], np.array(c)) for c in np.ndindex(2, 2, 2))
    return np.sum([weight * corner(cell + c, inside - c) for weight, c in weights], axis=0)


def simplex_noise(p: np.ndarray, seed: np.ndarray, period: tuple[float, ...] = ENDLESS) -> np.ndarray:
    """The sum over all corners that could be in reach: it knows nothing of tetrahedra."""
    p = p * DENSITY
    cell = np.floor(p + p.sum(-1, keepdims=True) / 3)
    total = np.zeros(p.shape)
    for c in np.ndindex(4, 4, 4):
        corner = cell + np.array(c) - 1
        at = corner - corner.sum(-1, keepdims=True) / 6
        away = p - at
        at = wrap(np.round(6 * at), tuple(6 * DENSITY * cells for cells in period)) / 6
        corner = np.round(at + at.sum(-1, keepdims=True) / 3)
        reach = np.maximum(0.5 - (away**2).sum(-1), 0) ** 4
        if reach.any():
            total += reach[..., None] * edges(lattice(corner, seed), away)
    return 76.88075 * total


def white_noise(p: np.ndarray, seed: np.ndarray, period: tuple[float, ...] = ENDLESS) -> np.ndarray:
    return unit(lattice(wrap(np.floor(p), period), seed)) * 2 - 1


KINDS = {"gradient": gradient_noise, "value": value_noise, "white": white_noise, "simplex": simplex_noise}
