"""A picture bent by a grid of points."""

from __future__ import annotations

import numpy as np

from .perspective import sample_filtered
from .pixels import Array
from .places import Edge, grid

SECOND_DERIVATIVES = np.array(
    [[0.0, 0.0, 0.0, 0.0], [1.6, -3.6, 2.4, -0.4], [-0.4, 2.4, -3.6, 1.6], [0.0, 0.0, 0.0, 0.0]]
)
"""At each of four points, of the natural cubic splines through 1 at one of them and 0 at the others."""


def weights_of_four(t: Array, interpolation: str) -> tuple[Array, Array]:
    """What each of four points in a row counts at t, from 0 to 3, and how fast that changes. Beyond, it is linear."""
    inside = np.clip(t, 0.0, 3.0)
    cell = np.minimum(np.floor(inside), 2.0).astype(int)
    f = (inside - cell)[..., None]
    g = 1.0 - f
    lower, upper = np.eye(4)[cell], np.eye(4)[cell + 1]
    weights, slopes = g * lower + f * upper, upper - lower
    if interpolation == "smooth":
        here, after = SECOND_DERIVATIVES[cell], SECOND_DERIVATIVES[cell + 1]
        weights = weights + ((g**3 - g) * here + (f**3 - f) * after) / 6.0
        slopes = slopes + ((1.0 - 3.0 * g * g) * here + (3.0 * f * f - 1.0) * after) / 6.0
    return weights + (t - inside)[..., None] * slopes, slopes


def grid_place(t: Array, points: Array, interpolation: str) -> tuple[Array, Array]:
    """Where places [n, 2] on the grid go, and the derivative [n, 2, 2]: its columns are those along the grid."""
    across, across_slope = weights_of_four(t[:, 0], interpolation)
    down, down_slope = weights_of_four(t[:, 1], interpolation)
    place = np.einsum("ni,nj,ijk->nk", down, across, points)
    right = np.einsum("ni,nj,ijk->nk", down, across_slope, points)
    below = np.einsum("ni,nj,ijk->nk", down_slope, across, points)
    return place, np.stack([right, below], axis=-1)


def grid_source(at: Array, points: Array, interpolation: str) -> tuple[Array, Array, Array]:
    """The places on the grid that go to places [n, 2], the derivative of the inverse, and where there is one.

    Newton's method, from the nearest of the places at every half cell.
    """
    starts = 0.5 * np.stack(np.meshgrid(np.arange(7), np.arange(7)), axis=-1).reshape(-1, 2)
    reached, _ = grid_place(starts, points, interpolation)
    t = starts[((at[:, None] - reached) ** 2).sum(axis=-1).argmin(axis=1)]
    found = np.ones(len(at), bool)
    for _ in range(10):
        place, slope = grid_place(t, points, interpolation)
        area, away = np.linalg.det(slope), at - place
        found &= np.abs(area) >= 1e-6
        x, y = away.T
        step = np.stack([slope[:, 1, 1] * x - slope[:, 0, 1] * y, slope[:, 0, 0] * y - slope[:, 1, 0] * x], axis=-1)
        step /= np.where(found, area, 1.0)[:, None]
        # Long steps leave the part of the grid where the derivative says anything; outside all is straight.
        is_inside, size = np.all((t > 0.0) & (t < 3.0), axis=-1), np.hypot(step[:, 0], step[:, 1])
        shorter = np.where(is_inside & (size > 0.5), 0.5 / np.maximum(size, 1e-9), 1.0)
        t = np.where(found[:, None], t + step * shorter[:, None], t)
        found &= np.all(np.abs(t) <= 1e4, axis=-1)
        t = np.clip(t, -1e4, 1e4)
    place, slope = grid_place(t, points, interpolation)
    found &= (((at - place) ** 2).sum(axis=-1) <= 0.02**2) & (np.abs(np.linalg.det(slope)) >= 1e-6)
    slope[~found] = np.eye(2)
    return t, np.linalg.inv(slope), found


def grid_warp(
    image: Array, points: tuple[tuple[float, float], ...], interpolation: str, kernel: str, edge: Edge
) -> Array:
    """Bend the picture by 4 x 4 points, row by row: what lies at a point goes to where that is dragged.

    In between, the grid is a natural cubic spline along both axes, or bilinear. A pixel that covers several is the mean
    of n x n samples.
    """
    height, width = image.shape[:2]
    places = np.reshape(points, (4, 4, 2)) * np.array([width, height])
    t, slope, found = grid_source(grid(width, height).reshape(-1, 2), places, interpolation)
    cell = np.array([width, height]) / 3.0
    slope = slope * cell[:, None]  # pixels of the picture to a pixel of the result
    span = np.sqrt((slope * slope).sum(axis=1)).max(axis=-1)
    counts = np.ceil(np.clip(span - 0.01, 1.0, 8.0))
    result = np.zeros((height * width, image.shape[2]))
    for n in np.unique(counts).astype(int):
        here = found & (counts == n)
        for i in range(n * n):
            offset = (np.array([i % n, i // n]) + 0.5) / n - 0.5
            result[here] += sample_filtered(image, t[here] * cell + slope[here] @ offset, kernel, edge) / (n * n)
    return result.reshape(image.shape)
