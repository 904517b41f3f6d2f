"""Jagged edges made smooth."""

from __future__ import annotations

import numpy as np

from .pixels import Array, display_tone, smoothstep
from .places import bilinear, grid, shift_picture

EDGE_STEPS = {
    "low": (1.0, 1.5, 2.0, 4.0, 12.0),
    "medium": (1.0, 1.5, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 4.0, 8.0),
    "high": (1.0, 1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 2.0, 2.0, 2.0, 4.0, 8.0),
}
"""Pixels from one step of the search along an edge to the next: presets 12, 29 and 39 of FXAA 3.11."""


def find_end(
    tone: Array, start: Array, along: Array, edge_tone: Array, enough: Array, steps: tuple[float, ...]
) -> tuple[Array, Array]:
    """How far an edge goes on, and how the tone differs there from that of the edge."""
    away, differs = np.full_like(tone, steps[0]), np.zeros_like(tone)
    goes_on = np.ones(tone.shape, bool)
    for step in steps[1:]:
        differs = np.where(goes_on, bilinear(tone, start + away * along) - edge_tone, differs)
        goes_on &= np.abs(differs) < enough
        away = np.where(goes_on, away + step, away)
    return away, differs


def fxaa(image: Array, quality: str, subpixel: float, threshold: float, threshold_dark: float) -> Array:
    """FXAA 3.11 (Lottes 2011): each pixel on an edge is read from a place across it, the nearer an end the farther."""
    height, width = image.shape[:2]
    tone = display_tone(image)
    near = {(x, y): shift_picture(tone, x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)}
    here, north, south, west, east = (near[at] for at in ((0, 0), (0, -1), (0, 1), (-1, 0), (1, 0)))
    five = [here, north, south, west, east]
    high = np.max(five, axis=0)
    contrast = high - np.min(five, axis=0)
    is_edge = (contrast >= np.maximum(threshold_dark, high * threshold)) & (contrast > 0.0)

    rows = [np.abs(near[x, -1] + near[x, 1] - 2.0 * near[x, 0]) for x in (-1, 0, 1)]
    columns = [np.abs(near[-1, y] + near[1, y] - 2.0 * near[0, y]) for y in (-1, 0, 1)]
    is_level = rows[0] + 2.0 * rows[1] + rows[2] >= columns[0] + 2.0 * columns[1] + columns[2] - 1e-5 * high
    before, after = np.where(is_level, north, west), np.where(is_level, south, east)
    is_before = np.abs(before - here) >= np.abs(after - here)
    along = np.where(is_level, (1.0, 0.0), (0.0, 1.0))
    toward = np.where(is_before, -1.0, 1.0) * along[..., ::-1]
    edge_tone = 0.5 * (here + np.where(is_before, before, after))
    enough = 0.25 * np.maximum(np.abs(before - here), np.abs(after - here))
    start = grid(width, height) + 0.5 * toward
    left, left_tone = find_end(tone, start, -along, edge_tone, enough, EDGE_STEPS[quality])
    right, right_tone = find_end(tone, start, along, edge_tone, enough, EDGE_STEPS[quality])
    # The pixel moves only if the edge cuts into it at the nearer end.
    end, end_tone = np.minimum(left, right), np.where(left < right, left_tone, right_tone)
    shift = np.where((end_tone < 0.0) != (here < edge_tone), 0.5 - end / (left + right), 0.0)
    corners = near[-1, -1] + near[1, -1] + near[-1, 1] + near[1, 1]
    mean = (2.0 * (north + south + west + east) + corners) / 12.0
    lonely = smoothstep(0.0, 1.0, np.abs(mean - here) / np.where(contrast > 0.0, contrast, 1.0))
    shift = np.maximum(shift, lonely * lonely * subpixel)
    return np.where(is_edge, bilinear(image, grid(width, height) + shift * toward), image)
