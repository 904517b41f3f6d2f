"""The star against scipy's Gaussian along rows and columns, and against the closed form of a turned Gaussian."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.glow.star import Star
from scipy.ndimage import gaussian_filter1d

ALL_LIGHT = {"threshold": 0.0, "knee": 0.0}


def both(picture: np.ndarray, sigma: float, mode: str) -> np.ndarray:
    """The lecture's star of all light, in 64 bits."""
    wide = picture.astype(np.float64)
    return sum(gaussian_filter1d(wide, sigma, axis=axis, mode=mode) for axis in (0, 1)) / 2.0


@pytest.mark.parametrize("size", [(64, 40), (33, 17), (1, 9), (1, 1)])
@pytest.mark.parametrize("angle", [0.0, 90.0, -180.0])
def test_it_is_the_lectures_formula(run, hdr, edge, size, angle):
    picture, sigma = hdr(*size), min(3.7, size[1])
    node = Star(length=sigma / size[1], angle=angle, intensity=0.8, edge=edge.name, **ALL_LIGHT)
    expected = picture + 0.8 * both(picture, sigma, edge.scipy)
    found = run(node, {"image": picture})
    assert np.abs(found - expected)[..., :3].max() <= 1e-5 * expected.max()
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


def test_long_arms_are_scipys_too(run, hdr):
    picture = np.pad(hdr(40, 30), ((60, 60), (80, 80), (0, 0)))
    expected = both(picture, 25.0, "constant")
    found = run(Star(angle=0.0, length=25.0 / picture.shape[0], **ALL_LIGHT), {"image": picture}, output="glow")
    assert np.abs(found - expected)[..., :3].max() <= 1e-3 * expected.max()


@pytest.mark.parametrize("angle", [0.0, 15.0, 30.0, 45.0, -20.0, 110.0])
def test_a_turned_star_on_a_round_light(run, angle):
    """A Gaussian stays one along u and v, of the sum of the variances: the star of it is known at any angle."""
    side, soft, sigma = 129, 5.0, 14.0
    y, x = np.mgrid[:side, :side] - side // 2
    turn = np.radians(angle)
    u, v = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)

    def arm(along, across):
        wide = np.hypot(soft, sigma)
        return soft / wide * np.exp(-0.5 * ((along / wide) ** 2 + (across / soft) ** 2))

    picture = np.repeat(np.exp(-0.5 * (x**2 + y**2) / soft**2)[..., None], 4, axis=-1).astype(np.float32)
    expected = (arm(u, v) + arm(v, u)) / 2.0
    found = run(Star(length=sigma / side, angle=angle, **ALL_LIGHT), {"image": picture}, output="glow")[..., 1]
    # Bilinear sampling, twice, takes h^2 f'' / 8 along each axis from a peak: 4 / 8 / 5^2 of it at most.
    assert np.abs(found - expected).max() <= (1e-3 if angle == 0.0 else 0.02) * expected.max()
    assert found.sum(dtype=np.float64) == pytest.approx(expected.sum(), rel=2e-3)


@pytest.mark.parametrize(("angle", "lost"), [(0.0, 1e-4), (27.0, 0.03), (45.0, 0.07)])
def test_the_light_is_kept(run, angle, lost):
    """In the middle of darkness nothing is lost; turned, single pixels fall between samples."""
    picture = np.zeros((120, 120, 4), np.float32)
    picture[61, 57, :3] = 1.5
    found = run(Star(length=0.05, angle=angle, **ALL_LIGHT), {"image": picture}, output="glow")[..., :3]
    assert found.sum(dtype=np.float64) == pytest.approx(4.5, rel=lost)
    assert found.min() >= 0.0


@pytest.mark.parametrize("angle", [0.0, 33.0])
def test_a_flat_picture_stays_flat_where_edges_go_on(run, angle):
    flat = np.full((37, 53, 4), 2.5, np.float32)
    found = run(Star(angle=angle, edge="clamp", **ALL_LIGHT), {"image": flat}, output="glow")
    np.testing.assert_allclose(found, flat, rtol=1e-5)


def test_only_bright_light_makes_a_star(run):
    picture = np.full((32, 32, 4), 0.4, np.float32)
    np.testing.assert_array_equal(run(Star(angle=20.0), {"image": picture}), picture)


def test_the_tint_colors_the_star_only(run, hdr):
    picture, tint = hdr(24, 20), (0.9, 0.3, 0.1, 0.0)
    plain = run(Star(angle=0.0), {"image": picture}, output="glow")
    glow = run(Star(angle=0.0, tint=tint), {"image": picture}, output="glow")
    np.testing.assert_allclose(glow, plain * np.float32([0.9, 0.3, 0.1, 1.0]), rtol=1e-6)
    found = run(Star(angle=0.0, tint=tint, intensity=0.3), {"image": picture})
    np.testing.assert_allclose(found[..., :3], (picture + 0.3 * glow)[..., :3], rtol=1e-6)


def test_no_intensity_changes_nothing(run, hdr):
    picture = hdr(19, 23)
    np.testing.assert_array_equal(run(Star(intensity=0.0), {"image": picture}), picture)
