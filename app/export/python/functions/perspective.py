"""Planes in perspective, and lenses."""

from __future__ import annotations

from typing import Literal

import numpy as np

from .pixels import Array, length
from .places import Edge, bilinear, grid, kernel_radius, kernel_weight, pixels_at


def map_square(corners: list[tuple[float, float]]) -> Array:
    """The matrix that maps the unit square to a quadrangle whose corners go around it (Heckbert 1989)."""
    a, b, c, d = np.asarray(corners, np.float64)
    g, h = np.linalg.solve(np.stack([b - c, d - c], axis=1), a - b + c - d)
    return np.vstack([np.stack([b - a + g * b, d - a + h * d, a], axis=1), [g, h, 1.0]])


def sample_filtered(image: Array, places: Array, kernel: str, edge: str) -> Array:
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
            result[here] += np.where(near > 1e-9, sample_filtered(image, place, kernel, edge), 0.0) / (n * n)
    return result


def bent(p: Array, radial: tuple[float, float, float], tangential: tuple[float, float]) -> tuple[Array, ...]:
    """Where a lens shows points [..., 2], in focal lengths from its axis (Brown 1966, Conrady 1919).

    And the derivative: of x along x, of x along y, which is that of y along x, and of y along y.
    """
    (k1, k2, k3), (p1, p2) = radial, tangential
    x, y = p[..., :1], p[..., 1:]
    square = x * x + y * y
    scale = 1.0 + square * (k1 + square * (k2 + square * k3))
    rise = 2.0 * (k1 + square * (2.0 * k2 + square * 3.0 * k3))
    place = p * scale + 2.0 * x * y * np.array([p1, p2]) + (square + 2.0 * p * p) * np.array([p2, p1])
    across = scale + rise * x * x + 2.0 * y * p1 + 6.0 * x * p2
    down = scale + rise * y * y + 2.0 * x * p2 + 6.0 * y * p1
    return place, across, rise * x * y + 2.0 * (x * p1 + y * p2), down


def straighten_rays(seen: Array, radial: tuple[float, float, float], tangential: tuple[float, float]) -> Array:
    """The inverse, by Newton's method from the center outward; far away where there is none."""
    p, lost = np.zeros_like(seen), np.zeros(seen[..., :1].shape, bool)
    for i in range(8):
        place, a, b, c = bent(p, radial, tangential)
        area = a * c - b * b
        lost |= area < 1e-3
        missed = seen * min((i + 1) / 4.0, 1.0) - place
        x, y = missed[..., :1], missed[..., 1:]
        step = np.concatenate([c * x - b * y, a * y - b * x], axis=-1) / np.where(lost, 1.0, area)
        p = np.where(lost, p, p + step)
    place, a, b, c = bent(p, radial, tangential)
    return np.where(lost | (length(place - seen) >= 1e-3) | (a * c - b * b <= 1e-3), 1e6, p)


def lens_distortion(
    image: Array,
    direction: str,
    k1: float,
    k2: float,
    k3: float,
    p1: float,
    p2: float,
    focal: float,
    zoom: float,
    center: tuple[float, float],
    kernel: str,
    edge: Literal["black", "clamp"],
) -> Array:
    """Distort a picture as a lens does, or straighten what a lens has distorted."""
    height, width = image.shape[:2]
    middle, radial, tangential = np.asarray(center) * (width, height), (k1, k2, k3), (p1, p2)

    def find_ray(at: Array) -> Array:
        p = (at - middle) / (focal * zoom)
        return straighten_rays(p, radial, tangential) if direction == "distort" else p

    def source(at: Array) -> Array:
        p = find_ray(at)
        return middle + focal * (p if direction == "distort" else bent(p, radial, tangential)[0])

    at = grid(width, height)
    _, a, b, c = bent(find_ray(at), radial, tangential)
    if direction == "distort":  # the derivative of the inverse
        area = a * c - b * b
        a, b, c = c / area, -b / area, a / area
    span = np.maximum(np.hypot(a, b), np.hypot(b, c)) / zoom
    counts = np.ceil(np.clip(span - 0.01, 1.0, 8.0))[..., 0]
    result = np.zeros_like(image)
    for n in np.unique(counts).astype(int):
        here = counts == n
        for i in range(n * n):
            offset = (np.array([i % n, i // n]) + 0.5) / n - 0.5
            result[here] += sample_filtered(image, source(at[here] + offset), kernel, edge) / (n * n)
    return result
