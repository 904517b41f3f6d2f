"""Few levels and few colors."""

from __future__ import annotations

from typing import Literal

import numpy as np

from .hashing import hash3
from .pixels import Array, premultiply_color, srgb_decode, srgb_encode, straight
from .places import grid


def bayer(cell: Array, bits: int) -> Array:
    """The threshold of a cell in the Bayer matrix (1973) with 2^bits cells on a side."""
    rank = np.zeros_like(cell[..., :1])
    for bit in range(bits):
        x, y = cell[..., :1] >> bit & 1, cell[..., 1:] >> bit & 1
        rank = 4 * rank + 2 * (x ^ y) + y
    return (rank + 0.5) / 4.0**bits


def dither(
    image: Array,
    pattern: Literal["bayer", "white"],
    levels: Array | float,
    space: str,
    size: float,
    colored: bool,
    animate: bool,
    frame: int,
) -> Array:
    """A few levels without banding: ceil(c (levels - 1) - threshold) / (levels - 1)."""
    color, alpha = straight(image)
    height, width = image.shape[:2]
    steps = np.maximum(levels, 2.0) - 1.0
    cell = np.floor(grid(width, height) / max(size, 1.0)).astype(np.int64)
    cell = cell + (3 * frame * np.array([48, 36]) if animate else 0)  # steps of the R2 sequence (Roberts 2018)
    channels = []
    for channel in range(3):
        part = channel if colored else 0
        if pattern == "white":
            whole = np.concatenate([cell, np.full_like(cell[..., :1], part)], axis=-1)
            threshold = hash3(whole, np.zeros(3))[..., :1]
        else:
            threshold = bayer(cell + part * np.array([48, 36]), 3)
        code = color[..., channel : channel + 1]
        code = (srgb_encode(code) if space == "display" else code) * steps
        near = np.abs(code - np.round(code)) < 1e-3  # at a level already, up to rounding
        code = np.ceil(np.where(near, np.round(code), code) - threshold) / steps
        channels.append(srgb_decode(code) if space == "display" else code)
    return premultiply_color(np.concatenate(channels, axis=-1), alpha)


def color_palette(
    image: Array,
    colors: tuple[float, ...],
    dither: Literal["none", "bayer 2", "bayer 4", "bayer 8"],
    spread: float,
    size: float,
) -> Array:
    """The nearest color of a palette, by the distance of sRGB codes, after a pattern is added (Bayer 1973)."""
    color, alpha = straight(image)
    height, width = image.shape[:2]
    cell = np.floor(grid(width, height) / max(size, 1.0)).astype(np.int64)
    bits = {"bayer 2": 1, "bayer 4": 2, "bayer 8": 3}
    threshold = bayer(cell, bits[dither]) if dither in bits else 0.5
    code = srgb_encode(np.maximum(color, 0.0)) + spread * (threshold - 0.5)
    palette = np.reshape(colors, (-1, 5))[:, 1:4]
    away = code[..., None, :] - srgb_encode(np.maximum(palette, 0.0))
    return premultiply_color(palette[(away * away).sum(axis=-1).argmin(axis=-1)], alpha)
