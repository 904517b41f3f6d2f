"""The sun dome: a disk of all directions of sunlight, in camera space.

Light from the middle comes from the camera, half way out from the side, at the rim from straight ahead.
"""

from __future__ import annotations

import math

from halation.nodes import CameraModel

from .geometry import Point, Sight
from .perspective import Place, dot, move_place, unit

RADIUS, MARGIN = 46.0, 14.0
"""The radius of the disk and its margin to the corner, at UI scale 1."""


def middle_of(sight: Sight, scale: float) -> Point:
    """The center of the disk: in the lower right corner of the panel."""
    right, bottom = (sight.origin[i] + sight.panel[i] / sight.density for i in (0, 1))
    return right - (RADIUS + MARGIN) * scale, bottom - (RADIUS + MARGIN) * scale


def knob_of(sight: Sight, scale: float, camera: CameraModel, direction: Place) -> Point:
    """The point of the disk for a direction of sunlight."""
    x, y = flat(camera, direction)
    middle = middle_of(sight, scale)
    return middle[0] + x * RADIUS * scale, middle[1] + y * RADIUS * scale


def direction_at(sight: Sight, scale: float, camera: CameraModel, at: Point) -> Place:
    """The direction of sunlight for a point of the disk."""
    middle = middle_of(sight, scale)
    return direction_of(camera, ((at[0] - middle[0]) / (RADIUS * scale), (at[1] - middle[1]) / (RADIUS * scale)))


def flat(camera: CameraModel, direction: Place) -> Point:
    """A direction on a disk of radius 1: the distance from the center is the angle from the camera."""
    aim = unit(direction)
    x, y = -dot(camera.right, aim), -dot(camera.down, aim)
    out, away = math.hypot(x, y), math.acos(min(max(dot(camera.forward, aim), -1.0), 1.0)) / math.pi
    return (x / out * away, y / out * away) if out > 1e-9 else (away, 0.0)


def direction_of(camera: CameraModel, flat: Point) -> Place:
    """The unit vector of sunlight for a point of a disk of radius 1."""
    out = math.hypot(*flat)
    angle = min(out, 1.0) * math.pi
    x, y = (part / out * math.sin(angle) for part in flat) if out > 0.0 else (0.0, 0.0)
    vector = move_place((0.0, 0.0, 0.0), camera.right, -x)
    vector = move_place(move_place(vector, camera.down, -y), camera.forward, math.cos(angle))
    first, second, third = (round(part, 5) for part in unit(vector))
    return first, second, third
