"""Curl noise against finite differences of its stream function, in 64 bits and as it is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.input.curl_noise import CurlNoise
from noises import DENSITY, PERLIN, places, simplex_noise, stream

STEEPEST = 3.44793


def stream_function(p: np.ndarray, node: CurlNoise) -> np.ndarray:
    octaves = np.arange(node.octaves)
    layers = (node.gain**i * simplex_noise(p * node.lacunarity**i, stream(node.seed, i)) for i in octaves)
    return node.strength * sum(layers)[..., 0] / ((node.gain * node.lacunarity) ** octaves).sum() / STEEPEST


@pytest.mark.parametrize(("octaves", "gain", "strength"), [(1, 0.4, 1.0), (3, 0.6, 2.5)])
def test_it_is_the_curl_of_simplex_noise(run, octaves, gain, strength):
    node = CurlNoise(size=13.0, octaves=octaves, gain=gain, strength=strength, lacunarity=2.3, seed=5, evolution=1.7)
    p, step = places(48, 37, 13.0, 1.7), 1e-5
    across, down = (
        (stream_function(p + way, node) - stream_function(p - way, node)) / (2 * step)
        for way in (np.array([step, 0, 0]), np.array([0, step, 0]))
    )
    found = run(node, size=(48, 37), output="vector")
    assert np.abs(found[..., :2] - np.stack([down, -across], -1)).max() < 2e-5
    assert np.abs(run(node, size=(48, 37), output="stream")[..., 0] - stream_function(p, node)).max() < 2e-6


def test_nothing_piles_up(run):
    """Central differences of what is drawn: no divergence, but for their own error; there is as much curl as ever."""
    size = 400.0
    flow = run(CurlNoise(size=size, octaves=1, evolution=0.4), size=(256, 256), output="vector").astype(np.float64)
    across, down = (np.gradient(flow, axis=axis)[1:-1, 1:-1] * size for axis in (1, 0))
    assert np.abs(across[..., 0] + down[..., 1]).max() < 1e-3
    assert np.abs(across[..., 1] - down[..., 0]).max() > 1.0


def test_the_flow_keeps_to_its_level_lines(run):
    """What goes in through the sides of any box goes out through others: exactly the stream function at its corners."""
    node = CurlNoise(size=60.0, octaves=2)
    flow = run(node, size=(96, 64), output="vector").astype(np.float64)
    height = run(node, size=(96, 64), output="stream")[..., 0].astype(np.float64)
    weights = np.array([0.5, *[1.0] * 38, 0.5])  # trapezoids down a column of 40 pixels
    through = weights @ flow[10:50, :, 0] / 60.0
    assert np.abs(through - (height[49] - height[10])).max() < 1e-3


def test_at_strength_one_no_vector_is_longer_than_one():
    """The steepest slope of any four edges: in any direction the sum of the largest, so at most this."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1)], np.float64)
    corners -= corners.sum(-1, keepdims=True) / 6
    n = 24
    parts = np.array([(a, b, c, n - a - b - c) for a, b, c in np.ndindex(n, n, n) if a + b + c <= n]) / n
    away = (parts @ corners)[:, None] - corners
    reach = np.maximum(0.5 - (away**2).sum(-1), 0)[..., None, None]
    along = (away @ PERLIN[:12].T)[..., None]
    slopes = 76.88075 * DENSITY * (reach**4 * PERLIN[:12] - 8 * reach**3 * along * away[:, :, None])
    turns = np.linspace(0, np.pi, 48, endpoint=False)
    ways = np.stack([np.cos(turns), np.sin(turns)])
    most = max((np.abs((slopes[..., list(pair)] @ ways)).max(2).sum(1)).max() for pair in ((0, 1), (0, 2), (1, 2)))
    assert 0.99 * STEEPEST < most <= STEEPEST * 1.001


def test_its_length_is_what_the_strength_says(run):
    one = np.linalg.norm(run(CurlNoise(octaves=1, size=8.0), size=(200, 200), output="vector"), axis=-1)
    three = np.linalg.norm(run(CurlNoise(octaves=1, size=8.0, strength=3.0), size=(200, 200), output="vector"), axis=-1)
    assert one.max() <= 1.0 and 0.2 < one.mean() < 0.5 and np.abs(three - 3 * one).max() < 1e-5


def test_it_shrinks_with_the_proxy(run):
    node = CurlNoise(size=40.0, octaves=1)
    full, half = (run(node, size=(96, 64), scale=scale, output="vector")[..., :2] for scale in (1.0, 0.5))
    assert np.abs(half - full.reshape(32, 2, 48, 2, 2).mean((1, 3))).max() < 5e-3


@pytest.mark.parametrize("values", [{"gain": 0.0}, {"gain": 4.0, "octaves": 16, "lacunarity": 16.0}, {"size": 0.01}])
def test_wild_values_stay_finite(run, values):
    for name in CurlNoise.outputs:
        assert np.isfinite(run(CurlNoise(**values), size=(20, 10), output=name)).all()
