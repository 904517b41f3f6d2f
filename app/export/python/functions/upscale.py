"""Super resolution: FSR 1 (AMD 2021, ffx_fsr1.h)."""

from __future__ import annotations

import numpy as np

from .pixels import Array, join, largest, smallest
from .places import Edge, grid, pixels_at, shift_picture


def fsr_codes(image: Array, light: str) -> Array:
    """What FSR filters: square roots of light within 0..1. Light of a scene is first made to fit."""
    code = np.maximum(image, 0.0)
    if light == "scene":
        code = join(code[..., :3] / (1.0 + largest(code)), code[..., 3:])
    return np.sqrt(np.clip(code, 0.0, 1.0))


def fsr_edges(lumas: dict[tuple[int, int], Array], t: Array) -> tuple[Array, Array, Array]:
    """The slopes along x and y around each place, and how clear an edge is there: 0 for a ridge, 2 for an edge."""
    across, down, clear = 0.0, 0.0, 0.0
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        weight = (t[..., :1] if i else 1.0 - t[..., :1]) * (t[..., 1:] if j else 1.0 - t[..., 1:])
        slopes = []
        for right, below in ((1, 0), (0, 1)):
            before, after = lumas[i - right, j - below], lumas[i + right, j + below]
            steepest = np.maximum(np.abs(after - lumas[i, j]), np.abs(lumas[i, j] - before))
            slopes.append(after - before)
            clear = clear + weight * np.clip(np.abs(after - before) / np.maximum(steepest, 1e-9), 0.0, 1.0) ** 2
        across, down = across + weight * slopes[0], down + weight * slopes[1]
    return np.asarray(across), np.asarray(down), np.asarray(clear)


def fsr_enlarged(codes: Array, width: int, height: int, edge: str) -> Array:
    """EASU: the 12 nearest pixels, weighed by a Lanczos kernel that is stretched along the edge.

    No channel leaves the range of the 4 nearest pixels.
    """
    rows, columns = codes.shape[:2]
    place = grid(width, height) * (columns / width, rows / height) - 0.5
    corner = np.floor(place).astype(int)
    t, x, y = place - corner, corner[..., 0], corner[..., 1]
    steps = [(i, j) for j in range(-1, 3) for i in range(-1, 3) if {i, j} - {-1, 2}]  # without the corners
    taps = {(i, j): pixels_at(codes, x + i, y + j, edge) for i, j in steps}
    lumas = {at: (tap[..., :3] * (0.5, 1.0, 0.5)).sum(axis=-1, keepdims=True) for at, tap in taps.items()}
    across, down, clear = fsr_edges(lumas, t)
    steep = across**2 + down**2
    is_flat = steep < 1.0 / 32768.0
    size = np.where(is_flat, 1.0, np.sqrt(np.where(is_flat, 1.0, steep)))
    across, down = np.where(is_flat, 1.0, across) / size, down / size
    clear = 0.25 * clear**2
    longer = (across**2 + down**2) / np.maximum(np.abs(across), np.abs(down))
    lobe = 0.5 - 0.29 * clear
    total, whole = 0.0, 0.0
    for (i, j), tap in taps.items():
        right, below = i - t[..., :1], j - t[..., 1:]
        along = (right * across + below * down) * (1.0 + (longer - 1.0) * clear)
        beside = (below * across - right * down) * (1.0 - 0.5 * clear)
        square = np.minimum(along**2 + beside**2, 1.0 / lobe)
        weight = (1.5625 * (0.4 * square - 1.0) ** 2 - 0.5625) * (lobe * square - 1.0) ** 2
        total, whole = total + weight * tap, whole + weight
    nearest = [taps[at] for at in ((0, 0), (1, 0), (0, 1), (1, 1))]
    return np.clip(total / whole, np.min(nearest, axis=0), np.max(nearest, axis=0))


def fsr_sharpened(codes: Array, sharpness: Array | float, light: str, edge: str) -> Array:
    """RCAS: subtracts as much of the four neighbors as leaves the result within 0..1."""
    here = codes[..., :3]
    around = [shift_picture(codes, *step, edge)[..., :3] for step in ((0, -1), (-1, 0), (1, 0), (0, 1))]
    least, most = np.min(around, axis=0), np.max(around, axis=0)
    to_black = least / np.maximum(4.0 * most, 1e-9)
    to_white = (1.0 - most) / np.maximum(4.0 - 4.0 * least, 1e-9)
    lobe = np.clip(-smallest(np.minimum(to_black, to_white)), -0.1875, 0.0) * sharpness
    sharp = (lobe * np.sum(around, axis=0) + here) / (4.0 * lobe + 1.0)
    if light == "scene":  # codes near 1 stand for very bright light, which would become fireflies
        sharp = np.clip(sharp, np.minimum(least, here), np.maximum(most, here))
    return join(np.clip(sharp, 0.0, 1.0), codes[..., 3:])


def upscale(image: Array, scale: float, sharpness: Array | float, light: str, edge: Edge) -> Array:
    """Enlarge the picture with sharp edges, by FSR 1: EASU, then RCAS."""
    rows, columns = image.shape[:2]
    width, height = max(round(columns * scale), 1), max(round(rows * scale), 1)
    codes = fsr_codes(image, light)
    if (width, height) != (columns, rows):
        codes = fsr_enlarged(codes, width, height, edge)
    result = fsr_sharpened(codes, sharpness, light, edge) ** 2
    if light == "scene":
        result = join(result[..., :3] / np.maximum(1.0 - largest(result), 1.0 / 65536.0), result[..., 3:])
    return result
