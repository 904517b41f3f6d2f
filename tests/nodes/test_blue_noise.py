"""Blue noise: its spectrum and its evenness. That the table is void and cluster, the test of Dither proves."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Port
from halation.nodes.input.blue_noise import BlueNoise
from halation.renderer import RenderRequest
from hashes import pcg3d

SIZE = 64
SHADER = Path(__file__).parents[2] / "shaders" / "lib" / "blue_noise.glsl"


def three(run, node: BlueNoise, size: tuple[int, int] = (SIZE, SIZE)) -> np.ndarray:
    value, vector = (run(node, size=size, output=name) for name in ("value", "vector"))
    return np.concatenate([value[..., :1], 0.5 + 0.5 * vector[..., :2]], -1)


@pytest.mark.parametrize("seed", [0, 7])
def test_it_is_the_table_from_a_hashed_start(run, seed):
    x, y, _ = (int(part) & 63 for part in pcg3d(np.array([seed, 0, 0], np.uint32)))
    words = re.findall(r"0x([0-9a-f]{8})u", SHADER.read_text(encoding="utf-8"))
    table = np.array([int(word, 16) for word in words], "<u4").view(np.uint8).reshape(SIZE, SIZE)
    table = (table + 0.5) / 256
    found = three(run, BlueNoise(seed=seed))
    for channel, (right, down) in enumerate([(0, 0), (48, 36), (32, 8)]):
        np.testing.assert_array_equal(found[..., channel], np.roll(table, (-y - down, -x - right), (0, 1)))


def test_it_has_no_low_frequencies_and_every_value_as_often(run):
    found = three(run, BlueNoise())
    power = np.abs(np.fft.fft2(found - found.mean((0, 1)), axes=(0, 1))) ** 2
    distance = np.hypot(*np.meshgrid(np.fft.fftfreq(SIZE), np.fft.fftfreq(SIZE)))
    low, high = (power[mask].mean(0) for mask in ((distance > 0) & (distance < 0.1), distance > 0.3))
    assert (low / high < 5e-3).all()
    for channel in range(3):
        np.testing.assert_array_equal(np.bincount((found[..., channel] * 256).astype(int).ravel()), SIZE**2 // 256)
    assert np.abs(np.corrcoef(found.reshape(-1, 3).T) - np.eye(3)).max() < 0.05


def test_cells_grow_with_size_and_are_never_smaller_than_a_pixel(run):
    small, large, tiny = (run(BlueNoise(size=size), size=(80, 48)) for size in (1.0, 4.0, 0.5))
    np.testing.assert_array_equal(large[::4, ::4], small[:12, :20])
    np.testing.assert_array_equal(tiny, small)
    np.testing.assert_array_equal(run(BlueNoise(size=4.0), size=(80, 48), scale=0.5), large[::2, ::2])
    np.testing.assert_array_equal(small[:, :16], small[:, 64:])


def test_frames_differ_on_demand(renderer):
    for animate in (False, True):
        graph = graph_of(BlueNoise(animate=animate), {})
        one, again, other = (
            renderer.render(graph, RenderRequest({}, {"value": Port("outputs", "value")}, (64, 64), frame=frame))[
                "value"
            ]
            for frame in (3, 3, 4)
        )
        assert np.array_equal(one, again) and np.array_equal(one, other) != animate
