"""A box on a floor, seen by rays of numpy."""

from __future__ import annotations

import numpy as np
from geometry import rays
from halation.nodes import look_at

SIZE = (160, 90)
LOW, HIGH = np.array([-0.5, 0.0, 0.0]), np.array([0.5, 60.0, 0.8])


def box(eye, way):
    """Where rays enter the box and leave it; the first is infinite where they miss it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = (LOW - eye) / way, (HIGH - eye) / way
    enter, leave = np.fmin(one, two).max(-1), np.fmax(one, two).min(-1)
    return np.where((enter < leave) & (leave > 1e-6), enter, np.inf), leave


def taken(eye=(0.4, -3.5, 2.2), target=(0.3, 0.3, 0.3), size=SIZE, boxed=True):
    """Depth, normals and places of the floor and the box, by numpy."""
    camera = look_at(eye, target, (1.2, 1.2 * size[0] / size[1]))
    way, eye = rays(camera, *size), np.array(eye)
    with np.errstate(divide="ignore"):
        floor = np.where(way[..., 2] < 0, -eye[2] / way[..., 2], np.inf)
    depth = np.minimum(floor, box(eye, way)[0]) if boxed else floor
    place = eye + np.where(np.isfinite(depth), depth, 0)[..., None] * way
    side = np.minimum(np.abs(place - LOW), np.abs(place - HIGH)) + (place > HIGH + 1e-6) + (place < LOW - 1e-6)
    face = np.eye(3)[side.argmin(-1)] * np.sign(place - (LOW + HIGH) / 2)
    normal = np.where((depth < floor)[..., None], face, (0.0, 0.0, 1.0)) * np.isfinite(depth)[..., None]
    return camera, np.where(np.isfinite(depth), depth, 1e10), normal, place


def dilated(mask, by=1):
    found = mask.copy()
    for y in range(-by, by + 1):
        for x in range(-by, by + 1):
            found |= np.roll(mask, (y, x), (0, 1))
    return found
