"""Bulge against scipy at positions computed in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.bulge import Bulge
from warps import warp_picture, waves


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize("strength", [0.7, -0.6, -3.0])
def test_it_is_scipys_at_these_positions(run, hdr, edge, size, strength):
    center, radius = (0.4 * size[0], 0.6 * size[1]), 0.6 * size[1]

    def source(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        dx, dy = x - center[0], y - center[1]
        factor = 1 - strength * np.maximum(1 - (dx * dx + dy * dy) / radius**2, 0) ** 2
        return center[0] + dx * factor, center[1] + dy * factor

    picture = hdr(*size)
    node = Bulge(strength=strength, radius=0.6, center=(0.4, 0.6), edge=edge.name)
    expected, sure = warp_picture(picture, source, edge.scipy_map)
    error = np.abs(run(node, {"image": picture}) - expected).max(-1)
    assert sure.mean() > 0.9 and error[sure].max() < 1e-5 * picture.max()


def test_the_middle_is_magnified_and_the_outside_stays(run):
    y, x = np.mgrid[:81, :81] - 40.0
    ramp = np.stack([x, y, x * 0, x * 0 + 1], -1)
    out = run(Bulge(strength=0.5, radius=0.4), {"image": ramp})
    assert np.abs(out[40, 42, 0] - 1.0) < 0.01 and np.abs(out[38, 40, 1] + 1.0) < 0.01
    outside = np.hypot(x, y) > 0.4 * 81 + 1
    assert np.abs(out - ramp)[outside].max() < 1e-4


def test_it_is_alike_from_all_sides(run):
    picture = waves(49, 49)
    out = run(Bulge(strength=-2.0), {"image": picture})
    assert np.abs(run(Bulge(strength=-2.0), {"image": np.rot90(picture).copy()}) - np.rot90(out)).max() < 1e-5


def test_no_strength_vanishes():
    assert Bulge(strength=0.0).identity() == "image" and Bulge(radius=0.0).identity() == "image"
