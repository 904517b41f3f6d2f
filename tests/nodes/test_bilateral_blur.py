"""Bilateral blur against OpenCV and the formula in 64 bits."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from halation.nodes.blur.bilateral_blur import BilateralBlur
from scipy.ndimage import gaussian_filter


def smoothed(picture, guide, sigma: float, sigma_range: float, mode: str) -> np.ndarray:
    radius = max(round(1.5 * sigma), 1)
    pads = ((radius, radius), (radius, radius), (0, 0))
    height, width = picture.shape[:2]
    wide, led = (np.pad(a.astype(np.float64), pads, mode=mode) for a in (picture, guide))
    total, weights = np.zeros(picture.shape), np.zeros((height, width, 1))
    for y in range(-radius, radius + 1):
        for x in range(-radius, radius + 1):
            if x * x + y * y > radius * radius:
                continue
            part = np.s_[radius + y : radius + y + height, radius + x : radius + x + width]
            unlike = ((led[part][..., :3] - guide[..., :3]) ** 2).sum(-1, keepdims=True)
            weight = np.exp(-(x * x + y * y) / (2 * sigma**2) - unlike / (2 * sigma_range**2))
            total += weight * wide[part]
            weights += weight
    return total / weights


@pytest.mark.parametrize("size", [(23, 18), (9, 8)])
@pytest.mark.parametrize(("sigma", "sigma_range"), [(2.0, 0.3), (4.3, 2.0)])
def test_it_equals_the_formula(run, hdr, edge, size, sigma, sigma_range):
    picture = hdr(*size)
    found = run(BilateralBlur(sigma=sigma, sigma_range=sigma_range, edge=edge.name), {"image": picture})
    expected = smoothed(picture, picture, sigma, sigma_range, edge.numpy)
    np.testing.assert_allclose(found, expected, rtol=2e-5, atol=2e-6)


def test_a_guide_leads(run, hdr):
    picture, guide = hdr(23, 18), hdr(23, 19)[1:]
    found = run(BilateralBlur(sigma=3.0, sigma_range=0.5), {"image": picture, "guide": guide})
    np.testing.assert_allclose(found, smoothed(picture, guide, 3.0, 0.5, "edge"), rtol=2e-5, atol=2e-6)


@pytest.mark.parametrize("sigma", [1.0, 3.0, 4.0])
def test_it_equals_opencv(run, sigma):
    """Of one channel: of three, OpenCV adds the differences up."""
    channel = np.random.default_rng(4).random((30, 41)).astype(np.float32)
    picture = np.zeros((30, 41, 4), np.float32)
    picture[..., 0] = channel
    expected = cv2.bilateralFilter(channel, 0, 0.2, sigma, borderType=cv2.BORDER_REPLICATE)
    found = run(BilateralBlur(sigma=sigma, sigma_range=0.2), {"image": picture})
    assert np.abs(found[..., 0] - expected).max() <= 1e-5  # OpenCV interpolates a table of the exponential


def test_a_wide_range_is_a_gaussian_within_its_circle(run):
    dot = np.zeros((31, 31, 4), np.float32)
    dot[15, 15] = 1.0
    found = run(BilateralBlur(sigma=4.0, sigma_range=1e3), {"image": dot})[..., 0]
    y, x = np.mgrid[-15:16, -15:16]
    circle = np.exp(-(x * x + y * y) / 32.0) * (x * x + y * y <= 36)
    np.testing.assert_allclose(found, circle / circle.sum(), rtol=1e-5, atol=1e-9)


def test_a_step_stays_while_noise_goes(run):
    random = np.random.default_rng(2)
    clean = np.zeros((40, 40, 4), np.float32)
    clean[:, 20:, :3], clean[..., 3] = 1.0, 1.0
    noisy = clean + 0.05 * random.standard_normal(clean.shape).astype(np.float32)
    found = run(BilateralBlur(sigma=4.0, sigma_range=0.3), {"image": noisy})
    assert np.abs(found - clean)[..., :3].std() < 0.02
    assert np.abs(gaussian_filter(noisy, (4, 4, 0)) - clean)[..., :3].std() > 0.08


def test_no_sigma_changes_nothing():
    assert BilateralBlur(sigma=0.0).identity() == "image"
