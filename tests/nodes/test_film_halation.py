"""Film halation against the optics of the film base, scipy's Gaussians and distributions, and conservation laws."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.glow import film_halation
from halation.nodes.glow.film_halation import FilmHalation
from scipy.integrate import quad
from scipy.ndimage import correlate1d, gaussian_filter
from scipy.signal import fftconvolve
from scipy.stats import invgamma, norm

ALL_LIGHT = {"threshold": (0.0, 0.0, 0.0), "knee": 0.0, "limit": 65504.0}
PLAIN = {"amount": 1.0, "color": (1.0, 1.0, 1.0, 1.0), **ALL_LIGHT}
INDEX = 1.48
CRITICAL = math.asin(1.0 / INDEX)


def reflected(angle: float) -> float:
    """Fresnel's reflectance of unpolarized light at the back of the base, from within."""
    if angle >= CRITICAL:
        return 1.0
    inside, outside = math.cos(angle), math.sqrt(1.0 - (INDEX * math.sin(angle)) ** 2)
    s = ((INDEX * inside - outside) / (INDEX * inside + outside)) ** 2
    p = ((inside - INDEX * outside) / (inside + INDEX * outside)) ** 2
    return (s + p) / 2.0


def back_within(radius: float) -> float:
    """How much of the light that comes back does so within a radius, in thicknesses of the way (twice the base's).

    Lambert's law: what enters within an angle is its sin^2, and lands at a distance of its tangent.
    """

    def entered(angle: float) -> float:
        return reflected(angle) * 2.0 * math.sin(angle) * math.cos(angle)

    angle = math.atan(radius)
    inner = quad(entered, 0.0, min(angle, CRITICAL), limit=200)[0]
    return inner + max(math.sin(angle) ** 2 - math.sin(CRITICAL) ** 2, 0.0)


def test_the_constants_are_those_of_optics():
    everything = back_within(1e9)
    assert 1.0 - everything == pytest.approx(film_halation._LOST, abs=5e-4)
    assert reflected(1e-9) == pytest.approx(film_halation._STRAIGHT, rel=1e-6)
    ring = 2.0 * 0.13 * math.tan(CRITICAL) / 16.0  # a base of 0.13 mm, a frame 16 mm high
    assert ring == pytest.approx(FilmHalation().radius, abs=2e-4)


def impulse(side: int) -> np.ndarray:
    picture = np.zeros((side, side, 4), np.float32)
    picture[side // 2, side // 2] = 1.0
    return picture


def distance(side: int) -> np.ndarray:
    y, x = np.mgrid[:side, :side] - side // 2
    return np.hypot(x, y)


@pytest.mark.parametrize("radius", [8.0, 11.0, 19.0])
@pytest.mark.parametrize("reach", [1.0, 0.8, 0.6])
def test_the_halo_is_the_ring_of_total_reflection(run, radius, reach):
    side = 257
    node = FilmHalation(**PLAIN, radius=radius / side, reach=(reach, reach, reach))
    found = run(node, {"image": impulse(side)}, output="glow")[..., 0].astype(np.float64)
    away, ring = distance(side), radius * reach
    profile = [found[np.abs(away - r) < 0.5].mean() for r in range(int(3 * ring))]
    assert np.argmax(profile) == pytest.approx(ring, abs=0.1 * ring + 0.5)
    assert profile[0] < 0.45 * max(profile)  # not black, but dark, in the middle
    assert found.min() >= 0.0
    # Beyond the blur of the ring's edge, the light that is farther out than r is the physical one.
    way = ring / math.tan(CRITICAL)
    total = back_within(1e9)
    for r in (1.5, 2.0, 3.0):
        expected = back_within(r * ring / way) / total
        assert found[away < r * ring].sum() == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize("reach", [1.0, 0.85, 0.7, 0.5])
def test_it_is_a_mixture_of_gaussians(run, hdr, reach):
    """By scipy: the inverse gamma distribution of variances that makes Student's, less one Gaussian."""
    picture, radius = hdr(47, 39, opaque=True), 1.5
    way = radius / math.tan(CRITICAL)
    sigmas = np.array(film_halation._SIGMAS)
    bounds = np.r_[0.0, sigmas[:-1] * sigmas[1:], np.inf]
    shares = np.diff(invgamma(1.0, scale=reach**2 / 2.0).cdf(bounds))
    taken = film_halation._LOST / (1.0 - film_halation._STRAIGHT) / 2.0 * reach**2
    less = (1.0 - film_halation._STRAIGHT) * taken * (shares / sigmas**2).sum()

    def soft(sigma: float) -> np.ndarray:
        return blurred(picture[..., :3].astype(np.float64), sigma * way)

    back = sum(share * soft(sigma) for share, sigma in zip(shares, sigmas, strict=True))
    expected = (back - less * soft(math.sqrt(taken))) / (1.0 - less)
    node = FilmHalation(**PLAIN, radius=radius / 39, reach=(reach, reach, reach))
    found = run(node, {"image": picture}, output="glow")[..., :3]
    assert np.abs(found - np.maximum(expected, 0.0)).max() <= 1e-5 * picture.max()


def blurred(image: np.ndarray, sigma: float) -> np.ndarray:
    """A Gaussian by scipy; below one pixel integrated over each, as samples of it would be too narrow."""
    if sigma >= 1.0:
        return gaussian_filter(image, (sigma, sigma, 0.0), mode="nearest")

    reach = math.ceil(4.0 * sigma)
    weights = np.diff(norm(scale=sigma).cdf(np.arange(-reach, reach + 2) - 0.5))
    weights /= weights.sum()
    return correlate1d(correlate1d(image, weights, axis=0, mode="nearest"), weights, axis=1, mode="nearest")


def test_it_is_the_convolution_with_its_point_spread(run, hdr):
    picture = np.pad(hdr(30, 24), ((20, 20), (17, 17), (0, 0)))
    node = FilmHalation(**PLAIN, radius=1.6 / picture.shape[0])
    spread = run(node.with_values(radius=1.6 / 63), {"image": impulse(63)}, output="glow").astype(np.float64)
    found = run(node, {"image": picture}, output="glow")
    for channel in range(3):
        expected = fftconvolve(picture[..., channel].astype(np.float64), spread[..., channel], mode="same")
        assert np.abs(found[..., channel] - expected).max() <= 1e-4 * expected.max()


@pytest.mark.parametrize(("radius", "lost"), [(1.5, 1e-5), (5.0, 1e-4), (18.0, 1e-4)])
def test_a_halo_has_its_share_of_the_light(run, radius, lost):
    side = int(40.0 * radius)
    picture = np.zeros((side, side, 4), np.float32)
    picture[side // 2 - 9 : side // 2 + 9, side // 2 : side // 2 + 3] = (3.0, 2.0, 1.0, 1.0)
    values = {"amount": 0.3, "color": (1.0, 0.4, 0.1, 1.0)}
    found = run(FilmHalation(**ALL_LIGHT | values, radius=radius / side), {"image": picture}, output="glow")
    light = picture[..., :3].sum((0, 1), dtype=np.float64)
    np.testing.assert_allclose(found[..., :3].sum((0, 1), dtype=np.float64), 0.3 * light * [1.0, 0.4, 0.1], rtol=lost)


@pytest.mark.parametrize("radius", [0.0, 0.02, 0.2])
def test_a_flat_picture_stays_flat(run, radius):
    flat = np.full((53, 61, 4), 2.5, np.float32)
    found = run(FilmHalation(**PLAIN, radius=radius), {"image": flat}, output="glow")
    np.testing.assert_allclose(found, flat, rtol=2e-5)


def test_it_is_alike_in_all_directions(run):
    picture = np.zeros((64, 64, 4), np.float32)
    picture[31:33, 31:33] = 40.0
    found = run(FilmHalation(**PLAIN, radius=0.1), {"image": picture}, output="glow")
    for turned in (found[::-1], found[:, ::-1], found.transpose(1, 0, 2)):
        np.testing.assert_allclose(turned[..., :3], found[..., :3], rtol=0.0, atol=2e-6 * float(found.max()))


def test_each_layer_has_its_own_threshold(run):
    light, threshold, knee, limit = np.array([5.0, 1.1, 0.7]), (0.5, 1.0, 2.0), 0.4, 4.0
    width = np.array(threshold) * knee
    above = np.minimum(light, limit) - threshold
    expected = np.maximum(np.clip(above + width, 0.0, 2.0 * width) ** 2 / (4.0 * width + 1e-5), above)
    flat = np.broadcast_to(np.float32([*light, 1.0]), (9, 9, 4)).copy()
    node = FilmHalation(**PLAIN | {"threshold": threshold, "knee": knee, "limit": limit})
    found = run(node, {"image": flat}, output="glow")
    np.testing.assert_allclose(found[4, 4, :3], expected, rtol=2e-5, atol=1e-6)


def test_white_light_has_a_red_orange_halo(run):
    picture = np.zeros((135, 135, 4), np.float32)
    picture[60:75, 60:75] = 20.0
    red, green, blue = run(FilmHalation(), {"image": picture}, output="glow")[67, 79, :3]
    assert red > 3.0 * green > 0.0
    assert green > 3.0 * blue > 0.0


def test_the_halo_joins_the_picture(run, hdr):
    picture = hdr(24, 20)
    glow = run(FilmHalation(), {"image": picture}, output="glow")
    expected = picture + np.float32([1.0, 1.0, 1.0, 0.0]) * glow
    np.testing.assert_allclose(run(FilmHalation(), {"image": picture}), expected, rtol=1e-6)
    np.testing.assert_array_equal(glow[..., 3], picture[..., 3])
    np.testing.assert_array_equal(run(FilmHalation(amount=0.0), {"image": picture}), picture)
