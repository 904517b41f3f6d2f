"""Pixels at other places: edges, interpolation, resampling."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from .pixels import Array, length

Edge = Literal["clamp", "mirror", "reflect", "wrap", "black"]
"""What lies beyond the border of a picture."""


def grid(width: int, height: int) -> Array:
    """x and y of the centers of all pixels [height, width, 2]; row 0 is the top."""
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    return np.stack([x, y], axis=-1)


def fold(index: Array, size: int, edge: str) -> Array:
    """The pixel of a row that is read for an index outside of it."""
    if edge == "wrap":
        return index % size
    if edge == "reflect":
        index = index % (2 * size)
        return np.minimum(index, 2 * size - 1 - index)
    if edge == "mirror":
        period = max(2 * size - 2, 1)
        index = index % period
        return np.minimum(index, period - index)
    return np.clip(index, 0, size - 1)


def pixels_at(image: Array, x: Array, y: Array, edge: str = "clamp") -> Array:
    """The pixels at whole numbers `x`, `y`."""
    height, width = image.shape[:2]
    read = image[fold(y, height, edge), fold(x, width, edge)]
    if edge != "black":
        return read
    inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
    return np.where(inside[..., None], read, 0.0)


def extend(image: Array, before: int, after: int, edge: str) -> Array:
    """The picture with more pixels on the left and above, and on the right and below."""
    height, width = image.shape[:2]
    rows = fold(np.arange(-before, height + after), height, edge)
    columns = fold(np.arange(-before, width + after), width, edge)
    return image[np.ix_(rows, columns)]


def shift_picture(image: Array, right: int, down: int, edge: str = "clamp") -> Array:
    """For every pixel, the one that lies so many pixels to the right and down."""
    height, width = image.shape[:2]
    y, x = np.mgrid[:height, :width]
    return pixels_at(image, x + right, y + down, edge)


def bilinear(image: Array, places: Array, edge: str = "clamp") -> Array:
    """The picture at places [..., 2] between its pixels, whose centers lie at .5."""
    corner = np.floor(places - 0.5).astype(int)
    part = places - 0.5 - corner
    x, y = corner[..., 0], corner[..., 1]
    across, down = part[..., :1], part[..., 1:]
    above = (1.0 - across) * pixels_at(image, x, y, edge) + across * pixels_at(image, x + 1, y, edge)
    below = (1.0 - across) * pixels_at(image, x, y + 1, edge) + across * pixels_at(image, x + 1, y + 1, edge)
    return (1.0 - down) * above + down * below


def cubic_weight(x: Array, b: float, c: float) -> Array:
    """The cubic filters of Mitchell and Netravali (1988); B 0 and C 1/2 is Catmull-Rom."""
    x = np.abs(x)
    near = (12.0 - 9.0 * b - 6.0 * c) * x**3 + (-18.0 + 12.0 * b + 6.0 * c) * x**2 + 6.0 - 2.0 * b
    far = (-b - 6.0 * c) * x**3 + (6.0 * b + 30.0 * c) * x**2 + (-12.0 * b - 48.0 * c) * x + 8.0 * b + 24.0 * c
    return np.where(x < 1.0, near, np.where(x < 2.0, far, 0.0)) / 6.0


def kernel_weight(x: Array, kernel: str) -> Array:
    """The weight of a pixel at a distance of x pixels, not normalized."""
    if kernel == "box":
        return (np.abs(x) < 0.5).astype(float)
    if kernel == "triangle":
        return np.maximum(1.0 - np.abs(x), 0.0)
    if kernel == "lanczos":
        return np.where(np.abs(x) < 3.0, np.sinc(x) * np.sinc(x / 3.0), 0.0)
    if kernel == "mitchell":
        return cubic_weight(x, 1 / 3, 1 / 3)
    return cubic_weight(x, 0.0, 0.5)


def kernel_radius(kernel: str) -> float:
    """How many pixels away a filter reaches."""
    return {"box": 0.5, "triangle": 1.0, "lanczos": 3.0}.get(kernel, 2.0)


def warp(image: Array, source: Callable[[Array], Array], edge: str) -> Array:
    """Show at every pixel what lies at `source(place)`. A pixel that covers several is the mean of n x n samples."""
    height, width = image.shape[:2]
    places = grid(width, height)
    right, down = np.array([0.5, 0.0]), np.array([0.0, 0.5])
    across = length(source(places + right) - source(places - right))
    along = length(source(places + down) - source(places - down))
    return warp_by_counts(image, source, edge, np.maximum(across, along))


def warp_by_counts(
    image: Array,
    source: Callable[[Array], Array],
    edge: str,
    span: Array,
    keep: Callable[[Array], Array] | None = None,
) -> Array:
    """The same for pixels that span so many pixels of the picture; 8 x 8 samples at most."""
    height, width = image.shape[:2]
    places = grid(width, height)
    span = np.broadcast_to(span, (height, width, 1))
    counts = np.ceil(np.clip(span - 0.01, 1.0, 8.0))
    result = np.zeros_like(image)
    for n in np.unique(counts).astype(int):
        here = counts[..., 0] == n
        for i in range(n * n):
            offset = (np.array([i % n, i // n]) + 0.5) / n - 0.5
            sampled = places[here] + offset
            read = bilinear(image, source(sampled), edge)
            result[here] += (read if keep is None else np.where(keep(sampled), read, 0.0)) / (n * n)
    return result


def fit(picture: Array, width: int, height: int, nearest: bool = False) -> Array:
    """The picture at another size: stretched if the shape is the same up to rounding, else scaled to cover and cropped.

    Color is averaged with a triangle filter as wide as the step between samples; data takes the nearest pixel.
    """
    rows, columns = picture.shape[:2]
    if (columns, rows) in ((width, height), (1, 1)):
        return picture
    across, down = columns / width, rows / height
    if abs(across / down - 1.0) > max(1.0 / side for side in (width, height, columns, rows)):
        across = down = min(across, down)
    x = (np.arange(width) + 0.5 - 0.5 * width) * across + 0.5 * columns
    y = (np.arange(height) + 0.5 - 0.5 * height) * down + 0.5 * rows
    if nearest:
        at = np.ix_(fold(np.floor(y).astype(int), rows, "clamp"), fold(np.floor(x).astype(int), columns, "clamp"))
        return picture[at]
    return fit_axis(fit_axis(picture, x, max(across, 1.0), 1), y, max(down, 1.0), 0)


def fit_axis(picture: Array, centers: Array, reach: float, axis: int) -> Array:
    """One axis resampled at `centers` with a triangle filter."""
    sums, total = 0.0, 0.0
    first = np.floor(centers - reach).astype(int)
    for step in range(int(np.ceil(2.0 * reach)) + 3):
        weight = np.maximum(1.0 - np.abs(first + step + 0.5 - centers) / reach, 0.0)
        weight = weight[:, None, None] if axis == 0 else weight[None, :, None]
        sums = sums + weight * np.take(picture, fold(first + step, picture.shape[axis], "clamp"), axis=axis)
        total = total + weight
    return np.asarray(sums / total)
