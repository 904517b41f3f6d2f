"""Chromatic aberration against scipy's interpolation and sums in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.chromatic_aberration import ChromaticAberration
from warps import sample_bilinear


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize("shape", ["radial", "straight"])
@pytest.mark.parametrize("samples", [3, 10, 21])
def test_it_is_a_sum_over_the_spectrum(run, hdr, edge, size, shape, samples):
    picture, center = hdr(*size), (0.4 * size[0], 0.6 * size[1])
    y, x = np.mgrid[: size[1], : size[0]] + 0.5
    if shape == "radial":
        dx, dy = ((0.1 * size[1]) * away / (size[1] / 2) for away in (x - center[0], y - center[1]))
    else:
        dx, dy = (0.1 * size[1] * part(np.radians(30)) for part in (np.cos, np.sin))
    places = np.linspace(-1, 1, samples)
    response = np.stack([np.maximum(-places, 0), 1 - np.abs(places), np.maximum(places, 0), np.ones(samples)], -1)
    response /= response.sum(0)
    expected = sum(
        weight * sample_bilinear(picture, x + place * dx, y + place * dy, edge.scipy_map)
        for weight, place in zip(response, places, strict=True)
    )
    node = ChromaticAberration(shape=shape, amount=0.1, angle=30.0, samples=samples, center=(0.4, 0.6), edge=edge.name)
    assert np.abs(run(node, {"image": picture}) - expected).max() < 1e-5 * picture.max()


def test_no_light_is_lost(run):
    point = np.zeros((32, 48, 4), np.float32)
    point[16, 24] = 3.0
    out = run(ChromaticAberration(shape="straight", amount=0.1, samples=32), {"image": point})
    assert np.abs(out.sum((0, 1)) - 3.0).max() < 1e-5
    even = np.full((9, 13, 4), 0.37)
    assert np.abs(run(ChromaticAberration(), {"image": even}) - 0.37).max() < 1e-6


def test_red_goes_where_it_says_and_blue_the_other_way(run):
    point = np.zeros((32, 48, 4), np.float32)
    point[16, 24] = 1.0
    out = run(ChromaticAberration(shape="straight", amount=0.1, samples=33), {"image": point})
    x = np.arange(48)
    red, green, blue = (float((out[16, :, channel] * x).sum() / out[16, :, channel].sum()) for channel in range(3))
    assert red - 24 == pytest.approx(24 - blue, abs=1e-3) and red > 25.5 and green == pytest.approx(24, abs=1e-3)


def test_the_center_stays_sharp_and_no_amount_vanishes(run, hdr):
    picture = hdr(33, 33)
    out = run(ChromaticAberration(amount=0.05), {"image": picture})
    assert np.abs(out - picture)[16, 16].max() < 1e-6 * picture.max()
    assert ChromaticAberration(amount=0.0).identity() == "image"
