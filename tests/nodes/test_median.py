"""Median against scipy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.blur.median import Median
from scipy.ndimage import median_filter


@pytest.mark.parametrize("side", [3, 5])
@pytest.mark.parametrize("size", [(29, 23), (64, 1), (2, 3), (1, 1)])
def test_it_equals_scipy(run, hdr, edge, side, size):
    picture = hdr(*size)
    found = run(Median(window=f"{side}x{side}", edge=edge.name), {"image": picture})
    np.testing.assert_array_equal(found, median_filter(picture, (side, side, 1), mode=edge.scipy))


@pytest.mark.parametrize("side", [3, 5])
def test_few_values(run, side):
    picture = np.random.default_rng(3).integers(-2, 3, (17, 19, 4)).astype(np.float32)
    found = run(Median(window=f"{side}x{side}"), {"image": picture})
    np.testing.assert_array_equal(found, median_filter(picture, (side, side, 1), mode="nearest"))


def test_a_spark_goes_and_a_step_stays(run):
    step = np.zeros((9, 12, 4), np.float32)
    step[:, 6:] = 2.0
    spark = step.copy()
    spark[4, 3] = 1000.0
    np.testing.assert_array_equal(run(Median(), {"image": spark}), step)
