"""Measures of likeness and of curvature against closed forms."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.fit.likeness import MAX_PIXELS, LookLikeness, PixelLikeness, _measure_bands, _spread  # pyright: ignore
from halation.fit.results import measure_curvatures
from halation.fit.search import FitSearch
from halation.media.comparison.color_difference import to_lab
from scipy import fft, stats

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


@pytest.mark.parametrize("size", [(16, 22), (16, 21), (9, 8), (11, 7)])
def test_bands_are_those_of_the_whole_spectrum(size: tuple[int, int]) -> None:
    """Against both halves of the spectrum as scipy has it: waves to the left and to the right count alike."""
    lightness = RANDOM.uniform(20, 80, size)
    window = np.outer(*(np.hanning(length + 2)[1:-1] for length in size))
    flat = lightness - np.average(lightness, weights=window)
    power = np.abs(fft.fft2(flat * window)) ** 2 / np.sum(window**2) / lightness.size
    frequency = np.hypot(fft.fftfreq(size[0])[:, None], fft.fftfreq(size[1])[None, :])
    bands, floor = _measure_bands(lightness), _measure_bands(np.zeros(size))
    # A wave of two pixels ends the first band, to which shorter ones between rows and columns belong too.
    edges = 0.5 * 2.0 ** (-np.arange(bands.size + 1) / 2.0)
    for number, (high, low) in enumerate(pairwise(edges)):
        inside = (frequency > low * (1 + 1e-9)) & ((frequency <= high * (1 + 1e-9)) | (number == 0))
        assert bands[number] - floor[number] == pytest.approx(np.sqrt(power[inside].sum()), rel=1e-6)


@pytest.mark.parametrize("point", [(0.5, 0.25, 0.5), (0.0, 0.999999, 1.0), (1.0, 0.0, 0.0)])
def test_slopes_are_those_of_a_polynomial(point: tuple[float, ...]) -> None:
    """Inside the ranges, also at their ends; one number is whole, with four steps."""
    seen: list[np.ndarray] = []

    def measure(at: np.ndarray) -> np.ndarray:
        seen.append(np.array(at))
        return np.array([3.0 * at[0] - 2.0 * at[1], at[0] * at[1] + 5.0 * at[2]])

    numbers = [SimpleNamespace(low=0.0, high=1.0, is_whole=False)] * 2 + [
        SimpleNamespace(low=2.0, high=6.0, is_whole=True)
    ]
    search: Any = SimpleNamespace(space=SimpleNamespace(numbers=numbers), measure=measure, slopes=None)
    here = np.array(point)
    expected = np.array([[3.0, -2.0, 0.0], [here[1], here[0], 5.0]])
    np.testing.assert_allclose(FitSearch.measure_central_slopes(search, here), expected, atol=1e-6)
    free = np.array([True, False, True])
    np.testing.assert_allclose(FitSearch.measure_slopes(search, here, free), expected[:, free], atol=1e-6)
    np.testing.assert_allclose(search.slopes[:, 1], 0.0)
    assert all((at >= 0.0).all() and (at <= 1.0).all() for at in seen)
    wholes = {float(at[2]) for at in seen[:6]}
    assert wholes == {here[2], max(here[2] - 0.25, 0.0), min(here[2] + 0.25, 1.0)}


def test_a_look_that_is_brighter_differs_by_that_in_tones_and_in_directions():
    """CIE94 of equal colors is the difference of lightness, whatever the colors. Along a direction it is the part of it
    that shows there: of many, a third of its square on average."""
    lightness, shift = RANDOM.uniform(30, 60, (40, 50)), 7.0
    found = LookLikeness(gray(lightness)).measure(gray(lightness + shift))
    tones, slices, bands = found[:64], found[64:-10], found[-10:]
    assert np.linalg.norm(tones) == pytest.approx(shift, rel=1e-6)
    directions = np.random.default_rng(1).normal(size=(3, 24))
    directions /= np.linalg.norm(directions, axis=0)
    assert np.linalg.norm(slices) == pytest.approx(shift * np.sqrt(3.0 * np.mean(directions[0] ** 2)), rel=1e-6)
    np.testing.assert_allclose(bands, 0.0, atol=1e-6)


@pytest.mark.parametrize("count", [1, 5, MAX_PIXELS, MAX_PIXELS + 1, 2 * MAX_PIXELS, 3_333_333])
def test_pixels_are_drawn_from_equal_parts(count):
    """Each part has one, at a place that is even over it, as scipy says; few pixels are all there."""
    places = _spread(count)
    if count <= MAX_PIXELS:
        assert places.tolist() == list(range(count))
        return
    part = count / MAX_PIXELS
    starts = np.arange(MAX_PIXELS) * part
    assert places.size == MAX_PIXELS and (places >= np.floor(starts)).all() and (places < starts + part).all()
    if part > 50:
        assert stats.kstest((places - starts) / part, "uniform").pvalue > 1e-3
