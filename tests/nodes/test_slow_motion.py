"""Slow motion of antialiased layers against the mean over many moments, sampled 12 x 12 times a pixel, and Cycles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.nodes.lens.motion_blur import MotionBlur
from scipy.ndimage import binary_dilation, binary_erosion, correlate1d
from scipy.signal.windows import blackmanharris

Array = np.ndarray

DATA = Path(__file__).parents[1] / "data/blender_slow.npz"

WIDTH, HEIGHT, SAMPLES, MOMENTS = 96, 72, 12, 24
FILTER = blackmanharris(19)
BALL, SKY = np.array([0.5, 0.06, 0.05]), np.array([0.5, 0.6, 0.8])


def cover(x: float, y: float) -> Array:
    """How much of each pixel a ball covers, by the filter of Cycles: Blackman and Harris, 1.5 pixels wide."""
    down, across = np.mgrid[: HEIGHT * SAMPLES, : WIDTH * SAMPLES] / SAMPLES
    inside = (np.hypot(across - x, down - y) < 24.3) * 1.0
    for axis in (0, 1):
        inside = correlate1d(inside, FILTER / FILTER.sum(), axis)
    return inside[SAMPLES // 2 :: SAMPLES, SAMPLES // 2 :: SAMPLES]


def decibels(image: Array, expected: Array, where: Array) -> float:
    return float(-10.0 * np.log10(((image - expected)[where] ** 2).mean()))


@pytest.mark.parametrize(
    ("across", "down"),
    [(8.0, 0.0), (12.0, 0.0), (9.6, -7.2), (5.7, 5.7)],
    ids=["4 pixels right", "6 pixels right", "6 pixels up", "4 pixels down"],
)
def test_a_slow_ball_before_the_sky_has_no_dotted_ring(run, across, down):
    """As Cycles writes it: vectors leave the sky out, so a pixel that the ball touches has all of its motion."""
    x, y, way = 47.2, 35.6, np.array([across, down])
    share, moments = cover(x, y), (np.arange(MOMENTS) + 0.5) / MOMENTS - 0.5
    rows, columns = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    depth = np.where(np.hypot(columns - x, rows - y) < 24.3, 5.0, 1e10)
    image = np.dstack([share[..., None] * BALL + (1.0 - share[..., None]) * SKY, np.ones_like(share)])
    velocity = np.where((share > 0.0)[..., None], np.float32([*way, *way]), np.float32(0.0))
    blurred = np.mean([cover(*(np.array([x, y]) + 0.5 * time * way)) for time in moments], 0)[..., None]
    expected = blurred * BALL + (1.0 - blurred) * SKY
    light = run(MotionBlur(max_length=0.5), {"image": image, "velocity": velocity, "depth": depth})[..., :3]
    edge = binary_dilation((blurred > 0.0) & (blurred < 1.0), iterations=1)[..., 0]
    assert decibels(light, expected, np.ones_like(edge)) > 46.0
    assert decibels(light, expected, edge) > 37.3


@pytest.mark.parametrize("pixels", [2, 6])
def test_slow_motion_is_nearer_to_cycles_than_vector_blur_is(run, pixels):
    """From the same layers, over all and in a band around the edge of the ball: tests/data/make_blender_slow.py."""
    names = ("image", "cycles", "vector_blur", "vector", "depth")
    image, cycles, vector_blur, vector, depth = (np.load(DATA)[f"{name}_{pixels}"].astype(np.float32) for name in names)
    velocity = vector * np.float32([-1.0, 1.0, -1.0, 1.0])
    inputs = {"image": np.dstack([image, np.ones_like(depth)]), "velocity": velocity, "depth": depth}
    light = run(MotionBlur(), inputs)[..., :3]
    moves = np.abs(vector).max(axis=2) > 0.1
    band = binary_dilation(moves, iterations=3) & ~binary_erosion(moves, iterations=3)
    for where, least in ((np.ones_like(moves), 45.0), (band, 39.0)):
        own, other = (decibels(picture, cycles, where) for picture in (light, vector_blur))
        assert own > least and own > other + 1.0
