"""How far curves bend and how long their control polygons are, whichever way they are turned."""

from __future__ import annotations

import numpy as np
import pytest
from halation.compiler.lowering.outline_curves import PlacedCurves

TURNS = np.radians([0.0, 30.0, 90.0, 135.0, 200.0, 301.0])


def place(points: list[tuple[float, float]], turn: float) -> PlacedCurves:
    c, s = np.cos(turn), np.sin(turn)
    turned = np.array(points) @ np.array([[c, s], [-s, c]]) * 10.0 + (7.0, -3.0)
    return PlacedCurves(turned.reshape(1, 8), np.zeros(1, np.intp), np.zeros(1))


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("shares", [(1 / 3, 2 / 3), (0.0, 1.0), (0.5, 0.5), (0.0, 0.1), (0.9, 0.2)])
def test_straight_lines_do_not_bend_however_they_run(turn: float, shares: tuple[float, float]) -> None:
    points = [(0.0, 0.0), *((4.0 * share, 3.0 * share) for share in shares), (4.0, 3.0)]
    assert place(points, turn).bends.tolist() == [0.0]


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(
    ("points", "bend"),
    [
        ([(0, 0), (1, 1), (2, 1), (3, 0)], 2**0.5), ([(0, 0), (1, 0.5), (2, 0), (3, 0)], 1.0),
        ([(0, 0), (-1, 0), (2, 0), (3, 0)], 4.0), ([(0, 0), (1, 0), (4, 0), (3, 0)], 4.0),
        ([(0, 0), (0, 1), (0, 2), (0, 5)], 0.0), ([(1, 1), (1, 1), (1, 1), (1, 1)], 0.0),
    ],
)  # fmt: skip
def test_the_bend_is_the_largest_second_difference(turn: float, points: list[tuple[float, float]], bend: float) -> None:
    """Lines that go beyond their ends and come back bend too."""
    a, b, c, d = np.array(points, float)
    expected = bend and max(np.linalg.norm(a - 2 * b + c), np.linalg.norm(b - 2 * c + d))
    np.testing.assert_allclose(place(points, turn).bends, [10.0 * expected], atol=1e-9)


@pytest.mark.parametrize("turn", TURNS)
def test_the_length_is_that_of_the_polygon(turn: float) -> None:
    np.testing.assert_allclose(place([(0, 0), (3, 4), (3, 10), (-5, 4)], turn).lengths, [10.0 * (5.0 + 6.0 + 10.0)])
