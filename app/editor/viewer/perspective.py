"""Places in the world as a camera sees them on the picture, and back."""

from __future__ import annotations

import math

from halation.nodes import CameraModel

Place = tuple[float, float, float]
ProjectedPoint = tuple[float, float, float]
"""A fraction of the picture, and the depth."""


def project(camera: CameraModel, place: Place) -> ProjectedPoint | None:
    """Where a place is on the picture, and its depth; None for what is not in front of the camera."""
    try:
        u, v, depth = camera.project(place)
    except ZeroDivisionError:
        return None
    return (u, v, depth) if depth > 0.0 and math.isfinite(u) and math.isfinite(v) else None


def unproject(camera: CameraModel, u: float, v: float, depth: float) -> Place:
    """The place in the world of a point of the picture at a depth."""
    rows, homogeneous_point = camera.inverse, (u * depth, v * depth, depth, 1.0)
    x, y, z = (
        neat(sum(part * number for part, number in zip(rows[at : at + 4], homogeneous_point, strict=True)))
        for at in (0, 4, 8)
    )
    return x, y, z


def move_place(place: Place, way: Place, far: float) -> Place:
    """So many lengths of a way from a place."""
    x, y, z = (at + far * part for at, part in zip(place, way, strict=True))
    return x, y, z


def dot(first: Place, second: Place) -> float:
    """How far one goes along the other, times that one's length."""
    return sum(a * b for a, b in zip(first, second, strict=True))


def unit(way: Place, otherwise: Place = (0.0, 0.0, -1.0)) -> Place:
    """The same way with a length of 1."""
    length = math.hypot(*way)
    return move_place((0.0, 0.0, 0.0), way, 1.0 / length) if length > 0.0 and math.isfinite(length) else otherwise


def neat(number: float) -> float:
    """With as many digits as matter, and no more than five behind the point."""
    return round(float(f"{number:.7g}"), 5)
