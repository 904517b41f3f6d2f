"""Hue and saturation against colorsys, Haeberli's matrix and the published OKLab."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest
from halation.nodes.color.hue_saturation import HueSaturation

MODES = HueSaturation.values["mode"].choices
WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def assert_close(found: np.ndarray, expected: np.ndarray, wanted: float) -> None:
    scale = np.maximum(np.abs(expected).max(-1, keepdims=True), 1e-3)
    assert (np.abs(found - expected) / scale).max() < wanted


@pytest.mark.parametrize("degrees", [-150.0, 40.0, 180.0])
@pytest.mark.parametrize("saturation", [0.0, 0.5, 1.0, 1.8])
def test_hsv_is_pythons(run, hdr, degrees, saturation):
    picture = hdr(9, 7, opaque=True)

    def turned(rgb: np.ndarray) -> tuple[float, ...]:
        h, s, v = colorsys.rgb_to_hsv(*(rgb.astype(np.float64)))
        return colorsys.hsv_to_rgb((h + degrees / 360) % 1.0, min(s * saturation, 1.0), 1.5 * v)

    out = run(HueSaturation(mode="hsv", hue=degrees, saturation=saturation, value=1.5), {"image": picture})
    assert_close(out[..., :3], np.apply_along_axis(turned, -1, picture[..., :3]), 5e-6)


def haeberli(degrees: float) -> np.ndarray:
    """ "Matrix Operations for Image Processing" (1993): gray to the z axis, sheared so that luminance is z."""
    z = np.ones(3) / np.sqrt(3)
    x = np.array([1, -1, 0]) / np.sqrt(2)
    upright = np.stack([x, np.cross(z, x), z])
    light = upright @ WEIGHTS
    shear = np.array([[1, 0, 0], [0, 1, 0], [light[0] / light[2], light[1] / light[2], 1]])
    turn = np.radians(degrees)
    spin = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    return np.linalg.inv(shear @ upright) @ spin @ shear @ upright


@pytest.mark.parametrize("degrees", [-100.0, 30.0, 180.0])
def test_luminance_is_haeberlis_matrix(run, hdr, degrees):
    picture = hdr(21, 17)
    expected = picture[..., :3].astype(np.float64) @ haeberli(degrees).T
    out = run(HueSaturation(mode="luminance", hue=degrees), {"image": picture})[..., :3]
    assert_close(out, expected, 3e-6)
    assert_close((out @ WEIGHTS)[..., None], (picture[..., :3] @ WEIGHTS)[..., None], 3e-6)


# From the sRGB primaries of IEC 61966-2-1 to XYZ, and Ottosson's two matrices for XYZ.
XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
CONES = np.array(
    [
        [0.8189330101, 0.3618667424, -0.1288597137],
        [0.0329845436, 0.9293118715, 0.0361456387],
        [0.0482003018, 0.2643662691, 0.6338517070],
    ]
)
LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


def oklab(rgb: np.ndarray) -> np.ndarray:
    return np.cbrt(rgb.astype(np.float64) @ (CONES @ XYZ).T) @ LAB.T


@pytest.mark.parametrize("degrees", [-100.0, 30.0, 180.0])
@pytest.mark.parametrize("saturation", [0.0, 0.6, 1.0, 1.4])
def test_perceptual_turns_in_oklab(run, degrees, saturation):
    """Ottosson's shorter matrices, from sRGB, differ from those from XYZ in the fourth digit."""
    rgb = np.random.default_rng(6).uniform(0.3, 1.0, (17, 21, 3))
    picture = np.concatenate([rgb, np.ones((17, 21, 1))], -1).astype(np.float32)
    before = oklab(picture[..., :3])
    after = oklab(run(HueSaturation(hue=degrees, saturation=saturation), {"image": picture})[..., :3])
    turned = (before[..., 1] + 1j * before[..., 2]) * saturation * np.exp(1j * np.radians(degrees))
    expected = np.stack([before[..., 0], turned.real, turned.imag], -1)
    assert (np.abs(after - expected) / before[..., :1]).max() < 1e-3


def test_oklab_is_that_of_the_published_table(run):
    """Ottosson's pairs of XYZ and Lab: black and white keeps L alone, which is L^3 of gray light."""
    xyz = np.array([[0.950, 1.000, 1.089], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    lightness = np.array([1.000, 0.450, 0.922, 0.153])
    rgb = np.linalg.solve(XYZ, xyz.T).T
    picture = np.concatenate([rgb, np.ones((4, 1))], -1)[None]
    out = run(HueSaturation(saturation=0.0), {"image": picture})[0, :, :3]
    assert np.abs(np.cbrt(out) - lightness[:, None]).max() < 1.5e-3


@pytest.mark.parametrize("mode", MODES)
def test_a_turn_back_and_whole_turns_undo(run, mode):
    rgb = np.random.default_rng(5).uniform(0.2, 1.0, (9, 11, 3))
    picture = np.concatenate([rgb, np.ones((9, 11, 1))], -1).astype(np.float32)
    there = run(HueSaturation(mode=mode, hue=25.0), {"image": picture})
    assert_close(run(HueSaturation(mode=mode, hue=-25.0), {"image": there}), picture, 2e-5)
    assert_close(run(HueSaturation(mode=mode, hue=360.0), {"image": picture}), picture, 1e-5)


@pytest.mark.parametrize("mode", MODES)
def test_gray_stays_and_coverage_does_not_matter(run, hdr, mode):
    gray = np.float32([[[0.18, 0.18, 0.18, 1.0]]])
    node = HueSaturation(mode=mode, hue=77.0, saturation=1.5)
    assert np.abs(run(node, {"image": gray}) - gray).max() < 2e-6
    picture = hdr(13, 9, opaque=True)
    half = run(node, {"image": picture * np.float32(0.5)})
    assert_close(half, run(node, {"image": picture}) * 0.5, 5e-6)


def test_a_third_of_a_turn_makes_red_green(run):
    red = np.float32([[[1.0, 0.0, 0.0, 1.0]]])
    assert np.abs(run(HueSaturation(mode="hsv", hue=120.0), {"image": red}) - [0, 1, 0, 1]).max() < 1e-6
    for mode in MODES:
        out = run(HueSaturation(mode=mode, hue=120.0), {"image": red})[0, 0]
        assert out[1] == out[:3].max()


def test_neutral_values_vanish():
    assert HueSaturation().identity() == "image" and HueSaturation(hue=1.0).identity() is None
