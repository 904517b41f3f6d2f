"""Projects positions in the world to the picture of a camera, and back."""

from __future__ import annotations

import math

from halation.nodes import CameraModel

Place = tuple[float, float, float]
ProjectedPoint = tuple[float, float, float]
"""A fraction of the picture, and the depth."""


def project(camera: CameraModel, place: Place) -> ProjectedPoint | None:
    """The point of the picture for a position, and its depth; None for positions behind the camera."""
    try:
        u, v, depth = camera.project(place)
    except ZeroDivisionError:
        return None
    return (u, v, depth) if depth > 0.0 and math.isfinite(u) and math.isfinite(v) else None


def unproject(camera: CameraModel, u: float, v: float, depth: float) -> Place:
    """The position in the world of a point of the picture at a depth."""
    rows, homogeneous_point = camera.inverse, (u * depth, v * depth, depth, 1.0)
    x, y, z = (
        neat(sum(part * number for part, number in zip(rows[at : at + 4], homogeneous_point, strict=True)))
        for at in (0, 4, 8)
    )
    return x, y, z


def move_place(place: Place, direction: Place, far: float) -> Place:
    """A position, moved along a vector by a factor."""
    x, y, z = (at + far * part for at, part in zip(place, direction, strict=True))
    return x, y, z


def dot(first: Place, second: Place) -> float:
    """The dot product."""
    return sum(a * b for a, b in zip(first, second, strict=True))


def unit(vector: Place, otherwise: Place = (0.0, 0.0, -1.0)) -> Place:
    """The vector, normalized."""
    length = math.hypot(*vector)
    return move_place((0.0, 0.0, 0.0), vector, 1.0 / length) if length > 0.0 and math.isfinite(length) else otherwise


def neat(number: float) -> float:
    """A position rounded to the digits that matter, at most five decimals."""
    return round(float(f"{number:.7g}"), 5)
