"""Reflections where a normal turns within a pixel, as a renderer filters it: against 16 x 16 shaded places in each."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import look_at
from halation.nodes.light.image_based_light import ImageBasedLight
from lighting_formulas import Array, dot, unit

SIZE, PLACES = 40, 16
CAMERA = look_at((0.0, -1e4, 0.0), (0.0, 0.0, 0.0), (1e5, 1e5))
"""From so far away that all pixels are seen from the same direction."""

VIEW = np.array([0.0, -1.0, 0.0])
SUNS = ((0.4, -0.8, 0.5), (-0.7, -0.7, 0.1), (0.1, -0.4, -0.8), (0.3, -0.9, 0.09), (-0.8, -0.5, -0.25))


def pipes(x: Array, y: Array, radius: float) -> Array:
    """Half pipes side by side, turned a little."""
    c, s = np.cos(0.3), np.sin(0.3)
    across = np.clip(((x * c + y * s) / radius + 1.0) % 2.0 - 1.0, -0.999, 0.999)
    return np.stack([across * c, across * s, np.sqrt(1.0 - across**2)], -1)


def bumps(x: Array, y: Array, radius: float) -> Array:
    """A wavy surface."""
    slope = [0.8 * np.cos(2.0 * x / radius + np.sin(y / radius)), 0.8 * np.sin(2.3 * y / radius + 0.7 * x / radius)]
    return unit(np.stack([-slope[0], -slope[1], np.ones_like(x)], -1))


def sample(shape, radius: float) -> tuple[Array, Array]:
    """The normals at many places in each pixel, and filtered over pixels."""
    at = (np.arange(SIZE * PLACES) + 0.5) / PLACES - SIZE / 2
    fine = shape(*np.meshgrid(at, -at), radius)
    fine = to_world(fine)
    return fine, filtered(fine)


def to_world(way: Array) -> Array:
    """From right, up and toward the eye to the axes of the world."""
    return np.stack([way[..., 0], -way[..., 2], way[..., 1]], -1)


def filtered(fine: Array) -> Array:
    return fine.reshape(SIZE, PLACES, SIZE, PLACES, -1).mean((1, 3))


def rms(error: Array) -> float:
    """Without the rim, whose neighbors are not known."""
    return float(np.sqrt((error[2:-2, 2:-2] ** 2).mean()))


def sky(way: Array) -> Array:
    """Soft boxes in the dark."""
    boxes = [np.exp(-((1.0 - way @ unit(np.array(sun))) / 0.03)) for sun in SUNS]
    return 0.1 + sum(boxes)[..., None] * np.array([1.0, 1.0, 1.0])


def look_around(width: int, height: int) -> Array:
    """A picture of the sky by longitude and latitude, z up."""
    v, u = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    around, below = (0.5 - u) * 2 * np.pi, v * np.pi
    way = np.stack([np.sin(below) * np.cos(around), np.sin(below) * np.sin(around), np.cos(below)], -1)
    return np.dstack([sky(way), np.ones((height, width))]).astype(np.float32)


def mirror(run, normal: Array) -> Array:
    """What a white metal without roughness mirrors."""
    inputs = {"albedo": np.ones((SIZE, SIZE, 4)), "normal": normal, "environment": look_around(2048, 1024)}
    inputs |= {"metallic": np.ones((SIZE, SIZE)), "roughness": np.zeros((SIZE, SIZE)), "camera": CAMERA}
    return run(ImageBasedLight(), inputs, output="reflection")[..., :1]


@pytest.mark.parametrize(("shape", "radius", "part"), [(pipes, 5.0, 0.4), (pipes, 10.0, 0.4), (bumps, 5.0, 0.6)])
def test_mirrors_show_the_mean_over_the_pixel(run, shape, radius, part):
    """With so much of the error of a pixel that is shaded with one normal."""
    fine, normal = sample(shape, radius)
    expected = filtered(sky(2.0 * dot(fine, VIEW) * fine - VIEW))[..., :1]
    alone = sky(2.0 * dot(unit(normal), VIEW) * unit(normal) - VIEW)[..., :1]
    found = mirror(run, normal)
    assert rms(found - expected) < part * rms(alone - expected)


def test_normals_of_length_one_do_not_turn(run):
    """As without antialiasing: the pixel shows what its one normal mirrors."""
    _, normal = sample(bumps, 10.0)
    found, alone = mirror(run, unit(normal)), sky(2.0 * dot(unit(normal), VIEW) * unit(normal) - VIEW)[..., :1]
    assert rms(found - alone) < 0.01 < 0.5 * rms(mirror(run, normal) - alone)
