"""Cameras: from places in the world to places in the picture, and back."""

from __future__ import annotations

import math

from msgspec import Struct
from msgspec.structs import force_setattr

Vector3 = tuple[float, float, float]


class CameraModel(Struct, frozen=True):
    """A perspective camera at one moment.

    `rows` are those of the 3 x 4 matrix that takes a place in the world (x, y, z, 1) to (u d, v d, d): u and v are
    fractions of the picture from its top left, d is the planar depth in world units, positive in front. The size of
    the picture does not matter.
    """

    rows: tuple[float, ...]

    def __post_init__(self) -> None:
        # Cameras that are equal must look the same: -0.0 == 0.0, but not to a shader. Adding 0 leaves one zero.
        force_setattr(self, "rows", tuple(part + 0 for part in self.rows))

    @property
    def eye(self) -> Vector3:
        """The position of the camera in the world."""
        x, y, z = (row[3] for row in _in_fours(self.inverse))
        return x, y, z

    @property
    def forward(self) -> Vector3:
        """The unit vector along which depth grows."""
        return _unit(self._row(2))

    @property
    def right(self) -> Vector3:
        """The unit vector toward the right edge of the picture."""
        return _unit(_without(self._row(0), self.forward))

    @property
    def down(self) -> Vector3:
        """The unit vector toward the lower edge of the picture."""
        return _unit(_without(self._row(1), self.forward))

    @property
    def focal(self) -> tuple[float, float]:
        """Focal lengths as fractions of the picture's width and height."""
        forward = self.forward
        return math.hypot(*_without(self._row(0), forward)), math.hypot(*_without(self._row(1), forward))

    @property
    def center(self) -> tuple[float, float]:
        """Where the optical axis meets the picture, as fractions of it."""
        forward = self.forward
        return _dot(self._row(0), forward), _dot(self._row(1), forward)

    @property
    def inverse(self) -> tuple[float, ...]:
        """The rows of the 3 x 4 matrix that takes (u d, v d, d, 1) to a place in the world."""
        a, b, c = (self._row(index) for index in range(3))
        columns = [_cross(b, c), _cross(c, a), _cross(a, b)]
        volume = _dot(a, columns[0])
        offsets = self.rows[3], self.rows[7], self.rows[11]
        rows: list[float] = []
        for axis in range(3):
            row = [column[axis] / volume for column in columns]
            rows += [*row, -sum(part * offset for part, offset in zip(row, offsets, strict=True))]
        return tuple(rows)

    def project(self, place: Vector3) -> Vector3:
        """u, v and depth of a place in the world. Raises ZeroDivisionError for a place in the camera's own plane."""
        u, v, depth = (_dot(self._row(index), place) + self.rows[4 * index + 3] for index in range(3))
        return u / depth, v / depth, depth

    def shift(self, x: float, y: float) -> CameraModel:
        """The same camera with the picture cut out that so far to the right and down, in fractions of it."""
        u, v, depth = _in_fours(self.rows)
        u = tuple(part - x * ahead for part, ahead in zip(u, depth, strict=True))
        v = tuple(part - y * ahead for part, ahead in zip(v, depth, strict=True))
        return CameraModel((*u, *v, *depth))

    def _row(self, index: int) -> Vector3:
        x, y, z = self.rows[4 * index : 4 * index + 3]
        return x, y, z


def read_camera(rows: tuple[float, ...]) -> CameraModel | None:
    """The camera of twelve numbers in a graph file; None where all of them are 0."""
    return CameraModel(rows) if len(rows) == 12 and any(rows) else None


def look_at(eye: Vector3, target: Vector3, focal: tuple[float, float], up: Vector3 = (0.0, 0.0, 1.0)) -> CameraModel:
    """A camera at `eye` that has `target` in the middle, with the focal lengths of `Camera.focal`."""
    forward = _unit(_minus(target, eye))
    right = _cross(forward, up)
    if math.hypot(*right) < 1e-9:  # straight up or down
        right = _cross(forward, (0.0, 1.0, 0.0))
    right = _unit(right)
    down = _cross(forward, right)
    rows: list[float] = []
    for axis, length in ((right, focal[0]), (down, focal[1])):
        row = [length * part + 0.5 * ahead for part, ahead in zip(axis, forward, strict=True)]
        rows += [*row, -sum(part * place for part, place in zip(row, eye, strict=True))]
    return CameraModel((*rows, *forward, -_dot(forward, eye)))


def orbit_camera(
    target: Vector3, distance: float, azimuth: float, elevation: float, focal: tuple[float, float]
) -> CameraModel:
    """A camera so far from its target. Angles are radians; where both are 0 it is level and looks along y."""
    away = (
        math.sin(azimuth) * math.cos(elevation) * distance,
        -math.cos(azimuth) * math.cos(elevation) * distance,
        math.sin(elevation) * distance,
    )
    x, y, z = (place + part for place, part in zip(target, away, strict=True))
    return look_at((x, y, z), target, focal)


def _in_fours(rows: tuple[float, ...]) -> tuple[tuple[float, ...], ...]:
    return rows[0:4], rows[4:8], rows[8:12]


def _dot(a: Vector3, b: Vector3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector3, b: Vector3) -> Vector3:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _minus(a: Vector3, b: Vector3) -> Vector3:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _unit(a: Vector3) -> Vector3:
    length = math.hypot(*a)
    return a[0] / length, a[1] / length, a[2] / length


def _without(a: Vector3, along: Vector3) -> Vector3:
    """The part of `a` that is at right angles to a unit vector."""
    share = _dot(a, along)
    return a[0] - share * along[0], a[1] - share * along[1], a[2] - share * along[2]
