"""Gabor noise: its definition on numpy's own integers, and its spectrum and variance in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.input.gabor_noise import GaborNoise
from hashes import hash3
from noises import stream

SIZE = 256
END = math.exp(-math.pi)


def window(square: np.ndarray) -> np.ndarray:
    """A Gaussian that ends at radius 1."""
    return np.where(square < 1, (np.exp(-math.pi * square) - END) / (1 - END), 0)


def energy() -> float:
    """The integral of the squared window over the plane, in polar coordinates: s is the squared radius."""
    squares = (1 - END**2) / (2 * math.pi) - 2 * END * (1 - END) / math.pi + END**2
    return math.pi * squares / (1 - END) ** 2


def model(node: GaborNoise, width: int, height: int) -> np.ndarray:
    """The sum over all waves that start in a cell around each pixel, divided by the standard deviation."""
    reach = node.radius * node.wavelength
    y, x = (np.mgrid[:height, :width] + 0.5) / reach
    total = np.zeros((height, width))
    for row, column, number in np.ndindex(3, 3, node.waves):
        cell = np.floor(x) + column - 1, np.floor(y) + row - 1
        seed = tuple(int(part) for part in stream(node.seed, number, 3))
        right, below, phase = hash3((*cell, 0), seed)
        turn, sign, _ = hash3((*cell, 1), seed)
        px, py = x - cell[0] - right, y - cell[1] - below
        way = math.radians(node.angle) + math.radians(node.spread) * (2 * turn - 1)
        along = node.radius * (px * np.cos(way) + py * np.sin(way))
        moment = np.where(sign < 0.5, node.evolution, -node.evolution)
        total += window(px**2 + py**2) * np.cos(2 * math.pi * (along + phase + moment))
    return total / math.sqrt(0.5 * node.waves * energy())


def spectrum(run, **values) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The mean power at each frequency, and the frequencies across and down, in waves per pixel."""
    power = np.zeros((SIZE, SIZE))
    for seed in range(4):
        node = GaborNoise(contrast=0.5, seed=seed, period=(SIZE, SIZE), **values)
        value = run(node, size=(SIZE, SIZE), output="value")[..., 0].astype(np.float64)
        power += np.abs(np.fft.fft2(value - value.mean())) ** 2
    across, down = np.meshgrid(np.fft.fftfreq(SIZE), np.fft.fftfreq(SIZE))
    return power / power.sum(), across, down


def test_it_is_its_definition(run):
    node = GaborNoise(wavelength=9.0, radius=1.7, angle=25.0, spread=40.0, waves=3, seed=6, evolution=0.3, contrast=0.9)
    expected = 0.5 + 0.5 * np.clip(0.9 * model(node, 70, 50) / 3, -1, 1)
    np.testing.assert_allclose(run(node, size=(70, 50), output="value")[..., 0], expected, atol=2e-5)
    picture = run(node, size=(70, 50))
    np.testing.assert_allclose(picture[..., :3], np.repeat(expected[..., None], 3, -1), atol=2e-5)
    assert (picture[..., 3] == 1.0).all()


@pytest.mark.parametrize(("wavelength", "angle"), [(8.0, 0.0), (11.0, 30.0), (6.0, -70.0)])
def test_its_spectrum_lies_around_the_wave(run, wavelength, angle):
    """The center and the width of the half of the spectrum that lies in the direction of the angle."""
    power, across, down = spectrum(run, wavelength=wavelength, angle=angle, spread=0.0, radius=2.0)
    way = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    along, beside = across * way[0] + down * way[1], down * way[0] - across * way[1]
    half = np.where(along > 0, power, 0) * 2
    assert (half * along).sum() == pytest.approx(1 / wavelength, rel=0.03)
    assert abs((half * beside).sum()) < 0.03 / wavelength
    width = 0.3048567 / (2.0 * wavelength)  # of the squared transform of the window, along one axis
    for away in (along - (half * along).sum(), beside):
        assert math.sqrt((half * away**2).sum()) == pytest.approx(width, rel=0.1)


def test_with_all_directions_it_is_a_ring(run):
    power, across, down = spectrum(run, wavelength=8.0, spread=180.0, radius=4.0)
    far = np.hypot(across, down)
    assert (power * far).sum() == pytest.approx(1 / 8.0, rel=0.03)
    for name, direction in (("across", across), ("down", down)):
        assert (power * direction**2).sum() == pytest.approx(0.5 * (power * far**2).sum(), rel=0.12), name


@pytest.mark.parametrize("values", [{"waves": 2}, {"waves": 8, "radius": 1.0}, {"radius": 3.0, "spread": 180.0}])
def test_it_is_as_strong_as_it_says(run, values):
    """One standard deviation is a third of the way to white."""
    found = [
        run(GaborNoise(wavelength=7.0, contrast=1.0, seed=seed, **values), size=(SIZE, SIZE), output="value")
        for seed in range(2)
    ]
    assert np.mean(found) == pytest.approx(0.5, abs=0.01) and np.std(found) == pytest.approx(0.5 / 3, rel=0.06)


def test_it_repeats_and_runs_in_a_loop_to_the_bit(run):
    node = GaborNoise(wavelength=7.0, radius=1.5, spread=60.0, period=(44.0, 31.0), evolution=0.25)
    found = run(node, size=(90, 70), output="value")
    assert np.array_equal(found[:, :44], found[:, 44:88]) and np.array_equal(found[:31], found[31:62])
    assert np.array_equal(run(node.with_values(evolution=3.25), size=(90, 70), output="value"), found)
    moved = run(node.with_values(offset=(44.0, -62.0)), size=(90, 70), output="value")
    assert np.array_equal(moved, found)
    assert np.abs(run(node.with_values(evolution=0.75), size=(90, 70), output="value") - found).max() > 0.3


def test_it_shrinks_with_the_proxy(run):
    node = GaborNoise(wavelength=40.0, contrast=0.5, period=(192.0, 0.0))
    full, half = (run(node, size=(96, 64), scale=scale, output="value")[..., 0] for scale in (1.0, 0.5))
    assert np.abs(half - full.reshape(32, 2, 48, 2).mean((1, 3))).max() < 2e-3


@pytest.mark.parametrize("values", [{"period": (3.0, 5.0)}, {"wavelength": 0.01}, {"radius": 64.0, "period": (0, 9.0)}])
def test_wild_values_stay_in_range(run, values):
    found = run(GaborNoise(**values), size=(30, 20), output="value")
    assert np.isfinite(found).all() and found.min() >= 0.0 and found.max() <= 1.0
