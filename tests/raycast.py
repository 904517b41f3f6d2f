"""A small scene seen through any camera, in double precision: a floor, a wall, a sphere, and sky above them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from halation.nodes import CameraModel

Array = np.ndarray
CENTER, RADIUS = np.array([0.6, 2.0, 1.0]), 1.0
WALL, TOP = 6.0, 3.0


@dataclass(frozen=True)
class RaycastImage:
    """What every pixel shows; `hit` is False where there is only sky, and everything else is 0 there."""

    position: Array
    normal: Array
    depth: Array
    distance: Array
    hit: Array


def cast_rays(camera: CameraModel, width: int, height: int) -> RaycastImage:
    """Through the middle of every pixel."""
    rows = np.reshape(camera.rows, (3, 4))
    eye = -np.linalg.solve(rows[:, :3], rows[:, 3])
    y, x = np.mgrid[0:height, 0:width] + 0.5
    sides = np.stack([x / width, y / height, np.ones_like(x)], axis=-1)
    rays = np.linalg.solve(rows[:, :3], sides[..., None])[..., 0]  # to planar depth 1
    with np.errstate(divide="ignore", invalid="ignore"):
        floor = -eye[2] / rays[..., 2]
        wall = (WALL - eye[1]) / rays[..., 1]
        wall = np.where(eye[2] + wall * rays[..., 2] < TOP, wall, np.inf)
        floor = np.where(eye[1] + floor * rays[..., 1] < WALL, floor, np.inf)
        away = eye - CENTER
        a, b, c = (rays**2).sum(-1), rays @ away, away @ away - RADIUS**2
        ball = (-b - np.sqrt(b * b - a * c)) / a
    steps = np.stack([np.where(step > 0.0, step, np.inf) for step in (floor, wall, np.nan_to_num(ball, nan=np.inf))])
    first, depth = steps.argmin(axis=0), steps.min(axis=0)
    hit = np.isfinite(depth)
    depth = np.where(hit, depth, 0.0)
    position = np.where(hit[..., None], eye + depth[..., None] * rays, 0.0)
    faces = np.where((first == 0)[..., None], (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))
    normal = np.where((first == 2)[..., None], (position - CENTER) / RADIUS, faces) * hit[..., None]
    return RaycastImage(position, normal, depth, np.where(hit, np.linalg.norm(position - eye, axis=-1), 0.0), hit)
