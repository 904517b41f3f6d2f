"""Toon against the formula in 64 bits and its closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.stylize.toon import Toon

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])


def encoded(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def decoded(code):
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def gray(tones: np.ndarray) -> np.ndarray:
    picture = np.ones((1, len(tones), 4))
    picture[..., :3] = decoded(tones)[None, :, None]
    return picture


@pytest.mark.parametrize(("levels", "sharpness"), [(5.0, 14.0), (2.0, 3.0), (9.5, 0.2)])
def test_it_equals_the_formula(run, hdr, levels, sharpness):
    picture = hdr(37, 20)
    picture[..., 3] = picture[..., 3] * 0.9 + 0.1
    color = picture[..., :3].astype(np.float64) / picture[..., 3:]
    light = color @ WEIGHTS
    step = 1.0 / (levels - 1.0)
    middle = (np.floor(encoded(light) / step) + 0.5) * step
    tone = middle + step / 2 * np.tanh(sharpness * (encoded(light) - middle) / step) / np.tanh(sharpness / 2)
    expected = picture[..., :3] * (decoded(tone) / light)[..., None]
    found = run(Toon(levels=levels, sharpness=sharpness), {"image": picture})
    # A tone in 32 bits is known to 1e-7 of its size, and the slope between steps is half the sharpness.
    assert np.abs(found[..., :3] / expected - 1.0).max() <= 2e-5 * max(sharpness, 1.0)
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


def test_steps_stay_and_all_else_comes_to_them(run):
    tones = np.linspace(0.0, 2.0, 401)
    found = encoded(run(Toon(levels=5.0, sharpness=80.0), {"image": gray(tones)})[0, :, 0].astype(np.float64))
    far = np.abs(tones * 4 - np.floor(tones * 4) - 0.5) > 0.2
    np.testing.assert_allclose(found[far], np.round(tones[far] * 4) / 4, atol=1e-5)
    assert (np.diff(found) >= -1e-6).all()


def test_it_is_continuous(run):
    tones = np.linspace(0.0, 1.2, 2401)
    found = encoded(run(Toon(levels=5.0, sharpness=6.0), {"image": gray(tones)})[0, :, 0].astype(np.float64))
    assert np.abs(np.diff(found)).max() <= 3.1 * np.diff(tones).max()


def test_without_sharpness_nothing_changes(run, hdr):
    picture = hdr(21, 13)
    assert Toon(sharpness=0.0).identity() == "image"
    np.testing.assert_allclose(run(Toon(sharpness=0.001), {"image": picture}), picture, rtol=1e-3, atol=1e-6)


def test_hues_stay(run, hdr):
    picture = hdr(15, 11, opaque=True)
    found = run(Toon(levels=3.0), {"image": picture})[..., :3]
    np.testing.assert_allclose(
        found / found.sum(-1, keepdims=True), picture[..., :3] / picture[..., :3].sum(-1, keepdims=True), rtol=1e-4
    )


def test_tones_by_hand(run):
    """Winnemoeller, Olsen and Gooch 2006: half a step of tanh around the middle, here scaled to reach the levels.

    Of five levels 0.3 lies 0.075 below the middle 0.375: tanh(0.6) / tanh(1) = 0.537050 / 0.761594 = 0.705165 of half a
    step of 0.25 is 0.088146.
    """
    tones = np.array([0.3, 0.375, 0.45, 0.5])
    found = run(Toon(levels=5.0, sharpness=2.0), {"image": gray(tones)})[0, :, 0]
    np.testing.assert_allclose(found, decoded(np.array([0.286854, 0.375, 0.463146, 0.5])), rtol=1e-5)
