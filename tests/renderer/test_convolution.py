"""The convolution of two pictures by fast Fourier transform, against scipy's in 64 bits."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from halation.compiler.lowering import fourier
from halation.nodes import Draw, Drawn, Filter, Image
from scipy.signal import fftconvolve


class Spread(Filter):
    """Every pixel becomes a kernel."""

    image = Image()
    kernel = Image(own_size=True)

    def passes(self, draw: Draw) -> Drawn:
        return draw.convolve_2d(self.image, self.kernel)


def expected(image: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    height, width = image.shape[:2]
    down, across = kernel.shape[0] // 2, kernel.shape[1] // 2
    whole = [fftconvolve(image[..., c].astype(np.float64), kernel[..., c].astype(np.float64)) for c in range(4)]
    return np.stack(whole, axis=-1)[down : down + height, across : across + width]


def noise(width: int, height: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).gamma(0.3, 1.0, (height, width, 4)).astype(np.float32) - 0.1


@pytest.mark.parametrize(
    ("size", "kernel"),
    [
        ((37, 23), (9, 7)),
        ((37, 23), (8, 6)),
        ((5, 1), (4, 3)),
        ((1, 1), (1, 1)),
        ((1, 1), (2, 5)),
        ((1, 6), (3, 11)),
        ((40, 30), (79, 59)),
        ((31, 17), (64, 50)),
        ((150, 90), (13, 13)),
        ((97, 61), (2, 1)),
    ],
    ids=str,
)
def test_it_is_the_convolution(run, size, kernel):
    image, spread = noise(*size, 1), noise(*kernel, 2)
    wanted = expected(image, spread)
    found = run(Spread(), {"image": image, "kernel": spread})
    assert np.abs(found - wanted).max() <= 2e-6 * np.abs(wanted).max()


def test_a_point_becomes_the_kernel_around_its_middle(run):
    image, spread = np.zeros((9, 11, 4), np.float32), noise(4, 3, 3)
    image[5, 6] = 1.0
    wanted = np.zeros_like(image)
    wanted[4:7, 4:8] = spread
    found = run(Spread(), {"image": image, "kernel": spread})
    assert np.abs(found - wanted).max() <= 2e-6 * np.abs(spread).max()


@pytest.mark.parametrize("hole", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_does_not_spread(run, hole):
    image, spread = noise(19, 14, 4), noise(5, 6, 5)
    clean, whole = image.copy(), spread.copy()
    image[3, 7, 1], clean[3, 7] = hole, 0.0
    spread[2, 1, 0], whole[2, 1] = hole, 0.0
    wanted = expected(clean, whole)
    found = run(Spread(), {"image": image, "kernel": spread})
    assert np.abs(found - wanted).max() <= 2e-6 * np.abs(wanted).max()


@pytest.mark.parametrize("length", [1, 2, 7, 13, 32, 480, 1080, 1125, 1944, 3840])
def test_stages_make_the_whole_length_and_miss_no_pixel(length):
    padded = fourier.pad_length(length, 1)
    assert length <= padded <= 1.15 * length + 1.0
    for filled in {1, min(33, padded), -(-padded // 2), padded}:
        stages = fourier.plan_stages(padded, filled)
        assert math.prod(stage.radix for stage in stages) == padded
        for before, stage in pairwise(stages):
            assert stage.span == before.span * before.radix and stage.terms == stage.radix
        first = stages[0]
        assert first.span == 1 and first.terms * (padded // first.radix) >= filled
