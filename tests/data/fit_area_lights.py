"""Fits linearly transformed cosines to GGX, for nodes/light/area_lights.bin: python tests/data/fit_area_lights.py

By Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines". A cell of
the table has a roughness (across) and an angle of the eye (down, by the root of 1 - cosine). Its matrix turns GGX into
a cosine: the four numbers of its inverse that are neither 0 nor 1 are in the upper half. In the lower half are the part
of white light that GGX reflects at a Fresnel reflectance of 1, divided by the part of the lobe above the horizon, and
zeros. All numbers are floats of 32 bits, as halves would turn the narrowest lobes by a seventh of their width.

The paper leaves the lobe around the mean direction of GGX and lets the third power of the difference be least, which
few bright directions decide. Here the lobe may turn, and the difference itself is least, since what a light adds to it
is an integral: at a roughness of 0.45 and an eye 20 degrees above the surface, 10 % of the light lies elsewhere in the
lobe, and not 13 %.
"""

from __future__ import annotations

import argparse
from multiprocessing import Pool
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

COUNT = 64
"""Roughnesses and angles."""

SAMPLES = 28
"""Samples in each of two dimensions, of either lobe. A choice: with 20 or 40, 9.8 % of the light lies elsewhere in the
lobe at the cell that is named above, with 28 it is 10.0 %."""

SMOOTH = 0.0016
"""The least alpha, that of `deferred_lighting`."""

ROUND = 0.02
"""The part of the density below which a difference counts by its square, so that its derivative is known. A choice:
with 0.1, 1 to 10 % more of the difference is left."""

Array = np.ndarray
_U, _V = (grid.ravel() for grid in np.meshgrid(*[(np.arange(SAMPLES) + 0.5) / SAMPLES] * 2))


def unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def around_axis(height: Array) -> Array:
    """Directions with a height, turned evenly around z."""
    side, turn = np.sqrt(np.clip(1.0 - height**2, 0.0, 1.0)), 2.0 * np.pi * _V
    return np.stack([side * np.cos(turn), side * np.sin(turn), height], 1)


_COSINE = around_axis(np.sqrt(_U))
"""Directions with the density of a cosine."""


def ggx_times_cosine(view: Array, ways: Array, alpha: float) -> tuple[Array, Array]:
    """GGX of reflectance 1 times the cosine of the light, and the density of `sample_ggx`."""

    def far(cosine: Array) -> Array:
        return np.sqrt(cosine**2 * (1.0 - alpha**2) + alpha**2)

    half, nv, nl = unit(view + ways), view[2], np.maximum(ways[:, 2], 0.0)
    off = half[:, 0] ** 2 + half[:, 1] ** 2
    facets = alpha**2 / (np.pi * ((alpha * half[:, 2]) ** 2 + off) ** 2)
    seen = 0.5 * nl / np.maximum(nl * far(nv) + nv * far(nl), 1e-30)
    return facets * seen, facets / (2.0 * (nv + far(nv)))


def sample_ggx(view: Array, alpha: float) -> Array:
    """Directions of light that visible facets mirror (Heitz 2018, in the form of Dupuy and Benyoub 2023)."""
    wide = np.array([alpha, alpha, 1.0])
    stretched = unit(view * wide)
    bump = around_axis(1.0 - _U * (1.0 + stretched[2])) + stretched
    half = unit(np.maximum(bump, [-np.inf, -np.inf, 1e-9]) * wide)
    return 2.0 * (half @ view)[:, None] * half - view


def matrix_of(shape: Array, alpha: float, mean: float) -> Array:
    """The matrix that turns a cosine into the lobe: its widths as logarithms, its skew and its turn, by alpha."""
    across, along = np.exp(np.clip(shape[:2], -6.0, 3.0)) * alpha
    turn = mean + alpha * shape[3]
    frame = np.array([[np.cos(turn), 0.0, np.sin(turn)], [0.0, 1.0, 0.0], [-np.sin(turn), 0.0, np.cos(turn)]])
    return frame @ np.array([[across, 0.0, alpha * shape[2]], [0.0, along, 0.0], [0.0, 0.0, 1.0]])


def lobe(matrix: Array, ways: Array) -> Array:
    """The linearly transformed cosine, whose integral is 1."""
    back = ways @ np.linalg.inv(matrix).T
    return np.maximum(back[:, 2], 0.0) / np.pi / (abs(np.linalg.det(matrix)) * (back * back).sum(1) ** 2)


def lit_part(matrix: Array) -> float:
    """The part of a lobe that lies above the horizon: that of a cosine over a hemisphere that is turned."""
    return 0.5 * (1.0 + matrix[2, 2] / float(np.linalg.norm(matrix[2])))


def fit_lobe(view: Array, alpha: float, start: Array) -> tuple[Array, float, float]:
    """The shape of the lobe with the least difference to GGX, the mean direction, and the reflected part of light.

    Both are compared in directions of GGX and of a lobe that is twice as wide as a first guess.
    """
    ways = sample_ggx(view, alpha)
    reflected, density = ggx_times_cosine(view, ways, alpha)
    weights = reflected / density
    share, middle = float(weights.mean()), weights @ ways
    mean = float(np.arctan2(middle[0], middle[2]))
    wide = matrix_of(np.array([np.log(1.6), np.log(1.6), 0.0, 0.0]), alpha, mean)
    ways = np.concatenate([ways, unit(_COSINE @ wide.T)])
    ways = ways[ways[:, 2] > 0.0]
    reflected, density = ggx_times_cosine(view, ways, alpha)
    density = density + lobe(wide, ways)
    straight_on = view[2] == 1.0

    def whole(shape: Array) -> Array:
        return np.array([shape[0], shape[0], 0.0, 0.0]) if straight_on else shape

    def misfit(shape: Array) -> Array:
        matrix = matrix_of(whole(shape), alpha, mean)
        return (share / lit_part(matrix) * lobe(matrix, ways) - reflected) / density

    first = start[:1] if straight_on else start
    return whole(least_squares(misfit, first, loss="soft_l1", f_scale=ROUND, max_nfev=200).x), mean, share


def fit_column(column: int) -> Array:
    """The cells of a roughness, from the eye above the surface to one at its horizon."""
    alpha = max((column / (COUNT - 1)) ** 2, SMOOTH)
    cells, shape = np.zeros((COUNT, 5)), np.array([np.log(0.8), np.log(0.8), 0.0, 0.0])
    for row in range(COUNT):
        cosine = max(1.0 - (row / (COUNT - 1)) ** 2, 1e-3)
        view = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
        shape, mean, share = fit_lobe(view, alpha, shape)
        matrix = matrix_of(shape, alpha, mean if row else 0.0)
        inverse = np.linalg.inv(matrix)
        inverse /= inverse[1, 1]
        cells[row] = inverse[0, 0], inverse[0, 2], inverse[2, 0], inverse[2, 2], share / lit_part(matrix)
    return cells


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("path", nargs="?", default=Path(__file__).parents[2] / "nodes/light/area_lights.bin")
    with Pool() as pool:
        cells = np.stack(pool.map(fit_column, range(COUNT), chunksize=1), 1)
    table = np.zeros((2 * COUNT, COUNT, 4))
    table[:COUNT], table[COUNT:, :, 0] = cells[..., :4], cells[..., 4]
    table.astype("<f4").tofile(parser.parse_args().path)


if __name__ == "__main__":
    main()
