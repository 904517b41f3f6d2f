"""Stereo, normal maps and CAS against published formulas, scipy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.blur.cas_sharpen import CasSharpen
from halation.nodes.geometry.height_to_normal import HeightToNormal
from halation.nodes.merge.stereo import Stereo
from scipy import ndimage

GRAY = np.array((0.2126, 0.7152, 0.0722))
DUBOIS = (
    np.array([[0.456, 0.500, 0.176], [-0.040, -0.038, -0.016], [-0.015, -0.021, -0.005]]),
    np.array([[-0.043, -0.088, -0.002], [0.378, 0.734, -0.018], [-0.072, -0.113, 1.226]]),
)
"""For the left and the right eye, from E. Dubois, "A projection method to generate anaglyph stereo images" (2001)."""


def make_views(width: int = 40, height: int = 26) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(3)
    left, right = (random.random((height, width, 4)).astype(np.float32) for _ in range(2))
    return left, right


def test_anaglyphs_are_their_published_matrices(run):
    left, right = make_views()
    one, two = left[..., :3].astype(np.float64), right[..., :3].astype(np.float64)
    gray_one, gray_two = one @ GRAY, two @ GRAY
    expected = {
        "dubois": one @ DUBOIS[0].T + two @ DUBOIS[1].T,
        "color anaglyph": np.dstack([one[..., 0], two[..., 1], two[..., 2]]),
        "half color anaglyph": np.dstack([gray_one, two[..., 1], two[..., 2]]),
        "gray anaglyph": np.dstack([gray_one, gray_two, gray_two]),
    }
    for name, color in expected.items():
        out = run(Stereo(format=name), {"left": left, "right": right})
        np.testing.assert_allclose(out[..., :3], color, atol=1e-6, err_msg=name)
        np.testing.assert_array_equal(out[..., 3], np.maximum(left, right)[..., 3])
        swapped = run(Stereo(format=name, swap=True), {"left": right, "right": left})
        np.testing.assert_array_equal(swapped, out)


def test_packed_pictures_are_means_of_two_pixels(run):
    left, right = make_views()
    across = np.concatenate([view.reshape(26, 20, 2, 4).mean(2) for view in (left, right)], 1)
    np.testing.assert_allclose(run(Stereo(format="side by side"), {"left": left, "right": right}), across, atol=1e-6)
    down = np.concatenate([view.reshape(13, 2, 40, 4).mean(1) for view in (left, right)], 0)
    np.testing.assert_allclose(run(Stereo(format="top and bottom"), {"left": left, "right": right}), down, atol=1e-6)
    rows = np.where((np.arange(26) % 2 == 0)[:, None, None], left, right)
    np.testing.assert_array_equal(run(Stereo(format="interlaced"), {"left": left, "right": right}), rows)


@pytest.mark.parametrize("kernel", ["sobel", "central"])
def test_normals_are_the_slopes_by_scipy(run, kernel, edge):
    height = ndimage.gaussian_filter(np.random.default_rng(2).random((30, 44)), 2.0).astype(np.float32)
    exact = height.astype(np.float64)
    slopes = [
        ndimage.sobel(exact, axis=axis, mode=edge.scipy) / 8.0
        if kernel == "sobel"
        else ndimage.correlate1d(exact, [-0.5, 0.0, 0.5], axis=axis, mode=edge.scipy)
        for axis in (1, 0)
    ]
    normal = np.dstack([-20.0 * slopes[0], 20.0 * slopes[1], np.ones_like(slopes[0])])
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    node = HeightToNormal(depth=20.0, kernel=kernel, edge=edge.name)
    np.testing.assert_allclose(run(node, {"height": height}, output="normal"), normal, atol=1e-5)
    colors = run(node, {"height": height}, output="color")
    np.testing.assert_allclose(colors[..., :3], 0.5 + 0.5 * normal, atol=1e-5)
    down = run(node.with_values(green="down"), {"height": height}, output="normal")
    np.testing.assert_allclose(down, normal * (1.0, -1.0, 1.0), atol=1e-5)


def test_the_normals_of_a_ball_point_away_from_its_center(run):
    y, x = np.mgrid[:64, :64] - 31.5
    height = np.sqrt(np.maximum(40.0**2 - x * x - y * y, 0.0)) / 40.0
    normal = run(HeightToNormal(depth=40.0, kernel="central"), {"height": height}, output="normal")
    truth = np.dstack([x, -y, np.sqrt(np.maximum(40.0**2 - x * x - y * y, 0.0))]) / 40.0
    near = x * x + y * y < 25.0**2
    assert np.abs(normal - truth)[near].max() < 2e-3


def sharpen_plainly(picture: np.ndarray, sharpness: float) -> np.ndarray:
    """CasFilter of AMD's ffx_cas.h (FidelityFX CAS 1.0) in 64 bits, with CAS_BETTER_DIAGONALS and CAS_SLOW."""
    p = np.pad(picture.astype(np.float64), ((1, 1), (1, 1), (0, 0)), mode="edge")
    a, b, c, d, e, f, g, h, i = (p[y : y + len(picture), x : x + picture.shape[1]] for y in range(3) for x in range(3))
    minimum = np.minimum.reduce([d, e, f, b, h])
    minimum = minimum + np.minimum.reduce([minimum, a, c, g, i])
    maximum = np.maximum.reduce([d, e, f, b, h])
    maximum = maximum + np.maximum.reduce([maximum, a, c, g, i])
    amplitude = np.sqrt(np.clip(np.minimum(minimum, 2.0 - maximum) / maximum, 0.0, 1.0))
    weight = amplitude * -1.0 / (8.0 + (5.0 - 8.0) * sharpness)
    return np.clip((b * weight + d * weight + f * weight + h * weight + e) / (1.0 + 4.0 * weight), 0.0, 1.0)


@pytest.mark.parametrize("sharpness", [0.0, 0.4, 1.0])
def test_cas_is_its_published_formula(run, sharpness):
    picture = np.random.default_rng(8).uniform(0.01, 1.0, (30, 40, 4)).astype(np.float32)
    out = run(CasSharpen(sharpness=sharpness), {"image": picture})
    np.testing.assert_allclose(out[..., :3], sharpen_plainly(picture[..., :3], sharpness), atol=1e-5)
    np.testing.assert_array_equal(out[..., 3], picture[..., 3])


def test_cas_leaves_bright_light_and_even_areas_alone(run):
    flat = np.full((9, 9, 4), 0.3, np.float32)
    np.testing.assert_allclose(run(CasSharpen(), {"image": flat}), flat, atol=1e-6)
    bright = np.random.default_rng(1).uniform(3.0, 50.0, (9, 9, 4)).astype(np.float32)
    np.testing.assert_array_equal(run(CasSharpen(), {"image": bright}), bright)
