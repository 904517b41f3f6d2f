"""Projections of panoramas. Directions have x to the front, y to the left and z up."""

from __future__ import annotations

import numpy as np

from .pixels import Array, length
from .places import bilinear, grid, pixels_at

WIDEST_ANGLES = {"fisheye": 2.0 * np.pi, "little planet": np.radians(350.0), "perspective": np.radians(170.0)}
"""The largest angles of view: little planets and perspective views end before infinity."""

QUARTERS_HIGH = {"lat-long": 2.0, "cube strip": 1.0, "cube cross": 3.0, "mirror ball": 2.0}
"""The height of pictures that show all directions, in quarter turns."""

WIDTHS_OF_PANORAMAS = {"lat-long": 2.0, "cube strip": 6.0, "cube cross": 4.0 / 3.0}
"""Width over height of pictures that are no squares."""

CROSS_CELLS = np.array([(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)])
"""The cells of the faces right, left, up, down, front and back in a cube cross."""

FACES_OF_CROSS = np.array([[-1, 2, -1, -1], [1, 4, 0, 5], [-1, 3, -1, -1]])
"""The faces in the cells of a cube cross, row by row; -1 are empty."""


def vectors(x: Array, y: Array, z: Array) -> Array:
    """Three Arrays [...] as vectors [..., 3]."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def limit_angle(projection: str, angle: float) -> float:
    """The angle that a picture shows at most."""
    return min(angle, WIDEST_ANGLES.get(projection, 2.0 * np.pi))


def quarters_of(projection: str, angle: float) -> float:
    """How many quarter turns lie in the height of a picture, at the scale of the middle of a perspective view."""
    angle = limit_angle(projection, angle)
    if projection == "perspective":
        return 4.0 * np.tan(angle / 2.0) / np.pi
    return QUARTERS_HIGH.get(projection, angle / (np.pi / 2.0))


def panorama_size(
    height: int, source: str, source_angle: float, target: str, angle: float, aspect: float, scale: float
) -> tuple[int, int]:
    """The width and height of a result with as many pixels per quarter turn as the picture, and even sides."""
    quarter = scale * height / quarters_of(source, source_angle)
    if target in ("cube strip", "cube cross"):
        quarter = max(2.0 * round(quarter / 2.0), 2.0)  # faces are whole pixels
    down = quarter * quarters_of(target, angle)
    across = down * (aspect if target == "perspective" else WIDTHS_OF_PANORAMAS.get(target, 1.0))
    return 2 * round(across / 2.0) or 1, 2 * round(down / 2.0) or 1


def make_view_axes(yaw: float, pitch: float, roll: float) -> Array:
    """The matrix whose columns are the front, the left and the top of the view in the panorama."""
    cy, sy, cp, sp, cr, sr = (part(angle) for angle in (yaw, pitch, roll) for part in (np.cos, np.sin))
    front, left, top = np.array([cp * cy, -cp * sy, sp]), np.array([sy, cy, 0.0]), np.array([-sp * cy, sp * sy, cp])
    return np.stack([front, cr * left + sr * top, cr * top - sr * left], axis=-1)


def way_of_face(face: Array, p: Array) -> Array:
    """The direction of a place on the face of a cube, from -1 to 1, right and down, as seen from inside."""
    x, y, one = p[..., 0], p[..., 1], np.ones_like(p[..., 0])
    ways = [vectors(-x, -one, -y), vectors(x, one, -y), vectors(y, -x, one), vectors(-y, -x, -one)]
    ways += [vectors(one, -x, -y), vectors(-one, x, -y)]
    return np.take_along_axis(np.stack(ways), face[None, ..., None], axis=0)[0]


def face_of_way(way: Array) -> tuple[Array, Array]:
    """The face that a direction meets, and where: the inverse."""
    size = np.abs(way)
    far = size.max(axis=-1)
    x, y, z = np.moveaxis(way / np.where(far > 0.0, far, 1.0)[..., None], -1, 0)
    is_level, is_ahead = size[..., 2] == far, size[..., 0] == far
    up = vectors(-y, np.where(z > 0.0, x, -x), np.where(z > 0.0, 2, 3))
    ahead = vectors(np.where(x > 0.0, -y, y), -z, np.where(x > 0.0, 4, 5))
    beside = vectors(np.where(y > 0.0, x, -x), -z, np.where(y > 0.0, 1, 0))
    met = np.where(is_level[..., None], up, np.where(is_ahead[..., None], ahead, beside))
    return met[..., 2].astype(int), met[..., :2]


def face_corner(face: Array, projection: str, side: Array) -> Array:
    """The left top corner of a face."""
    strip = np.stack([face, np.zeros_like(face)], axis=-1)
    return side * (strip if projection == "cube strip" else CROSS_CELLS[face])


def face_side(projection: str, size: Array) -> Array:
    """Width and height of a face in pixels."""
    return size / (np.array([6.0, 1.0]) if projection == "cube strip" else np.array([4.0, 3.0]))


def angles_from_middle(far: Array, projection: str, angle: float) -> Array:
    """How far a round picture shows from its middle, by the distance in half heights."""
    if projection == "fisheye":
        return 0.5 * angle * far
    if projection == "mirror ball":
        return 2.0 * np.arcsin(np.minimum(far, 1.0))
    return 2.0 * np.arctan(far * np.tan(0.25 * angle))


def distances_from_middle(away: Array, projection: str, angle: float) -> Array:
    """The distance in half heights at which a picture shows an angle: the inverse, also for perspective views."""
    if projection == "fisheye":
        return 2.0 * away / angle
    if projection == "mirror ball":
        return np.sin(0.5 * away)
    if projection == "perspective":
        return np.tan(away) / np.tan(0.5 * angle)
    return np.tan(np.minimum(0.5 * away, 1.57)) / np.tan(0.25 * angle)


def way_in_picture(at: Array, size: Array, projection: str, angle: float) -> Array:
    """The direction of a place in a picture; 0 where there is none."""
    if projection == "lat-long":
        longitude, below = (0.5 - at[..., 0] / size[0]) * 2.0 * np.pi, at[..., 1] / size[1] * np.pi
        return vectors(np.sin(below) * np.cos(longitude), np.sin(below) * np.sin(longitude), np.cos(below))
    if projection in ("cube strip", "cube cross"):
        side = face_side(projection, size)
        cell = np.floor(at / side).astype(int)
        face = np.clip(cell[..., 0], 0, 5)
        if projection == "cube cross":
            face = FACES_OF_CROSS[np.clip(cell[..., 1], 0, 2), np.clip(cell[..., 0], 0, 3)]
        known = np.maximum(face, 0)
        way = way_of_face(known, 2.0 * (at - face_corner(known, projection, side)) / side - 1.0)
        return np.where((face >= 0)[..., None], way / length(way), 0.0)
    p = (2.0 * at - size) / size[1]
    far = length(p)[..., 0]
    if projection == "perspective":
        aside = -p * np.tan(0.5 * angle)
        way = vectors(np.ones_like(far), aside[..., 0], aside[..., 1])
        return way / length(way)
    away = angles_from_middle(far, projection, angle)
    aside = -np.sin(away)[..., None] * p / np.where(far > 0.0, far, 1.0)[..., None]
    if projection == "little planet":  # it looks down, its top is the front
        return vectors(aside[..., 1], aside[..., 0], -np.cos(away))
    return np.where((far <= 1.0)[..., None], vectors(np.cos(away), aside[..., 0], aside[..., 1]), 0.0)


def place_in_picture(way: Array, size: Array, projection: str, angle: float) -> tuple[Array, Array]:
    """The place of a direction in a picture, and whether it is shown there."""
    shown = np.ones(way.shape[:-1], bool)
    if projection == "lat-long":
        longitude, below = np.arctan2(way[..., 1], way[..., 0]), np.arccos(np.clip(way[..., 2], -1.0, 1.0))
        return np.stack([(0.5 - longitude / (2.0 * np.pi)) % 1.0, below / np.pi], axis=-1) * size, shown
    if projection in ("cube strip", "cube cross"):
        side = face_side(projection, size)
        face, p = face_of_way(way)
        return face_corner(face, projection, side) + side * (0.5 + 0.5 * p), shown
    if projection == "little planet":
        way = vectors(-way[..., 2], way[..., 1], way[..., 0])
    away, across = np.arccos(np.clip(way[..., 0], -1.0, 1.0)), length(way[..., 1:])
    if projection == "perspective":
        shown &= way[..., 0] >= 1e-4
    far = distances_from_middle(np.where(shown, away, 0.0), projection, angle)
    toward = -way[..., 1:] / np.where(across > 0.0, across, 1.0)
    at = 0.5 * size + 0.5 * size[1] * toward * far[..., None]
    return at, shown & np.all((at >= 0.0) & (at <= size), axis=-1)


def pixels_to_a_radian(way: Array, size: Array, projection: str, angle: float) -> Array:
    """Around a direction of a picture."""
    near = np.abs(way).max(axis=-1)
    if projection in ("cube strip", "cube cross"):
        return 0.5 * face_side(projection, size)[1] / np.maximum(near * near, 1e-12)
    if projection == "perspective":
        return 0.5 * size[1] / (np.tan(0.5 * angle) * np.maximum(way[..., 0] ** 2, 1e-4))
    if projection == "little planet":
        return 0.5 * size[1] / (np.tan(0.25 * angle) * np.maximum(1.0 - way[..., 2], 1e-4))
    return {"lat-long": 1.0 / np.pi, "fisheye": 1.0 / angle}.get(projection, 0.25) * size[1] * np.ones_like(near)


def pixel_of_cube(image: Array, at: Array, corner: Array, face: Array, projection: str) -> Array:
    """A pixel at or next to a face: beyond its side lies the face that joins there, not the neighbor in the file."""
    size = np.array(image.shape[1::-1])
    side = face_side(projection, size)
    on = (at + 0.5 - corner) / side
    is_inside = np.all((on >= 0.0) & (on <= 1.0), axis=-1)
    beside, p = face_of_way(way_of_face(face, 2.0 * on - 1.0))
    other = face_corner(beside, projection, side) + np.clip(side * (0.5 + 0.5 * p), 0.5, side - 0.5)
    at = np.where(is_inside[..., None], at, np.floor(other)).astype(int)
    return pixels_at(image, at[..., 0], at[..., 1])


def light_from(image: Array, way: Array, projection: str, angle: float) -> Array:
    """The picture in directions [..., 3], interpolated; empty where it shows nothing."""
    size = np.array(image.shape[1::-1])
    at, shown = place_in_picture(way, size, projection, angle)
    if projection == "lat-long":  # it goes on around the world, and across a pole on its other side
        half = image.shape[1] // 2
        above, below = np.roll(image[:1], -half, axis=1), np.roll(image[-1:], -half, axis=1)
        return bilinear(np.concatenate([above, image, below]), at + np.array([0.0, 1.0]), "wrap")
    if projection not in ("cube strip", "cube cross"):
        return np.where(shown[..., None], bilinear(image, np.where(shown[..., None], at, 0.0)), 0.0)
    face, _ = face_of_way(way)
    corner = face_corner(face, projection, face_side(projection, size))
    low = np.floor(at - 0.5)
    across, down = np.moveaxis(at - 0.5 - low, -1, 0)[..., None]
    corners = [pixel_of_cube(image, low + step, corner, face, projection) for step in ((0, 0), (1, 0), (0, 1), (1, 1))]
    upper = (1.0 - across) * corners[0] + across * corners[1]
    return (1.0 - down) * upper + down * ((1.0 - across) * corners[2] + across * corners[3])


def panorama(
    image: Array,
    source: str,
    source_angle: float,
    target: str,
    angle: float,
    yaw: float,
    pitch: float,
    roll: float,
    aspect: float,
    scale: float,
) -> Array:
    """A panorama in another projection; a pixel that covers several is the mean of n x n samples."""
    width, height = panorama_size(image.shape[0], source, source_angle, target, angle, aspect, scale)
    source_angle, angle = limit_angle(source, source_angle), limit_angle(target, angle)
    turn, size, own_size = make_view_axes(yaw, pitch, roll), np.array([width, height]), np.array(image.shape[1::-1])
    at, x, y = grid(width, height), np.array([0.25, 0.0]), np.array([0.0, 0.25])
    spans = [
        length(way_in_picture(at + part, size, target, angle) - way_in_picture(at - part, size, target, angle))[..., 0]
        for part in (x, y)  # quarters of a pixel: at half a pixel lies the next face of a cube
    ]
    middle = way_in_picture(at, size, target, angle) @ turn.T
    density = 2.0 * pixels_to_a_radian(middle, own_size, source, source_angle)
    counts = np.ceil(np.clip(density * np.max(spans, axis=0) - 0.01, 1.0, 8.0))
    result = np.zeros((height, width, 4))
    for n in np.unique(counts).astype(int):
        here = counts == n
        for i in range(n * n):
            offset = (np.array([i % n, i // n]) + 0.5) / n - 0.5
            way = way_in_picture(at[here] + offset, size, target, angle)
            light = light_from(image, way @ turn.T, source, source_angle)
            result[here] += np.where(np.any(way != 0.0, axis=-1)[..., None], light, 0.0) / (n * n)
    return result
