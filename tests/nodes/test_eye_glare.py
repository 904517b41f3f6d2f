"""Glare of the eye against the formulas of Spencer et al. (1995) in 64 bits, scipy's convolution, and conservation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.glow.eye_glare import EyeGlare
from scipy.integrate import quad
from scipy.signal import fftconvolve

# Shares of f0 (not scattered), f1, f2 and f3.
SHARES = {
    "photopic": (0.384, 0.478, 0.138, 0.0),
    "mesopic": (0.368, 0.478, 0.138, 0.016),
    "scotopic": (0.282, 0.478, 0.207, 0.033),
}


def f1(t):
    return 20.91 / (t + 0.02) ** 3


def f2(t):
    return 72.37 / (t + 0.02) ** 2


def f3(t, nm):
    return 436.9 * (568.0 / nm) * np.exp(-((t - 3.0 * nm / 568.0) ** 2) * 19.75)


def lobe(nm, middle, below, above):
    return np.exp(-0.5 * ((nm - middle) / np.where(nm < middle, below, above)) ** 2)


def colors(nm: np.ndarray) -> np.ndarray:
    """The observer by Wyman, Sloan and Shirley (2013), in the primaries of ITU-R BT.709."""
    x = 1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2)
    y = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1)
    z = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)
    primaries = np.array([[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]]).T
    white = np.array([0.3127, 0.3290, 0.3583]) / 0.3290
    to_xyz = primaries * np.linalg.solve(primaries, white)
    return np.maximum(np.linalg.solve(to_xyz, np.stack([x, y, z])), 0.0)


NM = np.arange(400.0, 701.0, 5.0)
COLORS = colors(NM)
COLORS /= COLORS.sum(axis=1, keepdims=True)


FINE = np.linspace(0.0, 7.0, 14001)
HALO = np.einsum("cw,wt->ct", COLORS, np.stack([f3(FINE, nm) for nm in NM]))


def halo(t: np.ndarray) -> np.ndarray:
    """By channel, of white light."""
    return np.stack([np.interp(t, FINE, channel) for channel in HALO], axis=-1)


def spread(vision: str, degrees: float, reach: tuple[int, int]) -> np.ndarray:
    """What pixels get of the one in the middle, integrated over each; the middle is left out."""
    x, y = np.arange(-reach[0] + 1, reach[0]), np.arange(-reach[1] + 1, reach[1])
    found = integrated(vision, degrees, x, y, 12)
    near_x, near_y = abs(x) <= 2, abs(y) <= 2
    found[np.ix_(near_y, near_x)] = integrated(vision, degrees, x[near_x], y[near_y], 100)
    found[reach[1] - 1, reach[0] - 1] = 0.0
    return found


def integrated(vision: str, degrees: float, x: np.ndarray, y: np.ndarray, samples: int) -> np.ndarray:
    """Over pixels that many degrees wide, by samples along each axis."""
    _, a, b, c = SHARES[vision]
    inside = (np.arange(samples) + 0.5) / samples - 0.5
    found = np.zeros((len(y), len(x), 3))
    for down in inside:
        for across in inside:
            t = degrees * np.hypot(y[:, None] + down, x + across)
            found += (a * f1(t) + b * f2(t))[..., None]
            if c:
                found += c * halo(t)
    return found / samples**2 * math.radians(degrees) ** 2


def scattered(picture: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    height, width = picture.shape[:2]
    down, across = kernel.shape[0] // 2, kernel.shape[1] // 2
    whole = [fftconvolve(picture[..., c].astype(np.float64), kernel[..., c]) for c in range(3)]
    return np.stack(whole, axis=-1)[down : down + height, across : across + width]


@pytest.mark.parametrize("term", [f1, f2, lambda t: f3(t, 568.0), lambda t: f3(t, 450.0)])
def test_the_terms_of_the_reference_are_of_the_whole_light(term):
    """The paper's own check: each is 1 over the half of all directions."""

    def ring(t):
        return term(t) * math.sin(math.radians(t)) * 2.0 * math.pi * math.radians(1.0)

    assert quad(ring, 0.0, 90.0, points=[0.05, 1.0, 2.5, 3.0], limit=200)[0] == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("vision", SHARES)
@pytest.mark.parametrize(("size", "view"), [((48, 40), 14.0), ((9, 33), 60.0)])
def test_a_point_becomes_the_published_spread(run, vision, size, view):
    width, height = size
    picture = np.zeros((height, width, 4), np.float32)
    picture[height // 2, width // 3] = 1.0
    node = EyeGlare(vision=vision, field_of_view=view, rays=0.0)
    wanted = scattered(picture, spread(vision, view / height, size))
    found = run(node, {"image": picture}, output="glow")[..., :3]
    assert np.abs(found - wanted).max() <= 1e-3 * wanted.max()
    out = run(node, {"image": picture})[..., :3]
    assert np.abs(out - wanted - (picture[..., :3] * (1.0 - wanted.sum((0, 1))))).max() <= 2e-5


@pytest.mark.parametrize("vision", ["photopic", "scotopic"])
def test_it_is_the_convolution_with_the_spread(run, hdr, vision):
    picture = hdr(41, 36, opaque=True)
    kernel = spread(vision, 20.0 / 36.0, (41, 36))
    wanted = scattered(picture, kernel)
    node = EyeGlare(vision=vision, field_of_view=20.0, rays=0.0)
    found = run(node, {"image": picture}, output="glow")[..., :3]
    assert np.abs(found - wanted).max() <= 1e-4 * picture[..., :3].max()
    assert np.abs(found - wanted).max() <= 1e-3 * wanted.max()


@pytest.mark.parametrize("point", [(60, 60), (31, 91)])
def test_what_is_spread_at_a_smaller_size_is_the_same(run, point):
    """At this angle all but the middle is spread at a quarter and less of the size."""
    size, view = 121, 3.0
    picture = np.zeros((size, size, 4), np.float32)
    picture[point] = 1000.0
    kernel = spread("photopic", view / size, (size, size))
    wanted = scattered(picture, kernel)
    found = run(EyeGlare(vision="photopic", field_of_view=view, rays=0.0), {"image": picture}, output="glow")[..., :3]
    assert np.abs(found - wanted).max() <= 1e-3 * wanted.max()
    away = np.hypot(*np.mgrid[-point[0] : size - point[0], -point[1] : size - point[1]])
    far = away > 6.0
    assert np.abs(found[far] / wanted[far] - 1.0).max() <= 0.02
    assert found.sum() == pytest.approx(wanted.sum(), rel=1e-3)


@pytest.mark.parametrize(("channel", "name"), [(0, "red"), (1, "green"), (2, "blue")])
def test_the_halo_lies_where_its_wavelength_says(run, channel, name):
    size, view = 181, 9.0
    picture = np.zeros((size, size, 4), np.float32)
    picture[size // 2, size // 2] = 1000.0
    night, day = (
        run(EyeGlare(vision=vision, field_of_view=view, rays=0.0), {"image": picture}, output="glow")
        for vision in ("mesopic", "photopic")
    )
    ring = (night - day)[size // 2, size // 2 :, channel].astype(np.float64) / 1000.0
    angle = np.arange(len(ring)) * view / size
    middle = (ring * angle).sum() / ring.sum()
    mean = (COLORS[channel] * NM * 568.0 / NM).sum() / (COLORS[channel] * 568.0 / NM).sum()
    assert middle == pytest.approx(3.0 * mean / 568.0, abs=0.01), name
    amount = 0.016 * 436.9 * (COLORS[channel] * 568.0 / NM).sum() * math.sqrt(math.pi / 19.75)
    assert ring.sum() * view / size == pytest.approx(amount * math.radians(view / size) ** 2, rel=5e-3)


@pytest.mark.parametrize(
    "values",
    [
        {"field_of_view": 3.0},
        {"field_of_view": 40.0},
        {"field_of_view": 4.0, "rays": 1.0},
        {"vision": "photopic"},
    ],
)
@pytest.mark.parametrize("size", [(130, 121), (17, 9), (1, 1)])
def test_an_even_picture_stays_even(run, values, size):
    flat = np.full((size[1], size[0], 4), 2.5, np.float32)
    found = run(EyeGlare(**{"vision": "mesopic", **values}), {"image": flat})
    # Gray stays gray but near the border, where colors lose different parts of their halo.
    assert np.abs(found - flat).max() <= (2e-5 if values.get("vision") == "photopic" else 2.5 * 0.016)
    assert np.abs(found[..., :3].mean(-1) - 2.5).max() <= 5e-5


@pytest.mark.parametrize("view", [3.0, 30.0])
def test_light_is_neither_made_nor_lost(run, hdr, view):
    picture = hdr(133, 120, opaque=True)
    found = run(EyeGlare(vision="photopic", field_of_view=view, rays=0.0), {"image": picture})
    assert found.sum(dtype=np.float64) == pytest.approx(picture.sum(dtype=np.float64), rel=1e-5)
    assert (found > 0.0).all()


def test_rays_leave_the_mean_of_every_ring(run):
    size = 201
    picture = np.zeros((size, size, 4), np.float32)
    picture[size // 2, size // 2] = 1.0
    even, rayed = (
        run(EyeGlare(field_of_view=40.0, rays=rays), {"image": picture}, output="glow")[..., 1] for rays in (0.0, 1.0)
    )
    away = np.hypot(*np.mgrid[-(size // 2) : size // 2 + 1, -(size // 2) : size // 2 + 1])
    for first in (30, 50, 70):
        ring = (away >= first) & (away < first + 20)
        assert rayed[ring].mean() == pytest.approx(even[ring].mean(), rel=0.1)
        assert (rayed[ring] / even[ring]).std() > 0.1


def test_a_proxy_looks_the_same(run):
    picture = np.zeros((160, 160, 4), np.float32)
    picture[60:80, 90:110] = 30.0
    node = EyeGlare(field_of_view=12.0, rays=0.0)
    whole, half = run(node, {"image": picture}), run(node, {"image": picture}, scale=0.5)
    smaller = whole.reshape(80, 2, 80, 2, 4).mean((1, 3))
    dark = np.ones((80, 80), bool)
    dark[26:44, 41:59] = False
    np.testing.assert_allclose(half[dark], smaller[dark], rtol=0.03, atol=1e-5)


def test_no_strength_changes_nothing_and_half_is_half(run, hdr):
    picture = hdr(33, 27)
    np.testing.assert_array_equal(run(EyeGlare(strength=0.0), {"image": picture}), picture)
    whole, half = (run(EyeGlare(strength=strength), {"image": picture}) for strength in (1.0, 0.5))
    np.testing.assert_allclose(half, 0.5 * (picture + whole), rtol=1e-5, atol=1e-4)
    np.testing.assert_array_equal(whole[..., 3], picture[..., 3])


@pytest.mark.parametrize("hole", [np.nan, np.inf, -np.inf, 3e38])
def test_a_hole_does_not_spread(run, hdr, hole):
    picture = hdr(33, 29)
    picture[14, 15, 0] = hole
    assert np.isfinite(run(EyeGlare(), {"image": picture})).all()
    assert np.isfinite(run(EyeGlare(), {"image": picture}, output="glow")).all()
