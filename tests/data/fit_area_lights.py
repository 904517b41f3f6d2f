"""Fits linearly transformed cosines to GGX, for nodes/light/area_lights.bin: python tests/data/fit_area_lights.py

By Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines". A cell of
the table has a roughness (across) and an angle of the eye (down, by the root of 1 - cosine). Its matrix turns GGX into
a cosine: the four numbers of its inverse that are neither 0 nor 1 are in the upper half. In the lower half are the part
of white light that GGX reflects at a Fresnel reflectance of 1, divided by the part of the lobe above the horizon, and
zeros. All numbers are halves.
"""

from __future__ import annotations

import argparse
from multiprocessing import Pool
from pathlib import Path

import numpy as np
from scipy.optimize import minimize

COUNT = 64
"""Roughnesses and angles."""

SAMPLES = 32
"""Samples in each of two dimensions, as in the paper's own code."""

SMOOTH = 0.0016
"""The least alpha, that of `deferred_lighting`."""

Array = np.ndarray
_U, _V = (grid.ravel() for grid in np.meshgrid(*[(np.arange(SAMPLES) + 0.5) / SAMPLES] * 2))


def ggx_times_cosine(view: Array, ways: Array, alpha: float) -> tuple[Array, Array]:
    """GGX of reflectance 1 times the cosine of the light, and the density of `sample_ggx`."""
    half = view + ways
    half = half / np.linalg.norm(half, axis=1, keepdims=True)
    nv, nl, nh = view[2], ways[:, 2], half[:, 2]
    off = half[:, 0] ** 2 + half[:, 1] ** 2
    facets = alpha**2 / (np.pi * ((alpha * nh) ** 2 + off) ** 2)
    a2 = alpha**2
    lit = np.maximum(nl, 1e-9)
    seen = 0.5 / (lit * np.sqrt(nv**2 * (1 - a2) + a2) + nv * np.sqrt(lit**2 * (1 - a2) + a2))
    density = facets * nh / (4.0 * np.maximum(half @ view, 1e-9))
    return np.where(nl > 0.0, facets * seen * nl, 0.0), density


def sample_ggx(view: Array, alpha: float) -> Array:
    """Directions of light that facets of GGX mirror."""
    far, turn = alpha * np.sqrt(_U / (1.0 - _U)), 2.0 * np.pi * _V
    half = np.stack([far * np.cos(turn), far * np.sin(turn), np.ones_like(far)], 1)
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    return 2.0 * (half @ view)[:, None] * half - view


def average_ggx(view: Array, alpha: float) -> tuple[float, Array]:
    """What is reflected at a reflectance of 1, and the mean direction of it."""
    ways = sample_ggx(view, alpha)
    reflected, density = ggx_times_cosine(view, ways, alpha)
    weights = reflected / density
    mean = weights @ ways
    mean[1] = 0.0
    return float(weights.mean()), mean / np.linalg.norm(mean)


def matrix_of(numbers: Array, mean: Array) -> Array:
    """The matrix that turns a cosine into the lobe."""
    frame = np.stack([np.array([mean[2], 0.0, -mean[0]]), np.array([0.0, 1.0, 0.0]), mean], 1)
    across, along, skew = numbers
    return frame @ np.array([[across, 0.0, skew], [0.0, along, 0.0], [0.0, 0.0, 1.0]])


def lobe(matrix: Array, ways: Array) -> Array:
    """The linearly transformed cosine, whose integral is 1."""
    back = ways @ np.linalg.inv(matrix).T
    size = np.linalg.norm(back, axis=1)
    return np.maximum(back[:, 2] / size, 0.0) / np.pi / (abs(np.linalg.det(matrix)) * size**3)


def measure_misfit(matrix: Array, view: Array, alpha: float, share: float, around: tuple[Array, Array, Array]) -> float:
    """The integral of the third power of the difference, by samples of both lobes."""
    ways, reflected, density = around
    own = lobe(matrix, ways)
    total = (np.abs(reflected - share * own) ** 3 / (density + own)).mean()
    cosine, turn = np.sqrt(_U), 2.0 * np.pi * _V
    sine = np.sqrt(1.0 - _U)
    more = np.stack([sine * np.cos(turn), sine * np.sin(turn), cosine], 1) @ matrix.T
    more /= np.linalg.norm(more, axis=1, keepdims=True)
    reflected, density = ggx_times_cosine(view, more, alpha)
    own = lobe(matrix, more)
    return float(total + (np.abs(reflected - share * own) ** 3 / (density + own)).mean())


def measure_lit_part(matrix: Array) -> float:
    """The part of a lobe that lies above the horizon."""
    cosine, turn = np.sqrt(_U), 2.0 * np.pi * _V
    sine = np.sqrt(1.0 - _U)
    return float((np.stack([sine * np.cos(turn), sine * np.sin(turn), cosine], 1) @ matrix.T > 0.0)[:, 2].mean())


def fit_row(column: int) -> Array:
    """The cells of a roughness, from the eye above the surface to one at its horizon."""
    alpha = max((column / (COUNT - 1)) ** 2, SMOOTH)
    cells, start = np.zeros((COUNT, 5)), np.array([alpha, alpha, 0.0])
    for row in range(COUNT):
        cosine = max(1.0 - (row / (COUNT - 1)) ** 2, 1e-3)
        view = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
        share, mean = average_ggx(view, alpha)
        if row == 0:
            mean = np.array([0.0, 0.0, 1.0])
        ways = sample_ggx(view, alpha)
        around = (ways, *ggx_times_cosine(view, ways, alpha))

        def misfit(numbers: Array) -> float:
            full = np.array([numbers[0], numbers[0], 0.0]) if row == 0 else numbers  # noqa: B023
            full = np.array([max(full[0], 1e-7), max(full[1], 1e-7), full[2]])
            return measure_misfit(matrix_of(full, mean), view, alpha, share, around)  # noqa: B023

        first = start[:1] if row == 0 else start
        steps = np.vstack([first, *(first + 0.05 * max(alpha, 0.02) * unit for unit in np.eye(len(first)))])
        fitted = minimize(
            misfit, first, method="Nelder-Mead", options={"initial_simplex": steps, "maxiter": 300, "xatol": 1e-6}
        ).x
        start = np.array([fitted[0], fitted[0], 0.0]) if row == 0 else fitted
        start[:2] = np.maximum(start[:2], 1e-7)
        inverse = np.linalg.inv(matrix_of(start, mean))
        inverse /= inverse[1, 1]
        above = measure_lit_part(matrix_of(start, mean))
        cells[row] = inverse[0, 0], inverse[0, 2], inverse[2, 0], inverse[2, 2], share / above
    return cells


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("path", nargs="?", default=Path(__file__).parents[2] / "nodes/light/area_lights.bin")
    with Pool() as pool:
        cells = np.stack(pool.map(fit_row, range(COUNT)), 1)
    table = np.zeros((2 * COUNT, COUNT, 4))
    table[:COUNT], table[COUNT:, :, 0] = cells[..., :4], cells[..., 4]
    table.astype("<f2").tofile(parser.parse_args().path)


if __name__ == "__main__":
    main()
