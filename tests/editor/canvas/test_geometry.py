"""Curves, distances, cuts and views, against dense sampling."""

from __future__ import annotations

import numpy as np
import pytest
from halation.authoring.edits.link_curves import make_curve
from halation.editor.canvas.geometry import (
    avoid_corner,
    find_bounds,
    find_crossed,
    find_crossing,
    find_midpoint,
    find_pan_direction,
    fit_view,
    make_transform,
    measure_distances,
    sample_curves,
    snap_to_grid,
    zoom_about,
)

ENDS = [(0.0, 0.0, 300.0, 120.0), (0.0, 0.0, -260.0, 40.0), (10.0, 5.0, 30.0, 5.0), (0.0, 0.0, 0.0, 500.0)]


def dense(shape: tuple[float, ...], count: int = 20000) -> np.ndarray:
    """Many points of a Bezier by de Casteljau's construction."""
    points = np.array(shape).reshape(4, 1, 2)
    t = np.linspace(0, 1, count)[None, :, None]
    while len(points) > 1:
        points = points[:-1] * (1 - t) + points[1:] * t
    return points[0]


@pytest.mark.parametrize("ends", ENDS)
def test_a_link_leaves_to_the_right_and_arrives_from_the_left(ends) -> None:
    x0, y0, x1, y1, x2, y2, x3, y3 = make_curve(*ends)
    assert (x0, y0, x3, y3) == ends
    assert x1 > x0 and y1 == y0 and x2 < x3 and y2 == y3


@pytest.mark.parametrize("ends", ENDS)
def test_distance_to_a_link_agrees_with_dense_sampling(ends) -> None:
    shape = make_curve(*ends)
    lines, exact = sample_curves(np.array([shape])), dense(shape)
    for point in np.random.default_rng(1).uniform(-200, 500, (30, 2)):
        nearest = np.sqrt(((exact - point) ** 2).sum(axis=1)).min()
        assert measure_distances(lines, tuple(point))[0] == pytest.approx(nearest, abs=1.5)
    assert measure_distances(lines, find_midpoint(shape))[0] < 1.0


@pytest.mark.parametrize("ends", ENDS)
def test_a_line_cuts_the_links_that_it_crosses(ends) -> None:
    shape = make_curve(*ends)
    lines, exact = sample_curves(np.array([shape])), dense(shape)
    for start, end in np.random.default_rng(2).uniform(-150, 400, (60, 2, 2)):
        along = end - start
        side = along[0] * (exact[:, 1] - start[1]) - along[1] * (exact[:, 0] - start[0])
        flips = np.flatnonzero(np.diff(np.sign(side)))
        part = (exact[flips] - start) @ along / (along @ along)
        if np.any(np.abs(part) < 0.02) or np.any(np.abs(part - 1) < 0.02):
            continue  # the line ends on the curve: either answer is right
        if len(flips) == 0 and np.abs(side).min() / np.linalg.norm(along) < 2:
            continue  # it only touches
        wanted = bool(np.any((part > 0) & (part < 1)))
        assert bool(find_crossed(lines, tuple(start), tuple(end))[0]) == wanted
        if wanted:
            at = np.array(find_crossing(lines[0], tuple(start), tuple(end)))
            assert np.sqrt(((exact - at) ** 2).sum(axis=1)).min() < 2.0


def test_a_point_cuts_nothing() -> None:
    lines = sample_curves(np.array([make_curve(0, 0, 100, 0)]))
    assert not find_crossed(lines, (50.0, 0.0), (50.0, 0.0)).any()


def test_fit_shows_all_in_the_middle_and_never_enlarges() -> None:
    center, zoom = fit_view((0.0, 0.0, 2000.0, 500.0), (1000.0, 800.0))
    assert center == (1000.0, 250.0)
    assert 2000 * zoom < 1000 and 2000 * zoom > 800
    assert fit_view((0.0, 0.0, 10.0, 10.0), (1000.0, 800.0))[1] == 1.0
    (x, y), zoom = fit_view((0.0, 0.0, 1000.0, 5000.0), (1000.0, 800.0), least_zoom=0.8)
    assert zoom == 0.8 and x == 500.0 and y - 400.0 / zoom == pytest.approx(-48.0 / zoom), "the upper part"


def test_zoom_keeps_what_is_under_the_pointer() -> None:
    panel = (100.0, 50.0, 900.0, 650.0)
    before = make_transform(panel, (30.0, -20.0), 0.8)
    at = before.to_canvas(300.0, 200.0)
    center, zoom = zoom_about((30.0, -20.0), 0.8, at, 1.5)
    after = make_transform(panel, center, zoom)
    assert after.to_screen(*at) == pytest.approx((300.0, 200.0), abs=1.0)
    assert zoom_about((0.0, 0.0), 1.0, (0.0, 0.0), 1e9)[1] == 4.0


def test_bounds_of_nothing_and_of_two() -> None:
    assert find_bounds([]) is None
    assert find_bounds([(0, 0, 1, 1), (-2, 5, 0, 6)]) == (-2, 0, 1, 6)


def test_snapping_and_panning_at_the_border() -> None:
    assert [snap_to_grid(number, 16.0) for number in (7.9, 8.1, -7.9, -23.0)] == [0.0, 16.0, 0.0, -16.0]
    panel = (0.0, 0.0, 400.0, 300.0)
    assert find_pan_direction(panel, 200.0, 150.0, 20.0) == (0.0, 0.0)
    assert find_pan_direction(panel, -100.0, 310.0, 20.0) == (-1.0, 1.0)
    assert find_pan_direction(panel, 390.0, 150.0, 20.0)[0] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("rect", "moved"),
    [
        ((0.0, 0.0, 100.0, 100.0), (0.0, 0.0)),  # in the middle: nothing covers it
        ((250.0, 160.0, 380.0, 240.0), (180.0, 0.0)),  # 180 pixels to the left, or 190 up
        ((-300.0, 160.0, 380.0, 240.0), (0.0, 190.0)),  # too wide for the way to the left
        ((-390.0, -240.0, 390.0, 240.0), (0.0, 0.0)),  # as large as the panel
    ],
)
def test_what_is_revealed_does_not_lie_below_the_map(rect, moved) -> None:
    assert avoid_corner(rect, (0.0, 0.0), 1.0, (800.0, 500.0), (200.0, 200.0)) == moved
    halved = avoid_corner(tuple(2 * side for side in rect), (0.0, 0.0), 0.5, (800.0, 500.0), (200.0, 200.0))
    assert halved == tuple(2 * part for part in moved)
