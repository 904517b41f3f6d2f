"""Noises that repeat: the same bits one period further, and the papers' formulas on a lattice that is a torus."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.input.curl_noise import CurlNoise
from halation.nodes.input.noise import Noise
from halation.nodes.input.worley import Worley
from hashes import hash3
from noises import KINDS, places, stream
from scipy.spatial import KDTree

TILE = (40, 48)
LOOP = 6.0
STEPS = {"simplex": 6}
"""The whole numbers of cells that fit: all, but of simplex noise multiples of six."""
ALL = [*(Noise(kind=kind, size=13.0, octaves=3) for kind in KINDS), Noise(fractal="warped", size=13.0, octaves=2)]
ALL += [CurlNoise(size=15.0), Worley(size=9.0)]


def name(node) -> str:
    return f"{node.id}-{getattr(node, 'kind', '')}-{getattr(node, 'fractal', '')}"


@pytest.mark.parametrize("node", ALL, ids=name)
def test_it_repeats_to_the_bit(run, node):
    node = node.with_values(period=TILE, evolution=0.7)
    for output in type(node).outputs:
        found = run(node, size=(2 * TILE[0] + 3, 2 * TILE[1] + 3), output=output)
        across, down = found[:, TILE[0] :], found[TILE[1] :]
        assert np.array_equal(found[:, : across.shape[1]], across) and np.array_equal(found[: len(down)], down)
        assert found[: TILE[1], : TILE[0], 0].std() > 0.03


@pytest.mark.parametrize("node", ALL, ids=name)
def test_a_loop_closes_to_the_bit(run, node):
    start, middle, end = (
        run(node.with_values(evolution=z, loop=LOOP), size=(40, 30), output=next(iter(type(node).outputs)))
        for z in (0.25, 0.25 + 0.5 * LOOP, 0.25 + LOOP)
    )
    assert np.array_equal(start, end) and np.abs(middle - start).max() > 0.05


@pytest.mark.parametrize("node", ALL, ids=name)
def test_an_offset_moves_the_pattern(run, node):
    output = next(iter(type(node).outputs))
    still, moved = (
        run(node.with_values(period=TILE, offset=offset), size=TILE, output=output) for offset in ((0, 0), (7, -5))
    )
    assert np.array_equal(moved, np.roll(still, (-5, 7), (0, 1)))


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_the_papers_formula_on_a_torus(run, kind):
    node = Noise(
        kind=kind, size=4.7, octaves=2, lacunarity=2.5, contrast=1.0, seed=3, evolution=1.3, period=TILE, loop=LOOP
    )
    tiles, step, total = np.array([*TILE, LOOP]) / (4.7, 4.7, 1.0), STEPS.get(kind, 1), 0.0
    for octave in range(2):
        counts = np.maximum(np.round(tiles * 2.5**octave / step), 1) * step
        p = places(*TILE, 4.7, 1.3) * counts / tiles
        total = total + KINDS[kind](p, stream(3, octave), tuple(counts)) * 0.5**octave / 1.5
    found = 2 * run(node, size=TILE, output="value")[..., 0] - 1
    assert np.abs(found - total[..., 0]).max() < 3e-5


def test_cells_are_those_of_a_torus(run):
    """The nearest of the points in a box whose sides meet, by scipy."""
    counts, node = np.array([4, 5, 6]), Worley(size=10.5, jitter=0.5, evolution=1.3, period=TILE, loop=LOOP)
    seed = tuple(int(part) for part in stream(0, 0, 1))
    cells = np.stack(np.meshgrid(*(np.arange(count) for count in counts), indexing="ij"), -1).reshape(-1, 3)
    points = cells + 0.5 + 0.5 * (hash3(tuple(cells.T), seed).T - 0.5)
    p = places(*TILE, 1.0, 1.3) * counts / (*TILE, LOOP)
    far, _ = KDTree(points, boxsize=counts).query(p.reshape(-1, 3), k=2)
    for order, feature in enumerate(("f1", "f2")):
        found = run(node.with_values(feature=feature), size=TILE, output="value")[..., 0]
        np.testing.assert_allclose(found.ravel(), far[:, order], atol=5e-6)


def test_the_flow_still_follows_the_stream_function(run):
    """Central differences along both axes, of which the second is squeezed to close."""
    node = CurlNoise(size=300.0, octaves=1, period=(1024.0, 1500.0))
    flow, height = (run(node, size=(200, 160), output=output).astype(np.float64) for output in ("vector", "stream"))
    down, across = np.gradient(height[..., 0] * 300.0)
    inside = (slice(1, -1), slice(1, -1))
    assert np.abs(flow[..., 0] - down)[inside].max() < 2e-3 and np.abs(flow[..., 1] + across)[inside].max() < 2e-3
    assert 0.1 < np.abs(flow[..., :2]).max() <= 1.0
