"""Strokes in 64 bits: the weight of a brush as the largest of very many discs along its way, averaged over pixels."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

Points = list[tuple[float, float, float]]


def list_discs(points: Points, apart: float = 0.1) -> np.ndarray:
    """Discs (x, y, radius) along a way through points in pixels, so many that they are `apart` at most."""
    rows = np.array(points, float)
    if len(rows) == 1:
        return rows
    parts = []
    for start, end in pairwise(rows):
        spacing = min(apart, 0.1 * max(min(start[2], end[2]), 0.1))
        count = max(int(np.ceil(np.hypot(*(end - start)[:2]) / spacing)), 1)
        parts.append(start + (end - start) * np.linspace(0.0, 1.0, count + 1)[:, None])
    return np.vstack(parts)


def cover_pixels(points: Points, hardness: float, size: tuple[int, int], parts: int = 16) -> np.ndarray:
    """The mean weight over each pixel of a picture, by `parts` x `parts` places in each.

    The weight of a disc is 1 up to `hardness` of its radius, then a smooth step to 0 at its rim.
    """
    width, height = size
    weights = np.zeros((height * parts, width * parts), np.float32)
    for x, y, radius in list_discs(points):
        low = [max(int((place - radius) * parts), 0) for place in (x, y)]
        high = [max(int((place + radius) * parts) + 1, 0) for place in (x, y)]
        window = weights[low[1] : high[1], low[0] : high[0]]
        if radius <= 0.0 or not window.size:
            continue
        across, down = ((start + np.arange(n) + 0.5) / parts for start, n in zip(low, window.shape[::-1], strict=True))
        u = np.hypot(across - x, down[:, None] - y) / radius
        t = np.clip((1.0 - u) / max(1.0 - hardness, 1e-9), 0.0, 1.0)
        np.maximum(window, t * t * (3.0 - 2.0 * t), out=window)
    return weights.reshape(height, parts, width, parts).mean(axis=(1, 3))


def drag_places(points: Points, hardness: float, strength: float, spacing: float, x: np.ndarray, y: np.ndarray):
    """Where in the picture the places of a smeared one come from, after Gustafsson (1993): the way is walked in steps,
    and each of them drags what is under the brush by as much of the step as the brush weighs there."""
    rows = np.array(points, float)
    lengths = np.hypot(*np.diff(rows[:, :2], axis=0).T)
    count = int(np.ceil(lengths.sum() / spacing))
    along = np.linspace(0.0, lengths.sum(), count + 1)
    stamps = np.stack([np.interp(along, [0.0, *np.cumsum(lengths)], column) for column in rows.T], axis=1)
    x, y = x.astype(float), y.astype(float)
    for before, stamp in reversed(list(pairwise(stamps))):
        u = np.hypot(x - stamp[0], y - stamp[1]) / max(stamp[2], 1e-9)
        t = np.clip((1.0 - u) / max(1.0 - hardness, 1e-6), 0.0, 1.0)
        weight = strength * t * t * (3.0 - 2.0 * t)
        x, y = x - weight * (stamp[0] - before[0]), y - weight * (stamp[1] - before[1])
    return x, y
