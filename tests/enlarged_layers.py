"""Layers of a render at another size, as a renderer would have made them: colors are means, surfaces go on."""

from __future__ import annotations

import cv2
import numpy as np

Array = np.ndarray

SAME = 0.1
"""By what part of their depth two pixels of one object may differ and still be one surface."""


def enlarge_light(picture: Array, height: int, step: int) -> Array:
    """A picture `height` pixels high: an enlarged one, averaged by `step`."""
    size = (round(picture.shape[1] * height * step / picture.shape[0]), height * step)
    large = np.maximum(cv2.resize(picture, size, interpolation=cv2.INTER_CUBIC), 0.0)
    return cv2.resize(large, (size[0] // step, height), interpolation=cv2.INTER_AREA) if step > 1 else large


def enlarge_data(data: Array, depth: Array, surface: Array, height: int, step: int) -> Array:
    """Data of surfaces, `height` pixels high: those in the middles of pixels, or near it for an even `step`.

    Between pixels of one surface they are linear on its plane, so data times nearness is linear in the picture; at its
    edges they are those of the nearest pixel. Pixels that are only repeated would make steps of flat floors, which cast
    shadows and hide reflections.
    """
    size = (round(data.shape[1] * height * step / data.shape[0]) // step, height)
    across, down = np.meshgrid(*(find_places(count, size[axis], step) for axis, count in enumerate(data.shape[1::-1])))
    own = read_at(np.rint(down), np.rint(across), data, 1.0 / depth, surface)
    sums = [np.zeros_like(own[0]), np.zeros_like(own[1])]
    for below in (0.0, 1.0):
        for right in (0.0, 1.0):
            y, x = np.floor(down) + below, np.floor(across) + right
            numbers, nearness, object_of = read_at(y, x, data, 1.0 / depth, surface)
            fits = (object_of == own[2]) & (np.abs(nearness - own[1]) < SAME * own[1])
            weight = fits * nearness * (1.0 - np.abs(down - y))[..., None] * (1.0 - np.abs(across - x))[..., None]
            sums[0] += weight * numbers
            sums[1] += weight
    return np.where(sums[1] > 0.0, sums[0] / np.maximum(sums[1], 1e-30), own[0]).astype(np.float32)


def find_places(count: int, made: int, step: int) -> Array:
    """Where the middles of pixels lie in the sample, counted from the middle of its first pixel."""
    return np.clip((np.arange(made) * step + step // 2 + 0.5) * count / (made * step) - 0.5, 0.0, count - 1.0)


def read_at(down: Array, across: Array, *layers: Array) -> list[Array]:
    """The pixels of layers at whole places, those of the border outside of it."""
    rows, columns = down.astype(int), across.astype(int)
    flat = (layer.reshape(*layer.shape[:2], -1).astype(np.float64) for layer in layers)
    return [layer[np.minimum(rows, layer.shape[0] - 1), np.minimum(columns, layer.shape[1] - 1)] for layer in flat]
