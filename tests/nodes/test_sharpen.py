"""Sharpen against numpy and scipy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.blur.sharpen import Sharpen
from scipy.ndimage import gaussian_filter

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize("size", [(33, 20), (1, 9), (1, 1)])
@pytest.mark.parametrize(("sigma", "tolerance"), [(1.0, 1e-5), (3.3, 1e-5), (12.0, 1e-3)])
@pytest.mark.parametrize(
    ("amount", "threshold", "limit", "channels"),
    [
        (1.7, 0.0, 1e6, "separate"),
        (0.6, 0.2, 0.5, "separate"),
        (1.7, 0.0, 0.3, "luminance"),
        (-0.5, 0.3, 1e6, "luminance"),
    ],
)
def test_it_equals_the_formula(run, hdr, edge, size, sigma, tolerance, amount, threshold, limit, channels):
    picture = hdr(*size)
    values = {"amount": amount, "sigma": sigma, "threshold": threshold, "limit": limit, "channels": channels}
    found = run(Sharpen(**values, edge=edge.name), {"image": picture})
    exact = picture.astype(np.float64)
    sharp = (exact[..., :3] @ WEIGHTS)[..., None] if channels == "luminance" else exact[..., :3]
    truncate = 4.0 if sigma < 7.0 else 6.0
    detail = (exact - gaussian_filter(exact, (sigma, sigma, 0), mode=edge.scipy, truncate=truncate))[..., :3]
    if channels == "luminance":
        detail = (detail @ WEIGHTS)[..., None]
    detail = np.sign(detail) * np.clip(np.abs(detail) - threshold, 0.0, limit * sharp)
    expected = exact[..., :3] + amount * detail
    assert np.abs(found[..., :3] - expected).max() <= tolerance * np.abs(expected).max()
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


def test_taking_all_detail_away_is_the_blur(run, hdr):
    picture = hdr(21, 17)
    found = run(Sharpen(amount=-1.0, sigma=2.0, limit=1e9, channels="separate"), {"image": picture})[..., :3]
    expected = gaussian_filter(picture.astype(np.float64), (2, 2, 0), mode="nearest")[..., :3]
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-5)


def test_around_a_lamp_light_is_taken_away_like_a_gaussian(run):
    """The same shape to 2e-5 of its peak: an error of a blur would be seen as rings once it is subtracted."""
    lamp = np.ones((61, 61, 4), np.float32)
    lamp[30, 30, :3] = 300.0
    found = run(Sharpen(sigma=6.0, limit=1e9, channels="separate"), {"image": lamp}).astype(np.float64)
    halo = gaussian_filter(lamp[..., 0].astype(np.float64), 6.0, mode="nearest") - 1.0
    around = lamp[..., 0] == 1.0
    np.testing.assert_allclose(
        1.0 - found[around][:, 0], Sharpen().amount * halo[around], rtol=0.0, atol=2e-5 * halo.max()
    )


def test_flat_and_faint_stay(run, hdr):
    flat = np.full((9, 11, 4), 0.37, np.float32)
    np.testing.assert_allclose(run(Sharpen(amount=3.0), {"image": flat}), flat, rtol=1e-5)
    faint = flat + 0.01 * np.random.default_rng(1).random(flat.shape).astype(np.float32)
    np.testing.assert_allclose(run(Sharpen(amount=3.0, threshold=0.05), {"image": faint}), faint, rtol=1e-6)


def test_lamps_get_no_black_halos(run):
    lamp = np.full((9, 20, 4), 0.2, np.float32)
    lamp[:, 10:, :3] = 50.0
    assert run(Sharpen(amount=2.0), {"image": lamp})[..., :3].min() == pytest.approx(0.2 * (1.0 - 2.0 * 0.3), rel=1e-4)


def test_neutral_values():
    assert Sharpen(amount=0.0).identity() == Sharpen(sigma=0.0).identity() == "image"
