"""Oil against its definition in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.stylize.oil import Oil

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def encoded(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decoded(code):
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def painted(picture: np.ndarray, radius: float, levels: int, mode: str) -> np.ndarray:
    """Of an opaque picture; what lies outside of it may be transparent."""
    tones = encoded(picture.astype(np.float64))
    tones[..., 3] = 1.0
    reach = int(np.ceil(radius))
    wide = np.pad(tones, ((reach, reach), (reach, reach), (0, 0)), mode=mode)
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    disc = x * x + y * y <= radius * radius
    found = np.zeros_like(tones)
    for row in range(tones.shape[0]):
        for column in range(tones.shape[1]):
            colors = wide[row : row + 2 * reach + 1, column : column + 2 * reach + 1][disc]
            level = np.minimum((np.clip(colors[:, :3] @ WEIGHTS, 0.0, 1.0) * levels).astype(int), levels - 1)
            found[row, column] = colors[level == np.bincount(level).argmax()].mean(0)
    alpha = found[..., 3:]
    return np.concatenate([np.where(alpha, decoded(found[..., :3] / np.maximum(alpha, 1e-9)) * alpha, 0.0), alpha], -1)


@pytest.mark.parametrize("size", [(27, 18), (7, 6)])
@pytest.mark.parametrize(("radius", "levels"), [(1.0, 4), (3.4, 12), (5.0, 32)])
def test_it_equals_the_definition(run, hdr, edge, size, radius, levels):
    picture = np.minimum(hdr(*size, opaque=True), 5.0)
    found = run(Oil(radius=radius, levels=levels, edge=edge.name), {"image": picture})
    np.testing.assert_allclose(found, painted(picture, radius, levels, edge.numpy), rtol=1e-4, atol=1e-6)


def test_flat_and_step_stay(run):
    flat = np.full((9, 14, 4), 0.4, np.float32)
    np.testing.assert_allclose(run(Oil(), {"image": flat}), flat, rtol=1e-5)
    step = np.ones((16, 20, 4), np.float32)
    step[:, :10, :3] = 0.1
    np.testing.assert_allclose(run(Oil(), {"image": step}), step, rtol=1e-5)


def test_a_spark_goes(run):
    spark = np.full((15, 15, 4), 0.2, np.float32)
    spark[..., 3] = 1.0
    spark[7, 7, :3] = 3.0
    np.testing.assert_allclose(run(Oil(radius=2.0), {"image": spark})[..., :3], 0.2, rtol=1e-5)


def test_no_radius_changes_nothing():
    assert Oil(radius=0.5).identity() == "image"


def test_a_pixel_by_hand(run):
    """Of a cross of five pixels three have tones of the middle third, 0.45, 0.5 and 0.55: their mean takes the place.

    The code 0.5 of sRGB is the light 0.214041 (IEC 61966-2-1). Corners are farther away than the radius.
    """
    codes = np.array([[0.4, 0.45, 0.4], [0.5, 0.1, 0.9], [0.4, 0.55, 0.4]])
    picture = np.ones((3, 3, 4))
    picture[..., :3] = decoded(codes)[..., None]
    found = run(Oil(radius=1.0, levels=3), {"image": picture})[1, 1]
    np.testing.assert_allclose(found, [0.214041, 0.214041, 0.214041, 1.0], rtol=1e-5)
