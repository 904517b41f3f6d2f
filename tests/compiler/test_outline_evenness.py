"""Where soft edges are looked at in parts of a pixel: near corners, not along what bends slowly."""

from __future__ import annotations

import numpy as np
from halation.compiler.lowering.outline_chords import NearChords
from halation.compiler.lowering.outline_curves import StraightSegments
from halation.compiler.lowering.outline_evenness import find_uneven

FEATHER = 4.0


def make_polygon(count: int, radius: float) -> StraightSegments:
    turns = np.linspace(0.0, 2.0 * np.pi, count + 1)
    points = radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    points[-1] = points[0]
    return StraightSegments(np.hstack([points[:-1], points[1:]]), np.zeros((count, 2)))


def test_corners_are_uneven_and_a_round_outline_is_not() -> None:
    """One tile is near all parts, one near none."""
    for polygon, expected in ((make_polygon(4, 50.0), FEATHER), (make_polygon(2000, 2000.0), 0.0)):
        count = len(polygon.ends)
        near = NearChords(np.arange(count), np.array([[0, count]]), np.array([[count, 0]]))
        assert find_uneven(polygon, near, FEATHER).tolist() == [[expected, 0.0]]
        far = NearChords(np.zeros(0, np.intp), np.array([[0, 0]]), np.array([[0, 0]]))
        assert find_uneven(polygon, far, FEATHER).tolist() == [[0.0, 0.0]]


def test_wide_edges_are_even() -> None:
    near = NearChords(np.arange(4), np.array([[0]]), np.array([[4]]))
    assert find_uneven(make_polygon(4, 50.0), near, 31.9).tolist() == [[31.9]]
    assert find_uneven(make_polygon(4, 50.0), near, 32.0).tolist() == [[0.0]]
