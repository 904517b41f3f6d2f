"""Splines on the picture: where they are, what is under the mouse, and what a drag makes of them; no window."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.authoring.commands import ChangePoints, MovePoints
from halation.editor.viewer import spline_edits, splines
from halation.editor.viewer.geometry import Sight
from halation.editor.viewer.splines import SplineOutline, SplineTarget
from halation.graph import Port
from scipy.interpolate import BPoly

PICTURE = (400, 200)
SIGHT = Sight((100.0, 50.0), (800, 600), PICTURE, zoom=1.5, pan=(16.0, -10.0))
AFFINE = (1.5, 0.25, 20.0, -0.5, 2.0, 60.0)
POINTS = (
    (10.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (110.0, 20.0, -20.0, -5.0, 20.0, 5.0, 0.125),
    (90.0, 60.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (20.0, 50.0, 10.0, 8.0, -10.0, -8.0, 0.0),
)


@pytest.fixture
def outline() -> SplineOutline:
    numbers = tuple(part for point in POINTS for part in point)
    return SplineOutline(Port("roto", "shapes"), "leaf", numbers, AFFINE, PICTURE, True, Port("roto", "shapes"))


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch, outline: SplineOutline) -> Any:
    """An editor with this one outline, which writes down the commands that it is given."""
    for module in (splines, spline_edits):
        monkeypatch.setattr(module, "list_outlines", lambda context: (outline,))
    monkeypatch.setattr(spline_edits, "find_list", lambda context: Port("roto", "shapes"))
    monkeypatch.setattr(spline_edits, "find_own_outline", lambda context: None)
    commands: list[Any] = []
    pen = SimpleNamespace(
        selection=("", frozenset()), copied={}, lasso=[], shape="", pending=None, ripples=False, singly=True,
        find_points=lambda port: pen.selection[1] if pen.selection[0] == port else frozenset(),
    )  # fmt: skip
    return SimpleNamespace(
        viewer=SimpleNamespace(pen=pen), items={}, commands=commands, interface=SimpleNamespace(dragging=False),
        session=SimpleNamespace(apply=lambda command: commands.append(command) or "shape_8"),
        log=SimpleNamespace(attempt=lambda act: act()),
    )  # fmt: skip


def select(context: Any, outline: SplineOutline, *numbers: int) -> None:
    splines.select_points(context, outline, numbers)


def moved(context: Any) -> list[tuple[float, ...]]:
    """The points that the last command sets."""
    command = context.commands[-1]
    assert isinstance(command, MovePoints) and len(command.points) == len(POINTS)
    return [tuple(point) for point in command.points]


def test_places_are_those_of_the_matrix(outline: SplineOutline) -> None:
    matrix = np.array([[1.5, 0.25, 20.0], [-0.5, 2.0, 60.0]])
    expected = matrix @ np.array([[x, y, 1.0] for x, y, *_ in POINTS]).T / np.array(PICTURE)[:, None]
    np.testing.assert_allclose(outline.places, expected.T)
    for place, point in zip(outline.places, POINTS, strict=True):
        assert outline.from_picture(place) == pytest.approx(point[:2], abs=1e-6)
    flat = SplineOutline(Port("a", "b"), "flat", outline.numbers, (1.0, 2.0, 0.0, 2.0, 4.0, 0.0), PICTURE, True)
    assert flat.from_picture((0.5, 0.5)) is None


def test_curves_are_those_of_bernstein(outline: SplineOutline) -> None:
    t = np.linspace(0.0, 1.0, splines.STEPS + 1)
    for index, start in enumerate(POINTS):
        end = POINTS[(index + 1) % 4]
        corners = [start[:2], (start[0] + start[4], start[1] + start[5]), (end[0] + end[2], end[1] + end[3]), end[:2]]
        curve = BPoly(np.array(corners)[:, None, :], [0.0, 1.0])(t)
        expected = [outline.to_picture((x, y)) for x, y in curve]
        np.testing.assert_allclose(outline.trace_curve(index), expected, atol=1e-12)


def test_tangents_end_beside_their_points_and_corners_have_none(outline: SplineOutline) -> None:
    assert splines.list_tangents(outline, 0) == []
    assert splines.list_tangents(outline, 1) == [
        ("in", outline.to_picture((90.0, 15.0))), ("out", outline.to_picture((130.0, 25.0))),
    ]  # fmt: skip


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_normals_lead_out_of_a_square_whichever_way_it_turns(is_mirrored: bool) -> None:
    corners = [(100.0, 50.0), (300.0, 50.0), (300.0, 150.0), (100.0, 150.0)]
    ways = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    if is_mirrored:
        corners, ways = corners[::-1], ways[::-1]
    numbers = tuple(part for corner in corners for part in (*corner, 0.0, 0.0, 0.0, 0.0, 0.25))
    square = SplineOutline(Port("a", "b"), "a", numbers, (1.0, 0.0, 0.0, 0.0, 1.0, 0.0), PICTURE, True)
    for index, (across, down) in enumerate(ways):
        normal = splines.find_normal(square, SIGHT, index)
        assert math.hypot(*normal) == pytest.approx(1.0) and (across * normal[0] > 0.1 and down * normal[1] > 0.1)
        x, y = SIGHT.place(square.places[index])
        grip = splines.place_feather(square, SIGHT, index, 2.0)
        assert math.dist(grip, (x, y)) == pytest.approx(22.0 * 2.0 + 0.125 * 300.0)  # half of the soft edge
        assert (grip[0] - x) * normal[1] == pytest.approx((grip[1] - y) * normal[0])
    assert splines.measure_height(SIGHT) == 300.0


def test_the_mouse_is_at_points_then_at_curves(context, outline: SplineOutline) -> None:
    for index, place in enumerate(outline.places):
        x, y = SIGHT.place(place)
        for away, part in ((8.9, "point"), (9.1, None)):
            target = splines.find_spline(context, SIGHT, (x + away, y), 1.0)
            assert target is None or target.part != "point" or part == "point"
            if part:
                assert target == SplineTarget(outline, "point", index)
    x, y = SIGHT.place(outline.trace_curve(0)[12])
    target = splines.find_spline(context, SIGHT, (x, y + 4.0), 1.0)
    assert target is not None and (target.part, target.index) == ("curve", 0) and abs(target.t - 0.5) < 0.02
    assert splines.find_spline(context, SIGHT, (x, y - 5.5), 1.0) is None
    assert splines.find_spline(context, SIGHT, (x, y - 5.5), 2.0) is not None


def test_of_one_selected_point_tangents_and_feather_are_hit(context, outline: SplineOutline) -> None:
    select(context, outline, 1)
    for part, place in splines.list_tangents(outline, 1):
        assert splines.find_spline(context, SIGHT, SIGHT.place(place), 1.0) == SplineTarget(outline, part, 1)
    grip = splines.place_feather(outline, SIGHT, 1, 1.0)
    assert splines.find_spline(context, SIGHT, grip, 1.0) == SplineTarget(outline, "feather", 1)
    select(context, outline, 1, 2)
    assert splines.find_spline(context, SIGHT, grip, 1.0) is None


@pytest.mark.parametrize(
    ("at", "away", "along"),
    [((5.0, 3.0), 3.0, 0.5), ((-3.0, 4.0), 5.0, 0.0), ((13.0, -4.0), 5.0, 1.0), ((2.5, 0.0), 0.0, 0.25)],
)
def test_distances_to_a_line_end_at_its_ends(at, away: float, along: float) -> None:
    assert splines._measure_segment(at, (0.0, 0.0), (10.0, 0.0)) == (away, along)  # pyright: ignore
    assert splines._measure_segment((3.0, 4.0), (0.0, 0.0), (0.0, 0.0)) == (5.0, 0.0)  # pyright: ignore


def test_a_drag_moves_selected_points_by_the_same_pixels(context, outline: SplineOutline) -> None:
    select(context, outline, 2)
    target = SplineTarget(outline, "point", 0)
    spline_edits.move_part(context, target, (0.1, -0.05), (0.0, 0.0), is_broken=False, pulls_tangents=False)
    inverse = np.linalg.inv(np.array([[1.5, 0.25], [-0.5, 2.0]])) @ (40.0, -10.0)
    points = moved(context)
    for index in (0, 2):
        assert points[index][:2] == pytest.approx(np.array(POINTS[index][:2]) + inverse, abs=2e-6)
        assert points[index][2:] == POINTS[index][2:]
    assert points[1] == POINTS[1] and points[3] == POINTS[3]
    assert context.interface.dragging and context.commands[0].merge == outline.token


@pytest.mark.parametrize(("part", "is_broken"), [("in", False), ("in", True), ("out", False), ("out", True)])
def test_a_tangent_takes_the_other_one_along_unless_it_is_broken(
    context, outline: SplineOutline, part: Any, is_broken: bool
) -> None:
    to, target = outline.to_picture((117.0, 16.0)), SplineTarget(outline, part, 1)
    spline_edits.move_part(context, target, (0.0, 0.0), to, is_broken=is_broken, pulls_tangents=False)
    point = moved(context)[1]
    ours, other = (point[2:4], point[4:6]) if part == "in" else (point[4:6], point[2:4])
    assert ours == pytest.approx((7.0, -4.0))
    kept = POINTS[1][4:6] if part == "in" else POINTS[1][2:4]
    assert (
        other == pytest.approx(kept if is_broken else (-7.0, 4.0)) and point[6] == 0.125 and point[:2] == (110.0, 20.0)
    )


def test_a_point_that_pulls_tangents_stays(context, outline: SplineOutline) -> None:
    to, target = outline.to_picture((14.0, 13.0)), SplineTarget(outline, "point", 0)
    spline_edits.move_part(context, target, (0.3, 0.3), to, is_broken=True, pulls_tangents=True)
    assert moved(context)[0] == pytest.approx((10.0, 10.0, -4.0, -3.0, 4.0, 3.0, 0.0))


@pytest.mark.parametrize("feather", [0.0, 0.04, 0.3])
def test_a_feather_is_where_its_grip_is_dragged(context, outline: SplineOutline, feather: float) -> None:
    """`place_feather` is the inverse. Inside of its point there is none."""
    (x, y), (across, down) = SIGHT.place(outline.places[1]), splines.find_normal(outline, SIGHT, 1)
    away = 22.0 * 1.5 + 0.5 * feather * 300.0
    at = x + across * away, y + down * away
    spline_edits.drag_feather(context, SplineTarget(outline, "feather", 1), SIGHT, at, 1.5)
    assert moved(context)[1] == (*POINTS[1][:6], pytest.approx(feather, abs=1e-5))
    spline_edits.drag_feather(context, SplineTarget(outline, "feather", 1), SIGHT, (x, y), 1.5)
    assert moved(context)[1][6] == 0.0


def test_arrows_move_by_pixels(context, outline: SplineOutline) -> None:
    select(context, outline, 3)
    spline_edits.nudge_points(context, (8.0, -6.0))
    inverse = np.linalg.inv(np.array([[1.5, 0.25], [-0.5, 2.0]])) @ (8.0, -6.0)
    assert moved(context)[3][:2] == pytest.approx(np.array((20.0, 50.0)) + inverse, abs=2e-6)
    assert moved(context)[:3] == [*POINTS[:3]]


def test_a_press_selects_and_shift_adds_or_takes_away(context, outline: SplineOutline) -> None:
    for index, adds, selected in (
        (1, False, {1}),
        (2, True, {1, 2}),
        (1, False, {1, 2}),
        (2, True, {1}),
        (3, False, {3}),
    ):
        spline_edits.begin_move(context, SplineTarget(outline, "point", index), adds=adds)
        assert splines.find_selected(context, outline) == sorted(selected)
    assert context.items == {"roto.shapes": "leaf"}
    spline_edits.select_alone(context, SplineTarget(outline, "curve", 0))
    assert splines.find_selected(context, outline) == [3]
    spline_edits.select_alone(context, SplineTarget(outline, "point", 0))
    assert splines.find_selected(context, outline) == [0]
    spline_edits.begin_move(context, SplineTarget(outline, "curve", 0), adds=False)
    assert splines.find_selected(context, outline) == []


def test_points_are_inserted_and_removed_in_all_keys(context, outline: SplineOutline) -> None:
    spline_edits.insert_on_curve(context, SplineTarget(outline, "curve", 3, 0.5))
    command = context.commands[-1]
    assert isinstance(command, ChangePoints) and command.origins == (0, 1, 2, 3, None)
    assert splines.find_selected(context, outline) == []  # number 4 is there only after the command
    assert context.viewer.pen.selection[1] == {4}
    spline_edits.insert_on_curve(context, SplineTarget(outline, "curve", 0, 0.5))
    assert context.commands[-1].origins == (0, None, 1, 2, 3)
    select(context, outline, 0, 2)
    assert spline_edits.has_selected_points(context) and spline_edits.can_remove_points(context)
    spline_edits.remove_points(context)
    assert context.commands[-1].origins == (1, 3) and [*context.commands[-1].change(POINTS)] == [POINTS[1], POINTS[3]]
    assert not spline_edits.has_selected_points(context) and not spline_edits.can_remove_points(context)
    spline_edits.select_all_points(context)
    assert splines.find_selected(context, outline) == [0, 1, 2, 3] and not spline_edits.can_remove_points(context)


@pytest.mark.parametrize("seed", range(4))
def test_a_lasso_holds_what_winds_around(seed: int) -> None:
    """Of a closed line through the turned corners of a star; the reference sums the angles to its corners."""
    random = np.random.default_rng(seed)
    angles = np.sort(random.uniform(0.0, 2.0 * np.pi, 9))
    radii = random.uniform(0.1, 0.5, 9)
    lasso = [(0.5 + r * math.cos(a), 0.5 + r * math.sin(a)) for a, r in zip(angles, radii, strict=True)]
    for x, y in random.random((200, 2)):
        ways = np.array(lasso) - (x, y)
        turns = np.angle(np.roll(ways[:, 0] + 1j * ways[:, 1], -1) / (ways[:, 0] + 1j * ways[:, 1])).sum()
        assert spline_edits._is_inside((x, y), lasso) is bool(round(turns / (2.0 * np.pi)) % 2)  # pyright: ignore


def test_a_lasso_adds_to_what_is_selected_and_an_empty_one_selects_none(context, outline: SplineOutline) -> None:
    select(context, outline, 2)
    x, y = outline.places[0]
    context.viewer.pen.lasso = [(x - 0.01, y - 0.01), (x + 0.01, y - 0.01), (x + 0.01, y + 0.01), (x - 0.01, y + 0.01)]
    spline_edits.select_in_lasso(context)
    assert splines.find_selected(context, outline) == [0, 2] and context.viewer.pen.lasso == []
    spline_edits.select_in_lasso(context)
    assert splines.find_selected(context, outline) == []


def test_points_are_copied_by_their_numbers(context, outline: SplineOutline) -> None:
    assert not spline_edits.can_paste_points(context)
    spline_edits.copy_points(context)
    assert dict(context.viewer.pen.copied) == dict(enumerate(POINTS))
    select(context, outline, 1)
    spline_edits.copy_points(context)
    assert dict(context.viewer.pen.copied) == {1: POINTS[1]} and spline_edits.can_paste_points(context)
    context.viewer.pen.copied = {1: POINTS[0], 9: POINTS[0]}
    spline_edits.paste_points(context)
    assert moved(context) == [POINTS[0], POINTS[0], *POINTS[2:]]
    context.viewer.pen.copied = {4: POINTS[0]}
    assert not spline_edits.can_paste_points(context)


def test_the_pen_sets_corners_and_pulls_tangents(context, outline: SplineOutline) -> None:
    context.viewer.pen.shape = str(outline.points_port)
    first = SIGHT.place(outline.places[0])
    assert spline_edits.find_pen(context, SIGHT, (first[0] + 8.9, first[1]), 1.0) == "close"
    assert spline_edits.find_pen(context, SIGHT, (first[0] + 9.1, first[1]), 1.0) == "new"
    spline_edits.aim_pen(context, outline.to_picture((30.0, 40.0)), None)
    assert context.viewer.pen.pending == pytest.approx((30.0, 40.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    spline_edits.aim_pen(context, outline.to_picture((30.0, 40.0)), outline.to_picture((33.0, 38.0)))
    assert context.viewer.pen.pending == pytest.approx((30.0, 40.0, -3.0, 2.0, 3.0, -2.0, 0.0))
    point = context.viewer.pen.pending
    spline_edits.lift_pen(context)
    assert context.commands[-1].origins == (0, 1, 2, 3, None) and context.commands[-1].change(POINTS)[4] == point
    assert context.viewer.pen.selection[1] == {4} and context.viewer.pen.pending is None
    spline_edits.lift_pen(context)
    assert len(context.commands) == 1


def test_a_new_shape_has_the_next_number(context, monkeypatch, outline: SplineOutline) -> None:
    names = [
        SplineOutline(outline.points_port, name, (), AFFINE, PICTURE, False) for name in ("shape_3", "shape_7", "leaf")
    ]
    monkeypatch.setattr(spline_edits, "list_outlines", lambda context: names)
    monkeypatch.setattr(spline_edits, "_find_replaced", lambda context: None)
    context.viewer.pen.pending = POINTS[0]
    spline_edits.lift_pen(context)
    command = context.commands[-1]
    assert (command.port, command.name) == (Port("roto", "shapes"), "shape_8") and command.fields == {
        "points": POINTS[0]
    }
    assert context.viewer.pen.selection == ("roto.shapes.shape_8.points", frozenset({0}))
    assert context.items == {"roto.shapes": "shape_8"}


def test_the_first_point_takes_the_place_of_the_shape_that_a_list_begins_with(
    context, monkeypatch, outline: SplineOutline
) -> None:
    monkeypatch.setattr(spline_edits, "_find_replaced", lambda context: outline)
    context.viewer.pen.pending = POINTS[2]
    spline_edits.lift_pen(context)
    (command,) = context.commands
    assert isinstance(command, ChangePoints) and command.origins == (None,)
    assert [*command.change(POINTS)] == [POINTS[2]] and context.viewer.pen.shape == str(outline.points_port)
    assert context.viewer.pen.selection == (str(outline.points_port), {0})
