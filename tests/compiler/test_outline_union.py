"""Contours that overlap, as in fonts that vary: their union against polygons by hand, in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.compiler.lowering.outline_curves import StraightSegments
from halation.compiler.lowering.outline_union import keep_edges


def close(*polygons: list[tuple[float, float]]) -> StraightSegments:
    """The segments of closed polygons, with a feather that counts them."""
    ends = np.concatenate([np.hstack([corners, np.roll(corners, -1, axis=0)]) for corners in map(np.array, polygons)])
    return StraightSegments(ends, np.repeat(np.arange(len(ends), dtype=float)[:, None], 2, axis=1))


def measure_signed_area(segments: StraightSegments) -> float:
    """By Gauss: each simple polygon counts by the way around, so that those in others would show."""
    ax, ay, bx, by = segments.ends.T
    return 0.5 * float(np.sum(ax * by - ay * bx))


def list_points(segments: StraightSegments) -> set[tuple[float, float]]:
    return {tuple(point) for point in np.round(segments.ends.reshape(-1, 2), 9).tolist()}


FIRST = [(10.0, 10.0), (30.0, 10.0), (30.0, 30.0), (10.0, 30.0)]
SECOND = [(20.0, 20.0), (40.0, 20.0), (40.0, 40.0), (20.0, 40.0)]


@pytest.mark.parametrize("turned", [False, True])
def test_two_squares_that_overlap_are_one_polygon(turned: bool) -> None:
    order = slice(None, None, -1 if turned else 1)
    union = keep_edges(close(FIRST[order], SECOND[order]))
    assert list_points(union) == {
        (10.0, 10.0), (30.0, 10.0), (30.0, 20.0), (40.0, 20.0), (40.0, 40.0), (20.0, 40.0), (20.0, 30.0), (10.0, 30.0),
    }  # fmt: skip
    assert abs(measure_signed_area(union)) == pytest.approx(700.0)


def test_squares_that_run_against_each_other_have_a_hole_between_them() -> None:
    union = keep_edges(close(FIRST, SECOND[::-1]))
    assert abs(measure_signed_area(union)) == pytest.approx(600.0)


def test_a_bar_across_a_ring_keeps_its_holes() -> None:
    """As a letter with a stroke through its counter: two holes of what was one."""
    outer = [(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)]
    inner = [(10.0, 10.0), (10.0, 30.0), (30.0, 30.0), (30.0, 10.0)]
    bar = [(-5.0, 18.0), (45.0, 18.0), (45.0, 22.0), (-5.0, 22.0)]
    assert abs(measure_signed_area(keep_edges(close(outer, inner, bar)))) == pytest.approx(1600 - 400 + 80 + 40)


def test_what_does_not_cross_stays_as_it_is() -> None:
    segments = close(FIRST, [(50.0, 50.0), (60.0, 50.0), (55.0, 60.0)])
    assert keep_edges(segments) is segments


def test_feathers_are_cut_with_their_segments() -> None:
    ends = np.array([(0.0, 0.0, 10.0, 10.0), (10.0, 10.0, 10.0, 0.0), (10.0, 0.0, 0.0, 10.0), (0.0, 10.0, 0.0, 0.0)])
    feathers = np.array([(0.0, 8.0), (8.0, 8.0), (8.0, 0.0), (0.0, 0.0)])
    union = keep_edges(StraightSegments(ends, feathers))
    points, widths = union.ends.reshape(-1, 2), union.feathers.reshape(-1)
    np.testing.assert_allclose(widths, 0.8 * points[:, 0])
