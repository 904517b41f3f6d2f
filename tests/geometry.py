"""What the proofs of geometry share: cameras, the rays through their pixels, and the sample's own layers."""

from __future__ import annotations

from functools import cache

import numpy as np
from halation import media
from halation.nodes import CameraModel, Kind, look_at
from halation.presets import sample
from halation.resources.sandbox import UNRESTRICTED

Array = np.ndarray

CAMERA = look_at((3.0, -7.0, 2.5), (0.4, 0.3, 1.1), (1.3, 2.2))

_WIDTHS = {"Depth": 1, "Object Index": 1, "Position": 3, "Normal": 3, "Vector": 4}


def places(width: int, height: int) -> Array:
    """u and v of every pixel's middle: [h, w, 2]."""
    v, u = np.mgrid[:height, :width]
    return np.dstack([(u + 0.5) / width, (v + 0.5) / height])


def rays(camera: CameraModel, width: int, height: int) -> Array:
    """From the eye to what lies one unit deep, by numpy's inverse of the matrix: [h, w, 3]."""
    matrix = np.reshape(camera.rows, (3, 4))[:, :3]
    seen = np.dstack([places(width, height), np.ones((height, width))])
    return seen @ np.linalg.inv(matrix).T


@cache
def sample_layer(name: str) -> Array:
    """A layer of data of the sample frame."""
    width = _WIDTHS[name]
    return media.read_layer(
        sample(), name, Kind.VECTOR if width > 1 else Kind.FIELD, width, sandbox=UNRESTRICTED
    ).array.astype(np.float32)


@cache
def sample_camera() -> CameraModel:
    """The camera of the sample, from its positions and depth by linear least squares."""
    depth, position = sample_layer("Depth")[..., 0].astype(float), sample_layer("Position").astype(float)
    there = depth < 1e9
    height, width = depth.shape
    world = np.column_stack([position[there], np.ones(there.sum())])
    seen = np.dstack([places(width, height), np.ones((height, width))])[there] * depth[there, None]
    return CameraModel(tuple(np.linalg.lstsq(world, seen, rcond=None)[0].T.ravel().tolist()))


def ball(camera: CameraModel, center: tuple[float, ...], radius: float, width: int, height: int) -> dict[str, Array]:
    """Depth, normal and position of a ball, by casting rays; background as renderers write it."""
    ray, eye = rays(camera, width, height), np.array(camera.eye)
    # |eye + depth ray - center|^2 = radius^2
    a, b = (ray * ray).sum(2), ray @ (eye - np.array(center))
    root = b * b - a * (np.sum((eye - np.array(center)) ** 2) - radius**2)
    there = root > 0.0
    depth = np.where(there, (-b - np.sqrt(np.maximum(root, 0.0))) / a, 1e10)
    position = np.where(there[..., None], eye + depth[..., None] * ray, 0.0)
    normal = np.where(there[..., None], (position - np.array(center)) / radius, 0.0)
    return {"depth": depth, "position": position, "normal": normal}
