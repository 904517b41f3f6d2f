"""Difference of Gaussians against the published formula with scipy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.edge.difference_of_gaussians import DifferenceOfGaussians
from scipy.ndimage import gaussian_filter


def encoded(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decoded(code: np.ndarray) -> np.ndarray:
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def blurs(picture: np.ndarray, sigma: float, ratio: float, mode: str) -> tuple[np.ndarray, np.ndarray]:
    straight = picture[..., :3].astype(np.float64) / picture[..., 3:]
    tone = encoded(straight @ [0.2126, 0.7152, 0.0722])
    return gaussian_filter(tone, sigma, mode=mode), gaussian_filter(tone, sigma * ratio, mode=mode)


@pytest.mark.parametrize("size", [(37, 22), (5, 1)])
@pytest.mark.parametrize(("sigma", "ratio", "p"), [(1.0, 1.6, 20.0), (2.2, 3.0, 4.0)])
def test_xdog_equals_the_paper(run, hdr, edge, size, sigma, ratio, p):
    picture = hdr(*size)
    picture[..., 3] = picture[..., 3] * 0.9 + 0.1
    fine, coarse = blurs(picture, sigma, ratio, edge.scipy)
    sharp = (1.0 + p) * fine - p * coarse
    expected = np.where(sharp >= 0.7, 1.0, 1.0 + np.tanh(0.8 * (sharp - 0.7)))
    node = DifferenceOfGaussians(sigma=sigma, ratio=ratio, strength=p, epsilon=0.7, phi=0.8, edge=edge.name)
    found = run(node, {"image": picture}, output="value")[..., 0]
    assert np.abs(found - expected).max() <= 1e-5 * max(1.0, float(np.abs(sharp).max()))
    ink = run(node, {"image": picture})
    np.testing.assert_allclose(ink[..., 0], decoded(found) * picture[..., 3], rtol=1e-5, atol=1e-6)
    np.testing.assert_array_equal(ink[..., 3], picture[..., 3])


@pytest.mark.parametrize(("sigma", "ratio"), [(1.0, 1.6), (3.0, 2.0)])
def test_dog_is_the_difference(run, hdr, edge, sigma, ratio):
    picture = hdr(33, 20, opaque=True)
    fine, coarse = blurs(picture, sigma, ratio, edge.scipy)
    node = DifferenceOfGaussians(kind="dog", sigma=sigma, ratio=ratio, strength=2.0, edge=edge.name)
    found = run(node, {"image": picture})
    expected = 2.0 * (fine - coarse)
    for channel in range(3):
        assert np.abs(found[..., channel] - expected).max() <= 1e-5 * float(fine.max())


def test_a_flat_picture_is_paper_or_ink(run):
    for light, expected in ((0.5, 1.0), (0.001, 0.0)):
        flat = np.full((9, 12, 4), light, np.float32)
        flat[..., 3] = 1.0
        found = run(DifferenceOfGaussians(phi=50.0, epsilon=0.5), {"image": flat})
        np.testing.assert_allclose(found[..., :3], expected, atol=1e-5)
        found = run(DifferenceOfGaussians(kind="dog", sigma=6.0), {"image": flat})
        np.testing.assert_allclose(found[..., :3], 0.0, atol=2e-5)


def test_turning_the_picture_turns_the_lines(run, hdr):
    picture = hdr(19, 19, opaque=True)
    still, turned = (
        run(DifferenceOfGaussians(), {"image": view.copy()}, output="value") for view in (picture, np.rot90(picture))
    )
    np.testing.assert_allclose(turned, np.rot90(still), atol=1e-4)
