"""Measures of likeness and of curvature against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from halation.fit.likeness import LookLikeness, PixelLikeness
from halation.fit.results import measure_curvatures
from halation.media.comparison.color_difference import to_lab
from scipy import stats

RANDOM = np.random.default_rng(3)


def gray(lightness: np.ndarray) -> np.ndarray:
    """Light of this CIELAB lightness, above the line near black."""
    return np.repeat((((lightness + 16.0) / 116.0) ** 3)[..., None], 3, axis=2)


def test_pixels_differ_by_the_root_mean_square_of_their_differences():
    lightness = RANDOM.uniform(20, 80, (24, 32))
    shift = RANDOM.uniform(-5, 5, (24, 32))
    error = np.linalg.norm(PixelLikeness(gray(lightness)).measure(gray(lightness + shift)))
    assert error == pytest.approx(np.sqrt(np.mean(shift**2)), rel=1e-6)


def test_many_pixels_are_sampled_evenly():
    lightness = np.tile(np.linspace(20, 80, 500), (400, 1))
    error = np.linalg.norm(PixelLikeness(gray(lightness)).measure(gray(lightness * 1.05)))
    assert error == pytest.approx(0.05 * np.sqrt(np.mean(lightness**2)), rel=2e-3)


def test_a_look_does_not_depend_on_where_things_are():
    light = RANDOM.random((48, 64, 3))
    assert np.linalg.norm(LookLikeness(light).measure(light[::-1, ::-1])) < 1e-9


def test_distributions_of_color_are_compared_as_scipy_does():
    """The mean distance along one direction is that of Wasserstein, as far as 64 levels show it."""
    first, second = (RANDOM.random((64, 64, 3)) ** power for power in (1.0, 2.0))
    differences = LookLikeness(second).measure(first)[64:-10].reshape(64, 24)
    look = LookLikeness(second)
    for number in (0, 11):
        a, b = (to_lab(light).reshape(-1, 3) @ look._directions[:, number] for light in (first, second))
        measured = np.abs(differences[:, number]).mean() / np.sqrt(3.0 / (64 * 24))
        assert measured == pytest.approx(stats.wasserstein_distance(a, b), rel=0.02)


def test_texture_is_the_logarithm_of_its_amplitude():
    """A wave of double amplitude is off by ln 2 in its own half octave, and by nothing elsewhere."""
    across = np.arange(128)
    wave = np.sin(2 * np.pi * across / 8) * np.ones((96, 1))
    bands = LookLikeness(gray(50 + 2 * wave)).measure(gray(50 + 4 * wave))[-10:] * np.sqrt(10) / 2.0
    strongest = int(np.argmax(bands))
    assert bands[strongest] == pytest.approx(np.log(2.0), abs=0.03)
    assert strongest in (3, 4), "an eighth of a cycle per pixel is two octaves below the limit"


def test_curvature_is_what_the_other_numbers_cannot_make_up_for():
    slopes = RANDOM.normal(size=(200, 5))
    expected = 1.0 / np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    np.testing.assert_allclose(measure_curvatures(slopes), expected, rtol=1e-9)
    slopes[:, 4] = slopes[:, 0] + slopes[:, 1]
    assert (measure_curvatures(slopes)[[0, 1, 4]] < 1e-9).all() and (measure_curvatures(slopes)[2:4] > 1.0).all()
