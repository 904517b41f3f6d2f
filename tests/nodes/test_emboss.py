"""Emboss against the formula with scipy in 64 bits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.edge.emboss import Emboss
from scipy.ndimage import gaussian_filter, sobel


def shading(picture, direction, elevation, height, softness, mode) -> np.ndarray:
    light = (picture[..., :3].astype(np.float64) / picture[..., 3:]) @ [0.2126, 0.7152, 0.0722]
    tone = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    if softness:
        tone = gaussian_filter(tone, softness, mode=mode)
    across, down = (sobel(tone, axis, mode=mode) / 8.0 for axis in (1, 0))
    normal = np.stack([-height * across, -height * down, np.ones_like(across)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    azimuth, high = math.radians(direction), math.radians(elevation)
    toward = np.array([math.cos(high) * math.cos(azimuth), -math.cos(high) * math.sin(azimuth), math.sin(high)])
    return np.maximum(normal @ toward, 0.0) / toward[2]


@pytest.mark.parametrize("size", [(33, 21), (4, 3)])
@pytest.mark.parametrize(
    ("direction", "elevation", "height", "softness"),
    [(135.0, 45.0, 6.0, 0.0), (-20.0, 70.0, -3.0, 1.5), (60.0, 45.0, 40.0, 6.0)],
)
@pytest.mark.parametrize("kind", ["relief", "bump"])
def test_it_equals_the_formula(run, hdr, edge, size, kind, direction, elevation, height, softness):
    picture = hdr(*size)
    picture[..., 3] = picture[..., 3] * 0.9 + 0.1
    node = Emboss(kind=kind, direction=direction, elevation=elevation, height=height, softness=softness, edge=edge.name)
    found = run(node, {"image": picture})
    shade = shading(picture, direction, elevation, height, softness, edge.scipy)[..., None]
    expected = picture[..., :3] * shade if kind == "bump" else 0.18 * shade * picture[..., 3:]
    assert np.abs(found[..., :3] - expected).max() <= 2e-5 * np.abs(expected).max()
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


def test_a_flat_picture_is_gray_or_stays(run):
    flat = np.full((8, 9, 4), 0.6, np.float32)
    flat[..., 3] = 1.0
    np.testing.assert_allclose(run(Emboss(), {"image": flat})[..., :3], 0.18, rtol=1e-5)
    np.testing.assert_allclose(run(Emboss(kind="bump"), {"image": flat}), flat, rtol=1e-5)


def test_slopes_toward_the_light_are_bright(run):
    ramp = np.ones((9, 30, 4), np.float32)
    ramp[..., :3] = np.linspace(0.01, 0.9, 30, dtype=np.float32)[None, :, None]
    from_left, from_right = (run(Emboss(direction=angle), {"image": ramp})[4, 15, 0] for angle in (180.0, 0.0))
    assert from_right < 0.18 < from_left
