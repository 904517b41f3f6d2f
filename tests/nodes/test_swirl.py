"""Swirl against scipy at positions computed in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.distort.swirl import Swirl
from warps import warp_picture, waves


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize(("degrees", "radius"), [(30.0, 1.0), (-200.0, 0.3), (700.0, 0.4)])
def test_it_is_scipys_at_these_positions(run, hdr, edge, size, degrees, radius):
    center = (0.4 * size[0], 0.6 * size[1])

    def source(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        away = (x - center[0]) + 1j * (y - center[1])
        fade = np.exp(-((np.abs(away) / (radius * size[1])) ** 2))
        away = away * np.exp(-1j * np.radians(degrees) * fade)
        return away.real + center[0], away.imag + center[1]

    picture = hdr(*size)
    node = Swirl(angle=degrees, radius=radius, center=(0.4, 0.6), edge=edge.name)
    expected, sure = warp_picture(picture, source, edge.scipy_map)
    error = np.abs(run(node, {"image": picture}) - expected).max(-1)
    assert sure.mean() > 0.9 and error[sure].max() < 1e-5 * picture.max()


def test_the_opposite_angle_takes_it_back(run):
    picture = waves(65, 65)
    there = run(Swirl(angle=90.0), {"image": picture})
    back = run(Swirl(angle=-90.0), {"image": there})
    assert np.abs(there - picture).max() > 0.3 and np.abs(back - picture).max() < 0.02


def test_it_turns_clockwise_and_alike_from_all_sides(run):
    picture = waves(65, 65)
    out = run(Swirl(), {"image": picture})
    assert np.abs(run(Swirl(), {"image": np.rot90(picture).copy()}) - np.rot90(out)).max() < 1e-5
    turned = run(Swirl(angle=90.0, radius=100.0), {"image": picture})
    assert np.abs(turned - np.rot90(picture, -1))[20:-20, 20:-20].max() < 1e-3


def test_no_angle_vanishes():
    assert Swirl(angle=0.0).identity() == "image" and Swirl(radius=0.0).identity() == "image"
