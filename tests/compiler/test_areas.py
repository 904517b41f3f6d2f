"""Which pixels lie where an edge mode looks: against each position by itself, as numpy pads."""

from __future__ import annotations

import numpy as np
import pytest
from halation.compiler.areas import Neighborhood, Region, clip_span

PADS = {"clamp": "edge", "wrap": "wrap", "reflect": "symmetric", "mirror": "reflect"}


@pytest.mark.parametrize("edge", PADS)
@pytest.mark.parametrize("length", [1, 2, 5, 9])
def test_all_that_a_span_beyond_the_ends_reads_lies_inside(edge, length):
    far = 3 * length
    padded = np.pad(np.arange(length), far, PADS[edge])
    for first in range(-far, far + length):
        for end in range(first + 1, far + length + 1):
            low, high = clip_span((first, end), length, edge)
            read = padded[first + far : end + far]
            assert 0 <= low <= read.min() and read.max() < high <= length


def test_black_beyond_the_ends_reads_nothing_more():
    assert clip_span((-4, 3), 9, "black") == (0, 3)
    assert clip_span((-9, -4), 9, "black") == (0, 1) and clip_span((12, 20), 9, "black") == (8, 9)


def test_around_its_own_pixel():
    around = Neighborhood.pixel((10, 10), (10, 10), (2, 1))
    assert around.find_spans(Region(4, 5, 3, 2)) == ((2, 9), (4, 8))


def test_a_turn_reaches_what_its_corners_reach():
    quarter = Neighborhood((0.0, -1.0, 10.0, 1.0, 0.0, 0.0), (0.0, 0.0))
    assert quarter.find_spans(Region(0, 0, 3, 2)) == ((8, 10), (0, 3))


def test_a_place_that_is_no_number_may_be_anywhere():
    (low, high), _ = Neighborhood((float("nan"), 0.0, 0.0, 0.0, 1.0, 0.0), (1.0, 1.0)).find_spans(Region(0, 0, 1, 1))
    assert clip_span((low, high), 7, "clamp") == (0, 7)
