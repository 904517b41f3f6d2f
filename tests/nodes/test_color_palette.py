"""Palettes against the nearest colors by scipy and published Bayer matrices."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.color.color_palette import ColorPalette
from scipy.spatial import cKDTree

BAYER = {
    2: np.array([[0, 2], [3, 1]]),
    4: np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]]),
}
"""The matrices as they are printed everywhere, from Bayer (1973)."""
BAYER[8] = np.block([[4 * BAYER[4], 4 * BAYER[4] + 2], [4 * BAYER[4] + 3, 4 * BAYER[4] + 1]])


def encode(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decode(code: np.ndarray) -> np.ndarray:
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def make_stops(colors: np.ndarray) -> tuple[float, ...]:
    places = np.linspace(0.0, 1.0, len(colors))
    return tuple(float(part) for place, color in zip(places, colors, strict=True) for part in (place, *color, 1.0))


def test_without_a_pattern_the_nearest_color_is_taken(run):
    random = np.random.default_rng(4)
    colors = random.random((11, 3)).astype(np.float32)
    picture = random.random((40, 50, 4)).astype(np.float32)
    picture[..., 3] = 1.0
    apart, nearest = cKDTree(encode(colors)).query(encode(picture[..., :3]), k=2)
    out = run(ColorPalette(colors=make_stops(colors), dither="none"), {"image": picture})
    sure = apart[..., 1] - apart[..., 0] > 1e-5
    np.testing.assert_allclose(out[sure][:, :3], colors[nearest[..., 0]][sure], atol=1e-6)
    np.testing.assert_array_equal(out[..., 3], 1.0)


@pytest.mark.parametrize("side", BAYER)
@pytest.mark.parametrize("size", [1, 3])
def test_patterns_are_the_published_matrices(run, side, size):
    """Black and white by a threshold of the matrix: a gray is white where the matrix is below it."""
    levels = side * side
    code = (np.arange(levels + 1) / levels)[:, None, None]
    gray = np.broadcast_to(decode(code), (levels + 1, 1, 1))
    rows = np.repeat(np.repeat(gray, 8 * size, 0), 8 * size, 1)
    picture = np.concatenate([np.repeat(rows, 3, -1), np.ones_like(rows)], -1).astype(np.float32)
    node = ColorPalette(
        colors=make_stops(np.array([(0.0,) * 3, (1.0,) * 3])), dither=f"bayer {side}", spread=1.0, size=float(size)
    )
    white = run(node, {"image": picture})[..., 0].reshape(levels + 1, 8 * size, 8 * size) > 0.5
    matrix = np.kron(np.tile(BAYER[side], (8 // side, 8 // side)), np.ones((size, size)))
    # The pattern may be turned or mirrored: what counts is how many cells are white, and that they are the lowest.
    orders = [np.rot90(turned, number) for turned in (matrix, matrix.T) for number in range(4)]
    matches = [
        all((white[level] == (order >= levels - level)).all() for level in range(levels + 1)) for order in orders
    ]
    assert any(matches)


def test_blue_noise_keeps_the_average(run):
    ramp = np.broadcast_to(decode(np.linspace(0.0, 1.0, 64))[None, :, None], (64, 64, 3))
    picture = np.concatenate([ramp, np.ones((64, 64, 1))], -1).astype(np.float32)
    colors = np.array([(0.0,) * 3, (1.0,) * 3])
    out = run(ColorPalette(colors=make_stops(colors), dither="blue noise", spread=1.0), {"image": picture})
    assert {*np.unique(out[..., 0])} == {0.0, 1.0}
    parts = out[..., 0].mean(0).reshape(8, 8).mean(1)
    np.testing.assert_allclose(parts, np.linspace(0.0, 1.0, 64).reshape(8, 8).mean(1), atol=0.03)
