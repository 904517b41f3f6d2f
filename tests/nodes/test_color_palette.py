"""Palettes against the nearest colors by scipy and published Bayer matrices."""

from __future__ import annotations

import cv2
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


def diffuse_plainly(codes: np.ndarray, palette: np.ndarray) -> np.ndarray:
    """The procedure of Floyd and Steinberg (1976), pixel by pixel; no pixel goes beyond the colors of the palette."""
    waiting, (height, width) = codes.astype(np.float64), codes.shape[:2]
    for y, x in np.ndindex(height, width):
        wanted = np.clip(waiting[y, x], palette.min(0), palette.max(0))
        waiting[y, x] = palette[((palette - wanted) ** 2).sum(1).argmin()]
        for right, down, share in ((1, 0, 7), (-1, 1, 3), (0, 1, 5), (1, 1, 1)):
            if 0 <= x + right < width and y + down < height:
                waiting[y + down, x + right] += share / 16.0 * (wanted - waiting[y, x])
    return waiting


@pytest.mark.parametrize("size", [(33, 21), (1, 9), (9, 1)])
def test_errors_are_diffused_as_published(run, size):
    random = np.random.default_rng(size[0])
    colors = random.random((7, 3))
    codes = random.random((size[1], size[0], 3))
    picture = np.concatenate([decode(codes), np.ones((*codes.shape[:2], 1))], -1).astype(np.float32)
    out = run(ColorPalette(colors=make_stops(colors), dither="error diffusion"), {"image": picture})
    expected = diffuse_plainly(encode(picture[..., :3].astype(np.float64)), encode(colors))
    np.testing.assert_allclose(encode(out[..., :3]), expected, atol=2e-3)


def test_error_diffusion_keeps_the_average_and_alpha(run):
    codes = np.broadcast_to(np.linspace(0.0, 1.0, 64)[None, :, None], (64, 64, 3))
    picture = np.concatenate([0.5 * decode(codes), np.full((64, 64, 1), 0.5)], -1).astype(np.float32)
    colors = np.array([(0.0,) * 3, (1.0,) * 3])
    out = run(ColorPalette(colors=make_stops(colors), dither="error diffusion"), {"image": picture})
    assert {*np.unique(out[..., 0])} == {0.0, 0.5} and {*np.unique(out[..., 3])} == {0.5}
    parts = 2.0 * out[..., 0].mean(0).reshape(8, 8).mean(1)
    np.testing.assert_allclose(parts, np.linspace(0.0, 1.0, 64).reshape(8, 8).mean(1), atol=0.02)


@pytest.mark.parametrize("count", [2, 5, 16])
def test_found_colors_are_as_near_as_those_of_opencv(run, rendered_frame, count):
    """The mean squared error, against the best of five runs of its k-means."""
    light = np.clip(rendered_frame[:160, :200, :3], 0.0, 1.0)
    picture = np.concatenate([light, np.ones_like(light[..., :1])], -1).astype(np.float32)
    codes = encode(light.astype(np.float64))
    out = run(ColorPalette(palette="found", count=count, dither="none"), {"image": picture})
    assert len(np.unique(out.reshape(-1, 4), axis=0)) == count
    samples = codes.reshape(-1, 3).astype(np.float32)
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 100, 1e-5)
    centers = cv2.kmeans(samples, count, None, stop, 5, cv2.KMEANS_PP_CENTERS)[2]
    best = np.mean(cKDTree(centers).query(samples)[0] ** 2)
    ours = np.mean(((encode(out[..., :3].astype(np.float64)) - codes) ** 2).sum(-1))
    assert ours < 1.1 * best, (ours, best)


def test_lamps_do_not_take_all_colors(run, rendered_frame):
    """They are as bright as 40: what is found is what is found where all light ends at 1."""
    assert rendered_frame[..., :3].max() > 30.0
    node = ColorPalette(palette="found", count=8, dither="none")
    bright, clipped = (
        np.unique(run(node, {"image": picture})[..., :3].reshape(-1, 3), axis=0)
        for picture in (rendered_frame, np.minimum(rendered_frame, 1.0))
    )
    np.testing.assert_allclose(bright, clipped, atol=1e-3)


def test_a_pattern_goes_with_found_colors(run, rendered_frame):
    """What is transparent is not counted among the colors that are found."""
    picture = np.concatenate([rendered_frame[:64, :64, :3], np.ones((64, 64, 1))], -1).astype(np.float32)
    picture[:8] = (90.0, 0.0, 0.0, 0.0)
    for dither in ("bayer 8", "blue noise", "error diffusion"):
        out = run(ColorPalette(palette="found", count=3, dither=dither), {"image": picture})
        assert len(np.unique(out[..., :3].reshape(-1, 3), axis=0)) == 3 and (out[..., 3] == picture[..., 3]).all()
        assert out[..., :3].max() <= 1.001 * picture[8:, :, :3].max()
