"""Scotopic Vision against numpy in 64 bits, with the matrix that Rec.709's chromaticities imply."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.tone.scotopic_vision import ScotopicVision
from scipy.ndimage import gaussian_filter

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def xyz_matrix():
    """Primaries and white of ITU-R BT.709."""

    def xyz(x, y):
        return np.array([x / y, 1.0, (1 - x - y) / y])

    columns = np.stack([xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06)], -1)
    return columns * np.linalg.solve(columns, xyz(0.3127, 0.3290))


def rods(rgb):
    """Ward Larson et al. 1997."""
    x, y, z = np.moveaxis(np.maximum(rgb, 0) @ xyz_matrix().T, -1, 0)
    return y * (1.33 * (1 + (y + z) / x) - 1.68)


def night(rgb, nits=0.1, amount=1.0, blue_shift=1.0, brightness=1.0, adaptation=None):
    rgb = rgb.astype(np.float64)
    light = nits * (rgb @ WEIGHTS if adaptation is None else adaptation)
    share = amount * (0.04 / (0.04 + light) * np.ones(rgb.shape[:-1]))[..., None]
    seen = brightness * rods(rgb) / rods(np.ones(3))
    tint = 1 + blue_shift * (np.array([1.05, 0.97, 1.27]) - 1)
    return rgb * (1 - share) + seen[..., None] * tint * share


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"nits": 0.003},
        {"nits": 8.0},
        {"amount": 0.4},
        {"blue_shift": 0.0},
        {"blue_shift": 1.8, "brightness": 0.5},
    ],
    ids=str,
)
def test_color_is_the_papers_formula(run, hdr, values):
    picture = hdr(37, 23, opaque=True)
    found = run(ScotopicVision(blur=0.0, **values), {"image": picture})
    expected = night(picture[..., :3], **values)
    assert (np.abs(found[..., :3] - expected) / np.maximum(expected, 1.0)).max() < 2e-6
    assert np.array_equal(found[..., 3], picture[..., 3])


@pytest.mark.parametrize(("light", "share"), [(1e-3, 0.9756), (0.01, 0.80), (0.1, 0.286), (1.0, 0.038)])
def test_rods_take_over(run, light, share):
    """The share of rods by luminance (Krawczyk et al. 2005): what green becomes, without its own color."""
    picture = np.array([[[0.0, light / 0.7152, 0.0, 1.0]]], np.float32)
    found = run(ScotopicVision(blur=0.0, nits=1.0, blue_shift=0.0), {"image": picture})[0, 0]
    seen = rods(picture[..., :3].astype(np.float64)).item() / rods(np.ones(3))
    assert found[0] / seen == pytest.approx(share, abs=1e-3)
    assert found[1] == pytest.approx((1 - found[0] / seen) * picture[0, 0, 1] + found[0], rel=1e-5)


def test_reds_go_dark_and_blues_bright(run):
    """The Purkinje shift, with white in between: XYZ of the primaries in four digits."""
    picture = np.array([[[1, 0, 0, 1], [0, 0, 1, 1], [1, 1, 1, 1]]], np.float32)
    found = run(ScotopicVision(blur=0.0, nits=0.0, blue_shift=0.0), {"image": picture})[0, :, 0]
    red = 0.2126 * (1.33 * (1 + (0.2126 + 0.0193) / 0.4124) - 1.68)
    blue = 0.0722 * (1.33 * (1 + (0.0722 + 0.9505) / 0.1805) - 1.68)
    white = 1.33 * (1 + 2.0890 / 0.9505) - 1.68
    assert found == pytest.approx([red / white, blue / white, 1.0], rel=1e-3)
    assert found[0] / 0.2126 < 0.2 and found[1] / 0.0722 > 2.5


def test_the_eye_may_be_used_to_another_light(run, hdr):
    picture = hdr(19, 17, opaque=True)
    linked = {"image": picture, "adaptation": np.full((1, 1), 0.7)}
    found = run(ScotopicVision(blur=0.0), linked)[..., :3]
    expected = night(picture[..., :3], adaptation=0.7)
    assert (np.abs(found - expected) / np.maximum(expected, 1.0)).max() < 2e-6


def width(light):
    """Sigma in degrees: the fit of Ward Larson et al. 1997, less what is left in bright light."""
    finest = 17.25 * np.arctan(1.4 * np.log10(light) + 0.35) + 25.72
    return np.sqrt(finest**-2 - (17.25 * np.pi / 2 + 25.72) ** -2) / 1.86


@pytest.mark.parametrize(("light", "field_of_view"), [(0.001, 4.0), (0.01, 2.0), (0.1, 0.8), (1.0, 0.4)])
def test_sharpness_follows_the_light(run, light, field_of_view):
    """The variance of the blur of a point, seen by eyes used to this luminance."""
    picture = np.zeros((65, 65, 4), np.float32)
    picture[..., 3] = 1.0
    picture[32, 32, :3] = 1.0
    linked = {"image": picture, "adaptation": np.full((1, 1), light)}
    node = ScotopicVision(nits=1.0, field_of_view=field_of_view, blue_shift=0.0)
    spread = run(node, linked)[..., 1].astype(np.float64)
    x = np.arange(65) - 32
    variance = (spread.sum(0) * x**2).sum() / spread.sum()
    assert variance == pytest.approx((width(light) * 65 / field_of_view) ** 2, rel=1e-3)
    assert spread.sum() == pytest.approx(1.0, abs=1e-4)


def test_the_darkest_is_a_gaussian(run, hdr):
    """In the dark, where stripes of 2 cycles per degree are the finest."""
    picture = hdr(41, 33, opaque=True)
    found = run(ScotopicVision(nits=0.0, field_of_view=10.0), {"image": picture})[..., :3]
    sigma = 41 / 10 / 1.86 * np.sqrt(2.0**-2 - (17.25 * np.pi / 2 + 25.72) ** -2)
    seen = run(ScotopicVision(nits=0.0, blur=0.0), {"image": picture})[..., :3].astype(np.float64)
    expected = gaussian_filter(seen, (sigma, sigma, 0), mode="nearest")
    assert sigma > 1.0
    assert (np.abs(found - expected) / np.maximum(expected, 1.0)).max() < 1e-5


def test_bright_light_is_seen_as_it_is(run, hdr):
    picture = hdr(31, 21, opaque=True)
    picture[..., :3] += 1.0
    found = run(ScotopicVision(nits=1e6), {"image": picture})
    np.testing.assert_allclose(found, picture, rtol=1e-4)


def test_coverage_does_not_change_the_color(run, hdr):
    picture = hdr(23, 17, opaque=True)
    whole = run(ScotopicVision(blur=0.0), {"image": picture})
    assert np.abs(run(ScotopicVision(blur=0.0), {"image": picture * 0.5}) - whole * 0.5).max() < 1e-4
    assert ScotopicVision(amount=0.0).identity() == "image"


@pytest.mark.parametrize("size", [(1, 1), (1, 13), (9, 2)])
def test_black_stays_black(run, size):
    picture = np.zeros((*size, 4), np.float32)
    picture[..., 3] = 1.0
    assert not run(ScotopicVision(), {"image": picture})[..., :3].any()
