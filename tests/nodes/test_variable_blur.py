"""Variable blur against a Gaussian for every pixel, in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.blur.variable_blur import VariableBlur
from scipy.ndimage import correlate1d
from scipy.special import ndtr


def kernel(sigma: float) -> np.ndarray:
    """The Gaussian out to 6 sigma; below a pixel, where samples of it are too narrow, integrated over pixels."""
    x = np.arange(-int(6.0 * sigma) - 2, int(6.0 * sigma) + 3)
    pixels = (np.append(x, x[-1] + 1) - 0.5) / sigma
    weights = np.exp(-0.5 * (x / sigma) ** 2) if sigma >= 1.0 else np.diff(ndtr(pixels))
    return weights / weights.sum()


def each(picture: np.ndarray, sigmas: np.ndarray) -> np.ndarray:
    """Every column with the Gaussian of its own sigma."""
    exact = picture.astype(np.float64)
    columns = []
    for x, sigma in enumerate(sigmas):
        weights = kernel(sigma) if sigma else np.ones(1)
        columns.append(correlate1d(correlate1d(exact, weights, 0, mode="nearest"), weights, 1, mode="nearest")[:, x])
    return np.stack(columns, axis=1)


def test_every_sigma_is_its_gaussian_even_on_white_noise(run):
    """The response to a single pixel, as a length: what white noise would show, where it is hardest to mix blurs."""
    picture = np.zeros((61, 61, 4), np.float32)
    picture[30, 30] = 1.0
    for full, shares in ((6.0, np.geomspace(0.02, 1.0, 18)), (0.8, (0.2, 0.5, 0.8)), (1.05, (0.9, 0.94, 0.96, 0.99))):
        for share in shares:
            sigma, field = full * share, np.full((61, 61), share, np.float32)
            found = run(VariableBlur(sigma=full), {"image": picture, "field": field})[..., 0]
            weights = kernel(sigma)
            expected = np.zeros((61, 61))
            lost = max(len(weights) - 61, 0) // 2
            weights = weights[lost : len(weights) - lost]
            middle = slice(30 - len(weights) // 2, 31 + len(weights) // 2)
            expected[middle, middle] = np.outer(weights, weights)
            error = np.linalg.norm(found - expected) / np.linalg.norm(expected)
            assert error <= 0.015, sigma
            assert found.min() >= 0.0
            assert found.sum() == pytest.approx(expected.sum(), rel=1e-4)


@pytest.mark.parametrize("sigma", [3.0, 20.0])
def test_every_pixel_has_its_own_gaussian(run, hdr, sigma):
    picture = np.minimum(hdr(48, 40), 20.0)
    field = np.broadcast_to(np.linspace(0.0, 1.0, 48, dtype=np.float32), (40, 48))
    found = run(VariableBlur(sigma=sigma), {"image": picture, "field": field})
    expected = each(picture, sigma * field[0])
    error = np.sqrt(((found - expected) ** 2).mean(axis=(0, 2)) / (expected**2).mean(axis=(0, 2)))
    assert error.max() <= 0.02


def test_a_rendered_frame(run, rendered_frame):
    picture = rendered_frame[150:250, 200:340].copy()
    field = np.broadcast_to(np.linspace(0.0, 1.0, 140, dtype=np.float32), (100, 140))
    found = run(VariableBlur(sigma=10.0), {"image": picture, "field": field})
    expected = each(picture, 10.0 * field[0])
    assert np.sqrt(((found - expected) ** 2).mean()) <= 0.003 * np.sqrt((expected**2).mean())


def test_variances_are_those_asked_for(run):
    line = np.zeros((1, 201, 4), np.float32)
    line[0, 100] = 1.0
    away = np.arange(201) - 100
    for share in (0.25, 0.4, 0.61, 0.77, 1.0):
        field = np.full((1, 201), share, np.float32)
        spread = run(VariableBlur(sigma=12.0), {"image": line, "field": field})[0, :, 0].astype(np.float64)
        assert spread.sum() == pytest.approx(1.0, rel=3e-5)
        assert np.sqrt((spread * away**2).sum()) == pytest.approx(12.0 * share, rel=3e-3)


@pytest.mark.parametrize("sigma", [0.3, 2.0, 30.0])
def test_a_full_field_is_a_gaussian_blur(run, hdr, edge, sigma):
    picture = hdr(31, 22)
    expected = run(GaussianBlur(sigma=sigma, edge=edge.name), {"image": picture})
    node = VariableBlur(sigma=sigma, edge=edge.name)
    np.testing.assert_array_equal(run(node, {"image": picture}), expected)
    np.testing.assert_array_equal(run(node, {"image": picture, "field": np.full((22, 31), 7.0)}), expected)


def test_an_empty_field_changes_nothing(run, hdr):
    picture = hdr(19, 14)
    np.testing.assert_array_equal(run(VariableBlur(), {"image": picture, "field": np.zeros((14, 19))}), picture)
    np.testing.assert_array_equal(run(VariableBlur(), {"image": picture, "field": np.full((14, 19), -1.0)}), picture)
    assert VariableBlur(sigma=0.0).identity() == "image"


def test_a_flat_picture_stays(run):
    flat = np.full((20, 30, 4), 1.7, np.float32)
    field = np.random.default_rng(0).random((20, 30))
    np.testing.assert_allclose(run(VariableBlur(), {"image": flat, "field": field}), flat, rtol=3e-6)
