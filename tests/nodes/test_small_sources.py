"""Bricks and waves against their formulas in NumPy, antialiasing against 16 x 16 samples in a pixel."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.input.brick import Brick
from halation.nodes.input.wave import Wave

WIDTH, HEIGHT, SAMPLES = 90, 60, 16


def sample_bricks(node: Brick) -> np.ndarray:
    """How much of each pixel is brick, by 16 x 16 samples."""
    y, x = (np.mgrid[: HEIGHT * SAMPLES, : WIDTH * SAMPLES] + 0.5) / SAMPLES
    x, y = x - node.offset[0], y - node.offset[1]
    row = np.floor(y / node.height)
    x = x - np.where((row % node.every == node.every - 1) & (node.every > 1), node.shift * node.width, 0.0)
    across, down = x - np.floor(x / node.width) * node.width, y - row * node.height
    half = 0.5 * node.mortar
    brick = (across > half) & (across < node.width - half) & (down > half) & (down < node.height - half)
    return brick.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES).mean((1, 3))


@pytest.mark.parametrize("values", [
    {"width": 24.0, "height": 9.0, "mortar": 2.0},
    {"width": 17.3, "height": 6.7, "mortar": 1.4, "shift": 0.31, "offset": (3.3, -4.6)},
    {"width": 20.0, "height": 8.0, "mortar": 3.0, "every": 3, "shift": 0.4},
    {"width": 12.0, "height": 12.0, "mortar": 0.5, "every": 1},
])  # fmt: skip
def test_bricks_cover_what_samples_say(run, values):
    node = Brick(**values, variety=0.0)
    share = sample_bricks(node)
    covered = run(node, size=(WIDTH, HEIGHT), output="value")[..., 0]
    # 16 samples know the place of an edge to 1/32 along each axis.
    assert np.abs(covered - share).max() < 2.0 / 32.0 + 1e-3
    assert abs(covered.mean() - share.mean()) < 4e-3
    color = 0.5 * (np.array(node.first) + node.second)
    expected = covered[..., None] * color + (1.0 - covered[..., None]) * np.array(node.joint)
    np.testing.assert_allclose(run(node, size=(WIDTH, HEIGHT)), expected, atol=1e-5)


def test_each_brick_has_a_color_of_its_own(run):
    node = Brick(width=15.0, height=10.0, mortar=0.0, every=1, first=(0.0, 0.0, 0.0, 1.0), second=(1.0, 1.0, 1.0, 1.0))
    random = run(node, size=(WIDTH, HEIGHT), output="random")[..., 0].reshape(6, 10, 6, 15)
    assert np.ptp(random, (1, 3)).max() == 0.0
    colors = random.mean((1, 3)).ravel()
    assert len({*colors.tolist()}) == 36 and 0.35 < colors.mean() < 0.65
    np.testing.assert_allclose(run(node, size=(WIDTH, HEIGHT))[..., 0], random.reshape(HEIGHT, WIDTH), atol=1e-6)


PROFILES = {
    "sine": lambda t: 0.5 - 0.5 * np.cos(2.0 * np.pi * t),
    "triangle": lambda t: 1.0 - np.abs(2.0 * t - 1.0),
    "saw": lambda t: t,
    "square": lambda t: (t >= 0.5).astype(float),
}


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("pattern", ["bands", "rings"])
def test_waves_are_their_formula(run, profile, pattern):
    node = Wave(profile=profile, pattern=pattern, wavelength=23.7, angle=31.0, phase=0.3, center=(0.4, 0.6))
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    x, y, angle = x - 0.4 * WIDTH, y - 0.6 * HEIGHT, np.radians(31.0)
    turn = (np.hypot(x, y) if pattern == "rings" else x * np.cos(angle) + y * np.sin(angle)) / 23.7 - 0.3
    t = turn - np.floor(turn)
    out = run(node, size=(WIDTH, HEIGHT), output="value")[..., 0]
    sure = (np.abs(t - 0.5) > 1e-3) & (t > 1e-3) & (t < 1.0 - 1e-3)
    np.testing.assert_allclose(out[sure], PROFILES[profile](t)[sure], atol=1e-4)


def test_noise_bends_waves(run):
    straight, bent = (run(Wave(distortion=amount), size=(WIDTH, HEIGHT)) for amount in (0.0, 1.0))
    assert np.ptp(straight[..., 0], axis=0).max() == 0.0 < np.ptp(bent[..., 0], axis=0).max()
