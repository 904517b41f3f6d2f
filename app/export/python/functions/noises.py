"""Lattice noises. Each cell is hashed once and gives three independent noises, each within -1..1."""

from __future__ import annotations

import numpy as np

from .hashing import cell_bits, hash3
from .pixels import Array, mix
from .places import grid

ENDLESS = 1 << 30  # the period of a lattice that does not repeat


def lattice_period(tiles: Array, density: float, steps: int) -> Array:
    """How many cells of a layer repeat along each axis: whole numbers, so that the pattern closes."""
    counts = np.clip(np.round(tiles * density / steps), 1.0, 1e8) * steps
    return np.where(tiles > 0.0, counts, ENDLESS).astype(np.int64)


def lattice_density(tiles: Array, density: float, period: Array) -> Array:
    """How much denser a layer is along each axis, so that its period is a whole number of cells."""
    return np.where(tiles > 0.0, period / np.maximum(tiles, 1e-6), density)


def lattice_place(at: Array, size: float, period: tuple[float, float], evolution: float, loop: float) -> Array:
    """Places [..., 3] in the first layer; along an axis that repeats, within the period."""
    place = np.concatenate([at, np.full_like(at[..., :1], evolution)], axis=-1)
    periods = np.array([*period, loop])
    place = place - np.where(periods > 0.0, periods * np.floor(place / np.maximum(periods, 1e-6)), 0.0)
    return place / (size, size, 1.0)


def lattice_places(
    size: float,
    offset: tuple[float, float],
    period: tuple[float, float],
    evolution: float,
    loop: float,
    width: int,
    height: int,
) -> tuple[Array, Array]:
    """Places [height, width, 3] of all pixels in the first layer, and how many of its cells repeat; 0 for none."""
    size = max(size, 1e-3)
    place = lattice_place(grid(width, height) - np.asarray(offset), size, period, evolution, loop)
    return place, np.array([period[0] / size, period[1] / size, loop])


def lattice_inside(p: Array, period: Array) -> Array:
    """The place within the period of a layer."""
    return p - np.where(period != ENDLESS, period * np.floor(p / period), 0.0)


def lattice_wrap(cell: Array, period: Array) -> Array:
    """A cell at most one beside the period, as that within it."""
    cell = cell + np.where((cell < 0) & (period != ENDLESS), period, 0)
    return cell - np.where(cell >= period, period, 0)


def white_noise(p: Array, stream: Array, period: Array) -> Array:
    """A random value for each cell."""
    return hash3(np.floor(lattice_inside(p, period)), stream) * 2.0 - 1.0


def quintic(t: Array) -> Array:
    """Interpolation with continuous second derivative (Perlin 2002)."""
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0)


def edge_gradient(bits: Array, d: Array) -> Array:
    """The dot product of d with one of Perlin's twelve edges of a cube, chosen by the top four bits of each hash."""
    h = bits >> 28
    x, y, z = d[..., 0:1], d[..., 1:2], d[..., 2:3]
    u = np.where(h < 8, x, y)
    v = np.where(h < 4, y, np.where((h == 12) | (h == 14), x, z))
    return np.where(h & 1, -u, u) + np.where(h & 2, -v, v)


def trilinear(corners: list[Array], t: Array) -> Array:
    """The eight corners of a cell, interpolated along x, then y, then z."""
    for axis in range(3):
        part = t[..., axis : axis + 1]
        corners = [mix(a, b, part) for a, b in zip(corners[::2], corners[1::2], strict=True)]
    return corners[0]


CORNERS = [np.array([i & 1, i >> 1 & 1, i >> 2]) for i in range(8)]


def value_noise(p: Array, stream: Array, period: Array) -> Array:
    """Smooth interpolation between random values at lattice points."""
    p = lattice_inside(p, period)
    cell = np.floor(p).astype(np.int64)
    corners = [hash3(lattice_wrap(cell + corner, period), stream) for corner in CORNERS]
    return trilinear(corners, quintic(p - cell)) * 2.0 - 1.0


def gradient_noise(p: Array, stream: Array, period: Array) -> Array:
    """Gradient noise (Perlin 2002), divided by its largest possible value."""
    p = lattice_inside(p, period)
    cell = np.floor(p).astype(np.int64)
    inside = p - cell
    corners = [
        edge_gradient(cell_bits(lattice_wrap(cell + corner, period), stream), inside - corner) for corner in CORNERS
    ]
    return trilinear(corners, quintic(inside)) * 0.9649214


def simplex_corners(p: Array) -> list[tuple[Array, Array]]:
    """The corners of the tetrahedron around p and the vectors from them to p (Gustavson and McEwan 2022).

    The lattice is skewed along the diagonal: a tetrahedron is a path from one corner of a cube to the opposite one,
    along the axes in the order in which p is farthest.
    """
    p = p + p.sum(axis=-1, keepdims=True) / 3.0
    cell = np.floor(p)
    inside = p - cell
    x, y, z = inside[..., 0], inside[..., 1], inside[..., 2]
    later = np.stack([y >= x, z >= y, z >= x], axis=-1) * 1.0
    sooner = 1.0 - later
    a = np.stack([sooner[..., 2], later[..., 0], later[..., 1]], axis=-1)
    b = np.stack([sooner[..., 0], sooner[..., 1], later[..., 2]], axis=-1)
    corners = []
    for path in (np.zeros(3), np.minimum(a, b), np.maximum(a, b), np.ones(3)):
        away = inside - path
        corners.append(((cell + path).astype(np.int64), away - away.sum(axis=-1, keepdims=True) / 6.0))
    return corners


def simplex_wrap(cell: Array, period: Array) -> Array:
    """A corner within the period, which is a multiple of six cells: one period is a step of the skewed lattice."""
    place = 6 * cell - cell.sum(axis=-1, keepdims=True)
    turns = np.where(period != ENDLESS, np.floor((place + 0.5) / (3.0 * period)), 0.0).astype(np.int64)
    away = turns * (period // 6)
    return cell - (3 * away + away.sum(axis=-1, keepdims=True))


def simplex_noise(p: Array, stream: Array, period: Array) -> Array:
    """Simplex noise (Perlin 2001), with the gradients and the range of gradient noise."""
    total = 0.0
    for cell, away in simplex_corners(p * 0.5):
        reach = np.maximum(0.5 - (away * away).sum(axis=-1, keepdims=True), 0.0)
        total = total + reach**4 * edge_gradient(cell_bits(simplex_wrap(cell, period), stream), away)
    return np.asarray(total * 76.88075)  # 1 / the largest value of the sum


def simplex_slope(p: Array, stream: Array, period: Array) -> Array:
    """The gradient [..., 3] of the first of the three simplex noises."""
    total = 0.0
    for cell, away in simplex_corners(p * 0.5):
        bits = cell_bits(simplex_wrap(cell, period), stream)[..., :1]
        reach = np.maximum(0.5 - (away * away).sum(axis=-1, keepdims=True), 0.0)
        edge = np.concatenate([edge_gradient(bits, axis) for axis in np.eye(3)], axis=-1)
        total = total + reach**3 * (reach * edge - 8.0 * edge_gradient(bits, away) * away)
    return np.asarray(total * 76.88075 * 0.5)
