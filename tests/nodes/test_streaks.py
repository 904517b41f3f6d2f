"""Streaks against the geometric series that Kawase's passes stand for, in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.glow.streaks import Streaks
from scipy.ndimage import correlate1d, map_coordinates

ALL_LIGHT = {"threshold": 0.0, "knee": 0.0, "limit": 65504.0}
WAVES = np.array([611.0, 549.0, 464.0])


def fades(length: float, dispersion: float = 0.0) -> np.ndarray:
    """The factor from pixel to pixel, for red, green and blue: a hundredth is left at each one's length."""
    return 0.01 ** (1.0 / (length * (WAVES / WAVES[1]) ** dispersion))


def count(length: float, dispersion: float = 0.0) -> int:
    """Samples: the first power of 4 that reaches one and a half of the longest length."""
    return 4 ** math.ceil(math.log(1.5 * length * (WAVES[0] / WAVES[1]) ** dispersion, 4.0))


def arm(picture: np.ndarray, axis: int, sign: int, fade: np.ndarray, terms: int, mode: str) -> np.ndarray:
    """The mean of `terms` pixels back along an axis, each `fade` times as heavy, in 64 bits. No pass is repeated."""
    found = np.empty((*picture.shape[:2], 3))
    for channel in range(3):
        series = fade[channel] ** np.arange(terms) * (1.0 - fade[channel]) / (1.0 - fade[channel] ** terms)
        weights = np.zeros(2 * terms - 1)
        weights[terms - 1 :: -sign if sign > 0 else 1][:terms] = series
        found[..., channel] = correlate1d(picture[..., channel].astype(np.float64), weights, axis=axis, mode=mode)
    return found


@pytest.mark.parametrize("size", [(61, 23), (17, 40), (1, 9)])
@pytest.mark.parametrize(("length", "dispersion"), [(2.0, 0.0), (9.0, 1.0), (23.0, 3.0)])
@pytest.mark.parametrize(("edge", "mode"), [("black", "constant"), ("clamp", "nearest")])
def test_straight_arms_are_the_geometric_series(run, hdr, size, length, dispersion, edge, mode):
    picture = hdr(*size)
    length = min(length, 3.0 * size[1])
    fade, terms = fades(length, dispersion), count(length, dispersion)
    for angle, axis in ((0.0, 1), (90.0, 0)):
        node = Streaks(
            arms=2,
            angle=angle,
            length=length / size[1],
            dispersion=dispersion,
            quality="full",
            edge=edge,
            **ALL_LIGHT,
        )
        expected = sum(arm(picture, axis, sign, fade, terms, mode) for sign in (1, -1)) / 2.0
        found = run(node, {"image": picture}, output="glow")
        assert np.abs(found[..., :3] - expected).max() <= 1e-5 * expected.max()
        np.testing.assert_array_equal(found[..., 3], picture[..., 3])


@pytest.mark.parametrize(("angle", "place"), [(0.0, (0, 1)), (90.0, (-1, 0)), (180.0, (0, -1)), (-90.0, (1, 0))])
def test_an_arm_points_where_the_angle_says(run, angle, place):
    picture = np.zeros((21, 21, 4), np.float32)
    picture[10, 10, :3] = 1.0
    node = Streaks(arms=1, angle=angle, length=0.2, dispersion=0.0, quality="full", **ALL_LIGHT)
    found = run(node, {"image": picture}, output="glow")[..., 0].astype(np.float64)
    peak, next_one = found[10, 10], found[10 + place[0], 10 + place[1]]
    assert next_one == pytest.approx(peak * fades(0.2 * 21)[0], rel=1e-5)
    assert found[10 - place[0], 10 - place[1]] == pytest.approx(0.0, abs=1e-5 * float(peak))


@pytest.mark.parametrize("angle", [15.0, 45.0, -70.0])
@pytest.mark.parametrize("arms", [1, 3, 16])
def test_slanted_arms_of_a_soft_light(run, angle, arms):
    """The sum over copies of a Gaussian, exactly placed; bilinear samples are off by h^2 f'' / 8 a pass at most."""
    side, soft, length = 97, 6.0, 20.0
    y, x = np.mgrid[:side, :side] - side // 2
    fade, terms = fades(length)[1], count(length)
    expected = np.zeros((side, side))
    for turn in np.radians(angle) + 2.0 * np.pi * np.arange(arms) / arms:
        for n in range(terms):
            away = (x - n * np.cos(turn)) ** 2 + (y + n * np.sin(turn)) ** 2
            expected += fade**n * np.exp(-0.5 * away / soft**2)
    expected *= (1.0 - fade) / (1.0 - fade**terms) / arms
    picture = np.repeat(np.exp(-0.5 * (x**2 + y**2) / soft**2)[..., None], 4, axis=-1).astype(np.float32)
    node = Streaks(arms=arms, angle=angle, length=length / side, dispersion=0.0, quality="full", **ALL_LIGHT)
    found = run(node, {"image": picture}, output="glow")[..., 1]
    passes = round(math.log(terms, 4.0))
    assert np.abs(found - expected).max() <= passes * 2.0 / 8.0 / soft**2 * expected.max()


@pytest.mark.parametrize("quality", ["full", "half", "quarter"])
@pytest.mark.parametrize("angle", [0.0, 45.0])
def test_the_light_is_kept(run, quality, angle):
    picture = np.zeros((160, 168, 4), np.float32)
    picture[79:82, 85:89, :3] = (3.0, 2.0, 1.0)
    node = Streaks(arms=4, angle=angle, length=0.1, quality=quality, **ALL_LIGHT)
    found = run(node, {"image": picture}, output="glow")[..., :3]
    assert found.sum(dtype=np.float64) == pytest.approx(72.0, rel=1e-5 if angle == 0.0 else 1e-3)
    assert found.min() >= 0.0


@pytest.mark.parametrize("quality", ["full", "half", "quarter"])
@pytest.mark.parametrize("angle", [0.0, 33.0])
def test_a_flat_picture_stays_flat_where_edges_go_on(run, quality, angle):
    flat = np.full((37, 53, 4), 2.5, np.float32)
    node = Streaks(arms=5, angle=angle, quality=quality, edge="clamp", **ALL_LIGHT)
    np.testing.assert_allclose(run(node, {"image": flat}, output="glow"), flat, rtol=1e-5)


def test_smaller_sizes_are_the_series_of_block_means(run, hdr):
    """Half the size: means of 2 x 2, the series of half the length, and bilinear enlargement by scipy."""
    picture, length = hdr(48, 32), 10.0
    blocks = picture.reshape(16, 2, 24, 2, 4).mean((1, 3), dtype=np.float64)
    fade, terms = fades(length / 2.0), count(length / 2.0)
    small = sum(arm(blocks, 1, sign, fade, terms, "nearest") for sign in (1, -1)) / 2.0
    y, x = (np.mgrid[:32, :48] + 0.5) / 2.0 - 0.5
    parts = [map_coordinates(part, [y, x], order=1, mode="nearest") for part in np.moveaxis(small, -1, 0)]
    expected = np.stack(parts, axis=-1)
    node = Streaks(arms=2, angle=0.0, length=length / 32, dispersion=0.0, edge="clamp", **ALL_LIGHT)
    found = run(node, {"image": picture}, output="glow")[..., :3]
    assert np.abs(found - expected).max() <= 1e-5 * expected.max()


def test_red_reaches_farther_than_blue(run):
    picture = np.zeros((33, 33, 4), np.float32)
    picture[16, 16, :3] = 1.0
    found = run(Streaks(angle=0.0, quality="full", dispersion=2.0, **ALL_LIGHT), {"image": picture}, output="glow")
    assert found[16, 16, 0] < found[16, 16, 1] < found[16, 16, 2]
    assert found[16, 32, 0] > found[16, 32, 1] > found[16, 32, 2]


def test_the_streaks_join_the_picture(run, hdr):
    picture = hdr(24, 20)
    values = {"tint": (0.9, 0.3, 0.1, 1.0), "intensity": 0.7, "threshold": 0.5}
    glow = run(Streaks(**values), {"image": picture}, output="glow")
    expected = picture + np.float32([0.7, 0.7, 0.7, 0.0]) * glow
    np.testing.assert_allclose(run(Streaks(**values), {"image": picture}), expected, rtol=1e-6)
    plain = run(Streaks(threshold=0.5), {"image": picture}, output="glow")
    np.testing.assert_allclose(glow, plain * np.float32([0.9, 0.3, 0.1, 1.0]), rtol=1e-5)


@pytest.mark.parametrize("values", [{"intensity": 0.0}, {"threshold": 60000.0}])
def test_nothing_changes_without_light(run, hdr, values):
    picture = np.minimum(hdr(19, 23), 1e3)
    np.testing.assert_array_equal(run(Streaks(**values), {"image": picture}), picture)
