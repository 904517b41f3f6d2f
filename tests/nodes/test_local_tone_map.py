"""Local Tone Map against the paper's formula in double precision, with scipy's Gaussian."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.tone.local_tone_map import LocalToneMap
from halation.nodes.tone.tone_map import ToneMap
from scipy.ndimage import correlate1d, gaussian_filter
from scipy.special import erf

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def blurred(field, sigma):
    """scipy's Gaussian; below one pixel the mean of it over each pixel, as samples would be too narrow."""
    if sigma >= 1:
        return gaussian_filter(field, sigma, mode="nearest")
    reach = np.arange(-np.ceil(4 * sigma), np.ceil(4 * sigma) + 1)
    weights = erf((reach + 0.5) / sigma / np.sqrt(2)) - erf((reach - 0.5) / sigma / np.sqrt(2))
    weights /= weights.sum()
    return correlate1d(correlate1d(field, weights, 0, mode="nearest"), weights, 1, mode="nearest")


def reinhard(rgb, key=0.18, phi=8.0, epsilon=0.05, size=1.0, average=None, white=None):
    """Section 3.2 of the paper: the color, and how far the choice of every scale is from the threshold."""
    rgb = rgb.astype(np.float64)
    luma = rgb @ WEIGHTS
    average = average or np.exp(np.log(1e-5 + luma).mean())
    scaled = key / average * luma
    white = key / average * (white or luma.max())
    alpha = 1 / (2 * np.sqrt(2))
    scales = [1.6**index for index in range(9)]
    responses = [blurred(scaled, alpha * scale * size / np.sqrt(2)) for scale in scales]
    chosen, growing, margin = responses[0], np.ones(luma.shape, bool), np.full(luma.shape, np.inf)
    for scale, inner, outer in zip(scales, responses, responses[1:], strict=False):
        even = (inner - outer) / (2**phi * key / scale**2 + inner)
        margin = np.where(growing, np.minimum(margin, np.abs(np.abs(even) - epsilon) / epsilon), margin)
        growing &= np.abs(even) < epsilon
        chosen = np.where(growing, inner, chosen)
    shown = scaled * (1 + scaled / white**2) / (1 + chosen)
    return rgb * (shown / np.maximum(luma, 1e-12))[..., None], margin


def scene(width=53, height=39, seed=1):
    """Even areas, edges and noise over many stops, without black."""
    random = np.random.default_rng(seed)
    tiles = np.exp2(random.uniform(-5, 3, (5, 7)))
    light = np.kron(tiles, np.ones((8, 8)))[:height, :width]
    light = light * random.lognormal(0, 0.15, light.shape)
    rgb = light[..., None] * (0.4 + 1.8 * random.dirichlet([3, 3, 3], light.shape))
    return np.concatenate([rgb, np.ones((height, width, 1))], -1).astype(np.float32)


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"sharpness": 12.0},
        {"sharpness": 1.0, "threshold": 0.2},
        {"key": 0.5},
        {"size": 0.6},
        {"threshold": 0.01},
    ],
    ids=str,
)
def test_it_is_the_papers_operator(run, values):
    """Where a scale is chosen by a hair, either choice is right."""
    image = scene()
    renamed = {"sharpness": "phi", "threshold": "epsilon"}
    expected, margin = reinhard(image[..., :3], **{renamed.get(name, name): value for name, value in values.items()})
    found = run(LocalToneMap(clip=False, **values), {"image": image})[..., :3]
    sure = margin > 5e-3
    assert sure.mean() > 0.9
    assert (np.abs(found - expected) / np.maximum(1.0, expected))[sure].max() < 2e-6


def test_colors_end_at_white(run):
    """The paper's operator, then numpy's clip: channels of strong colors exceed 1 long before luminance does."""
    image = scene()
    expected, margin = reinhard(image[..., :3])
    shown = run(LocalToneMap(), {"image": image})[..., :3]
    sure = margin > 5e-3
    assert (expected[sure] > 1.1).sum() > 10
    np.testing.assert_allclose(shown[sure], np.clip(expected, 0.0, 1.0)[sure], atol=2e-6)


def test_wide_areas_are_as_exact_as_the_blur(run):
    """Sigmas above 7 pixels are blurred at a small size, to 3e-4 of the brightest light nearby."""
    image = scene()
    expected, margin = reinhard(image[..., :3], size=2.5)
    error = np.abs(run(LocalToneMap(clip=False, size=2.5), {"image": image})[..., :3] - expected)
    assert (error / np.maximum(1.0, expected))[margin > 5e-3].max() < 3e-3


def test_an_even_picture_is_reinhards_curve(run):
    image = np.full((21, 33, 4), 0.7, np.float32)
    image[..., 3] = 1.0
    linked = {"image": image, "average": np.full((1, 1), 0.3, np.float32), "maximum": np.full((1, 1), 5, np.float32)}
    curve = ToneMap(operator="reinhard extended", average=0.3, maximum=5.0)
    assert np.abs(run(LocalToneMap(), linked) - run(curve, {"image": image})).max() < 2e-6


def test_statistics_are_measured_or_linked(run):
    image = scene(seed=2)
    luma = image[..., :3].astype(np.float64) @ WEIGHTS
    linked = {
        "image": image,
        "average": np.array([[np.exp(np.log(1e-5 + luma).mean())]]),
        "maximum": np.array([[luma.max()]]),
    }
    assert np.abs(run(LocalToneMap(), linked) - run(LocalToneMap(), {"image": image})).max() < 2e-5
    darker = run(LocalToneMap(), linked | {"average": linked["average"] * 4})
    assert darker.mean() < 0.8 * run(LocalToneMap(), {"image": image}).mean()


def test_auto_key_is_krawczyks(run):
    image = scene(seed=3)
    average = np.full((1, 1), 0.4, np.float32)
    key = 1.03 - 2 / (2 + np.log10(0.4 * 10.0 + 1))
    auto = run(LocalToneMap(auto_key=True, nits=10.0), {"image": image, "average": average})
    assert np.abs(auto - run(LocalToneMap(key=key), {"image": image, "average": average})).max() < 1e-5


def test_it_keeps_detail_that_one_curve_flattens(run):
    """A fine pattern in a bright and in a dark area: local contrast is never below the global curve's."""
    y, x = np.mgrid[:40, :64]
    light = np.where(x < 32, 0.02, 8.0) * np.where((x + y) % 2, 1.15, 0.85)
    image = np.stack([light, light, light, np.ones_like(light)], -1).astype(np.float32)
    average, white = float(np.exp(np.log(light).mean())), float(light.max())
    local = run(LocalToneMap(), {"image": image})[..., 0]
    curve = run(ToneMap(operator="reinhard extended", average=average, maximum=white), {"image": image})[..., 0]
    for part in (np.s_[8:32, 8:20], np.s_[8:32, 44:56]):
        local_contrast, contrast = local[part].std() / local[part].mean(), curve[part].std() / curve[part].mean()
        assert local_contrast > 0.999 * contrast
    bright = np.s_[8:32, 44:56]
    assert local[bright].std() / local[bright].mean() > 1.5 * curve[bright].std() / curve[bright].mean()


def test_what_is_empty_takes_no_part(run):
    """Half covered pixels look as covered ones, and empty ones beside them change nothing."""
    image = np.full((17, 30, 4), 0.5, np.float32)
    image[..., 3] = 1.0
    whole = run(LocalToneMap(), {"image": image})
    covered = image.copy()
    covered[:, 15:] = 0.0
    covered[:, :8] *= 0.5
    found = run(LocalToneMap(), {"image": covered})
    assert np.abs(found[:, :8] - 0.5 * whole[:, :8]).max() < 1e-6
    assert np.abs(found[:, 8:15] - whole[:, 8:15]).max() < 1e-6
    assert not found[:, 15:].any()


@pytest.mark.parametrize("size", [(1, 1), (1, 9), (7, 2)])
def test_tiny_and_black_pictures(run, size):
    black = np.zeros((*size, 4), np.float32)
    assert not run(LocalToneMap(), {"image": black}).any()
    black[..., 3] = 1.0
    assert not run(LocalToneMap(), {"image": black})[..., :3].any()
    gray = black.copy()
    gray[..., :3] = 0.4
    assert run(LocalToneMap(), {"image": gray})[..., :3] == pytest.approx(1.0, abs=3e-5)  # all of it is the maximum


def test_a_lamp_has_no_dark_rim(run):
    """A wall beside a lamp, by areas larger than a pixel: no darker than by an area that is even to the threshold."""
    y, x = np.mgrid[:64, :64]
    lamp = np.clip(10.5 - np.hypot(x - 31.5, y - 31.5), 0.0, 1.0)  # the coverage of each pixel
    light = 0.5 + 20.0 * lamp
    image = np.stack([light, light, light, np.ones_like(light)], -1).astype(np.float32)
    average = np.full((1, 1), 0.5, np.float32)
    shown = run(LocalToneMap(size=2.0, sharpness=2.0, key=0.3), {"image": image, "average": average})[..., 0]
    wall, uneven = 0.3, 0.05 * (2.0**2 * 0.3 * 1.6**2 + 0.3)  # the threshold times the paper's denominator
    assert shown.min() > (1 + wall) / (1 + wall + uneven) * shown[0, 0]
