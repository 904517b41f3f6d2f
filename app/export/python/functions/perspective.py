"""Planes in perspective."""

from __future__ import annotations

import numpy as np

from .pixels import Array, length
from .places import Edge, bilinear, grid, kernel_radius, kernel_weight, pixels_at


def map_square(corners: list[tuple[float, float]]) -> Array:
    """The matrix that maps the unit square to a quadrangle whose corners go around it (Heckbert 1989)."""
    a, b, c, d = np.asarray(corners, np.float64)
    g, h = np.linalg.solve(np.stack([b - c, d - c], axis=1), a - b + c - d)
    return np.vstack([np.stack([b - a + g * b, d - a + h * d, a], axis=1), [g, h, 1.0]])


def filtered(image: Array, places: Array, kernel: str, edge: str) -> Array:
    """The picture at places [n, 2] between its pixels."""
    if kernel == "nearest":
        at = np.floor(places).astype(int)
        return pixels_at(image, at[..., 0], at[..., 1], edge)
    if kernel == "triangle":
        return bilinear(image, places, edge)
    taps = 2 * int(kernel_radius(kernel))
    first = np.floor(places - 0.5).astype(int) - taps // 2 + 1
    total, whole = 0.0, 0.0
    for i in range(taps * taps):
        at = first + np.array([i % taps, i // taps])
        away = at + 0.5 - places
        weight = (kernel_weight(away[..., 0], kernel) * kernel_weight(away[..., 1], kernel))[..., None]
        total, whole = total + weight * pixels_at(image, at[..., 0], at[..., 1], edge), whole + weight
    return np.asarray(total / whole)


def corner_pin(
    image: Array,
    top_left: tuple[float, float],
    top_right: tuple[float, float],
    bottom_right: tuple[float, float],
    bottom_left: tuple[float, float],
    direction: str,
    kernel: str,
    edge: Edge,
) -> Array:
    """Put the corners on four places in perspective; a pixel that covers several is the mean of n x n samples."""
    height, width = image.shape[:2]
    matrix = map_square([top_left, top_right, bottom_right, bottom_left])
    if direction == "pin":
        matrix = np.linalg.inv(matrix)

    def source(at: Array) -> tuple[Array, Array]:
        seen = np.concatenate([at / (width, height), np.ones_like(at[..., :1])], axis=-1) @ matrix.T
        near = seen[..., 2:]
        return np.clip(seen[..., :2] / np.maximum(near, 1e-9), -1e4, 1e4) * (width, height), near

    at, right, down = grid(width, height), np.array([0.5, 0.0]), np.array([0.0, 0.5])
    across = length(source(at + right)[0] - source(at - right)[0])
    along = length(source(at + down)[0] - source(at - down)[0])
    counts = np.ceil(np.clip(np.maximum(across, along) - 0.01, 1.0, 8.0))[..., 0]
    result = np.zeros_like(image)
    for n in np.unique(counts).astype(int):
        here = counts == n
        for i in range(n * n):
            offset = (np.array([i % n, i // n]) + 0.5) / n - 0.5
            place, near = source(at[here] + offset)
            result[here] += np.where(near > 1e-9, filtered(image, place, kernel, edge), 0.0) / (n * n)
    return result
