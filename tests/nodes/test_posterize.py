"""Posterize against numpy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.color.posterize import Posterize

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def encode(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decode(code: np.ndarray) -> np.ndarray:
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def same(light: np.ndarray) -> np.ndarray:
    return light


SPACES = {"display": (encode, decode), "linear": (same, same)}


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("levels", [2, 5, 16])
@pytest.mark.parametrize("channels", ["luminance", "separate"])
def test_it_is_rounding(run, hdr, space, levels, channels):
    picture = hdr(23, 17, opaque=True)
    there, back = SPACES[space]
    rgb = picture[..., :3].astype(np.float64)
    light = rgb if channels == "separate" else (rgb @ WEIGHTS)[..., None]
    steps = there(light) * (levels - 1)
    expected = rgb / light * back(np.floor(steps + 0.5) / (levels - 1))
    clear = np.abs(steps % 1.0 - 0.5) > 1e-4  # at a half, the last bit decides
    out = run(Posterize(levels=levels, space=space, channels=channels), {"image": picture})[..., :3]
    error = np.abs(out - expected) / np.maximum(expected, 1.0)
    assert clear.mean() > 0.99 and np.where(clear, error, 0.0).max() < 1e-5


def test_there_are_as_many_levels_as_asked_for(run):
    ramp = np.linspace(0, 1, 1001)
    picture = np.stack([ramp, ramp, ramp, np.ones(1001)], -1)[None]
    for channels in ("luminance", "separate"):
        out = run(Posterize(levels=6, space="linear", channels=channels), {"image": picture})[0, :, 0]
        assert np.abs(np.unique(out.round(6)) - np.arange(6) / 5).max() < 1e-6
        assert np.all(np.diff(out) > -1e-6)


@pytest.mark.parametrize("channels", ["luminance", "separate"])
def test_a_posterized_picture_stays(run, hdr, channels):
    picture = hdr(9, 7, opaque=True)
    once = run(Posterize(channels=channels), {"image": picture})
    twice = run(Posterize(channels=channels), {"image": once})
    assert (np.abs(twice - once) / np.maximum(once, 1.0)).max() < 1e-5


def test_luminance_keeps_the_color(run, hdr):
    picture = hdr(9, 7, opaque=True)
    out = run(Posterize(), {"image": picture})[..., :3]
    lit = out.max(-1) > 0
    found, wanted = (part[lit] / part[lit].sum(-1, keepdims=True) for part in (out, picture[..., :3]))
    assert np.abs(found - wanted).max() < 1e-5


def test_coverage_does_not_change_the_color_and_a_mask_mixes(run, hdr):
    picture = np.floor(hdr(9, 7, opaque=True) * 64) / 64 + np.float32([0.001, 0.001, 0.001, 0])
    whole = run(Posterize(space="linear", channels="separate"), {"image": picture})
    half = run(Posterize(space="linear", channels="separate"), {"image": picture * np.float32(0.5)})
    assert (np.abs(half - whole * 0.5) / np.maximum(whole, 1.0)).max() < 2e-6
    mask = np.random.default_rng(7).random((7, 9)).astype(np.float32)
    out = run(Posterize(space="linear", channels="separate"), {"image": picture, "amount": mask})
    expected = picture + (whole - picture) * mask[..., None]
    assert (np.abs(out - expected) / np.maximum(expected, 1.0)).max() < 2e-6
    assert Posterize(amount=0.0).identity() == "image"


def test_pixels_by_hand(run):
    """Five levels of light are quarters; half of the codes of sRGB is the light 0.21404 (IEC 61966-2-1)."""
    light = np.array([0.0, 0.12, 0.13, 0.374, 0.376, 0.62, 0.63, 1.12, 1.13])
    picture = np.stack([light, light, light, np.ones(9)], -1)[None]
    for channels in ("luminance", "separate"):
        found = run(Posterize(levels=5, space="linear", channels=channels), {"image": picture})[0, :, 1]
        np.testing.assert_allclose(found, [0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 1.0, 1.25], atol=1e-6)
    dark, bright = np.full((1, 1, 4), 0.2139), np.full((1, 1, 4), 0.2142)
    dark[..., 3] = bright[..., 3] = 1.0
    found = [run(Posterize(levels=2, space="display"), {"image": image})[0, 0, 0] for image in (dark, bright)]
    np.testing.assert_allclose(found, [0.0, 1.0], atol=1e-6)
    one = np.array([[[0.3, 0.6, 0.9, 1.0]]])
    found = run(Posterize(levels=3, space="linear", channels="separate"), {"image": one})[0, 0]
    np.testing.assert_allclose(found, [0.5, 0.5, 1.0, 1.0], atol=1e-6)
