"""Metal eyes in round sockets, and boxes with sides narrower than two pixels, as filtered layers of a render."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from halation.nodes import CameraModel, look_at

Array = np.ndarray

WIDTH, HEIGHT, SAMPLES = 104, 76, 5
CAMERA = look_at((-0.3, -5.0, 1.9), (0.3, 0.5, 0.8), (1.45, 1.45 * WIDTH / HEIGHT))
FLOOR, HEAD, EYES, STEEL, PLASTIC, WALL = range(1, 7)
GOLD = (0.75, 0.55, 0.25)
COLORS = np.array([(0.0,) * 3, (0.7, 0.6, 0.5), GOLD, GOLD, (0.35, 0.5, 0.8), (0.8, 0.2, 0.15), (0.5,) * 3])
METAL = np.array([0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0])
LEFT, RIGHT = np.array([-0.55, -0.88, 1.2]), np.array([0.15, -0.86, 1.1])


@dataclass(frozen=True)
class Samples:
    """What each sample sees: which thing, its normal and its depth, [HEIGHT * SAMPLES, WIDTH * SAMPLES]."""

    thing: Array
    normal: Array
    depth: Array


def distance_to_box(places: Array, center: tuple[float, ...], half: tuple[float, ...], turn: float) -> Array:
    away, cosine, sine = places - center, np.cos(turn), np.sin(turn)
    x, y, z = np.moveaxis(away, -1, 0)
    out = np.abs(np.stack([cosine * x + sine * y, cosine * y - sine * x, z], axis=-1)) - half
    return np.linalg.norm(np.maximum(out, 0.0), axis=-1) + np.minimum(out.max(axis=-1), 0.0)


def carve(thing: Array, hole: Array, round_by: float) -> Array:
    """The distance to a thing without a hole, whose rim is rounded."""
    part = np.clip(0.5 + 0.5 * (thing + hole) / round_by, 0.0, 1.0)
    return thing * part - hole * (1.0 - part) + round_by * part * (1.0 - part)


def distances(places: Array) -> Array:
    """The distance of each place to each thing, in the order of their numbers."""
    from_eyes = [np.linalg.norm(places - eye, axis=-1) for eye in (LEFT, RIGHT)]
    head = np.linalg.norm(places - (-0.3, 0.0, 1.0), axis=-1) - 1.0
    for away in from_eyes:
        head = carve(head, away - 0.3, 0.08)
    eyes = np.minimum(from_eyes[0] - 0.24, from_eyes[1] - 0.25)
    steel = distance_to_box(places, (1.45, 0.3, 0.5), (0.5, 0.5, 0.5), 0.26)
    plastic = distance_to_box(places, (1.2, -1.6, 0.2), (0.2, 0.3, 0.2), -0.17)
    return np.stack([places[..., 2], head, eyes, steel, plastic, 3.0 - places[..., 1]])


def see(camera: CameraModel) -> Samples:
    """Every sample, by steps as long as the nearest thing is away (Hart 1996)."""
    width, height = WIDTH * SAMPLES, HEIGHT * SAMPLES
    rows = np.reshape(camera.rows, (3, 4))
    eye = -np.linalg.solve(rows[:, :3], rows[:, 3])
    y, x = np.mgrid[:height, :width] + 0.5
    rays = (np.stack([x / width, y / height, np.ones_like(x)], axis=-1) @ np.linalg.inv(rows[:, :3]).T).reshape(-1, 3)
    size = np.linalg.norm(rays, axis=-1)
    rays, way, moving = rays / size[:, None], np.ones(len(rays)), np.arange(len(rays))
    while len(moving):
        near = distances(eye + way[moving, None] * rays[moving]).min(axis=0)
        way[moving] += 0.9 * near
        moving = moving[(near > 1e-4) & (way[moving] < 30.0)]
    places = eye + way[:, None] * rays
    thing, hit = distances(places).argmin(axis=0), way < 30.0
    normal = np.zeros_like(places)
    for axis, step in enumerate(1e-5 * np.eye(3)):
        ahead, behind = (np.take_along_axis(distances(places + each), thing[None], 0)[0] for each in (step, -step))
        normal[:, axis] = (ahead - behind) * hit
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-30)
    shape = (height, width)
    depth = np.where(hit, way / size, 1e10)
    return Samples(((thing + 1) * hit).reshape(shape), normal.reshape(*shape, 3), depth.reshape(shape))


def by_pixel(samples: Array) -> Array:
    """[HEIGHT, WIDTH, samples, ...]: the samples of each pixel."""
    blocks = samples.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, -1).swapaxes(1, 2).reshape(HEIGHT, WIDTH, SAMPLES**2, -1)
    return blocks if samples.ndim > 2 else blocks[..., 0]
