"""Where the picture lies in the panel."""

import math

import pytest
from halation.editor.viewer.geometry import (
    Sight,
    box_grip,
    drag_box,
    order_box,
    texel,
    texels,
    wipe_angle,
    wipe_direction,
    wipe_grip,
)
from halation.editor.viewer.grips import GRIP_REACH
from halation.editor.viewer.handles import place_grip

SIGHT = Sight((100.0, 50.0), (800, 600), (400, 200), zoom=3.0, pan=(17.0, -5.0))


def test_without_a_zoom_the_picture_fits_and_is_centered() -> None:
    sight = Sight.of((0.0, 0.0), (800, 600), (400, 200), 0.0, (99.0, 99.0))
    assert sight.zoom == 2.0
    assert sight.rectangle((0.0, 0.0, 1.0, 1.0)) == (0.0, 100.0, 800.0, 500.0)


@pytest.mark.parametrize("density", [1.0, 2.0])
def test_screen_and_picture_positions_are_inverse(density: float) -> None:
    sight = Sight((100.0, 50.0), (800, 600), (400, 200), 3.0, (17.0, -5.0), density)
    assert sight.pixel(sight.screen((12.25, 180.5))) == pytest.approx((12.25, 180.5))
    assert sight.place(sight.fraction((333.0, 222.0))) == pytest.approx((333.0, 222.0))


@pytest.mark.parametrize("density", [1.0, 2.0])
def test_a_grip_at_the_edge_of_the_panel_is_moved_in(density: float) -> None:
    """So that all of it can be hit; one far outside is not seen, and stays where it is."""
    sight = Sight((100.0, 50.0), (int(800 * density), int(600 * density)), (400, 200), density, density=density)
    assert sight.screen((0.0, 0.0)) == (300.0, 250.0) and GRIP_REACH < 20.0
    for at, expected in (
        ((-200.0, -200.0), (100.0 + 2 * GRIP_REACH, 50.0 + 2 * GRIP_REACH)),
        ((600.0, 400.0), (900.0 - 2 * GRIP_REACH, 650.0 - 2 * GRIP_REACH)),
        ((-300.0, 100.0), (0.0, 350.0)),
        ((700.0, 500.0), (1000.0, 750.0)),
        ((200.0, 100.0), (500.0, 350.0)),
    ):
        assert place_grip(sight, at, 2.0) == expected


@pytest.mark.parametrize("factor", [1.2, 0.5, 1000.0, 1e-9])
def test_zooming_keeps_what_is_under_the_pointer(factor: float) -> None:
    at = (640.0, 123.0)
    zoomed = SIGHT.zoom_by(factor, at)
    now, before = zoomed.pixel(at), SIGHT.pixel(at)  # pictures lie on whole pixels of the panel
    assert now == pytest.approx(before, abs=0.51 / SIGHT.zoom + 0.51 / zoomed.zoom)


def test_zooming_in_and_out_again_changes_nothing() -> None:
    at, sight = (640.0, 123.0), SIGHT
    for factor in [1.1] * 20 + [1 / 1.1] * 20:
        sight = sight.zoom_by(factor, at)
    assert (sight.zoom, *sight.pan) == pytest.approx((SIGHT.zoom, *SIGHT.pan))


def test_panning_follows_the_hand_and_never_loses_the_picture() -> None:
    at = SIGHT.pixel((300.0, 300.0))
    assert SIGHT.pan_by(20.0, -8.0).screen(at) == pytest.approx((320.0, 292.0))
    left, top, right, bottom = SIGHT.pan_by(1e6, -1e6).rectangle((0.0, 0.0, 1.0, 1.0))
    assert left < 900.0 and bottom > 50.0 and right > left and top < bottom


def test_only_the_picture_has_pixels() -> None:
    assert SIGHT.under(SIGHT.screen((0.5, 0.5))) == (0, 0)
    assert SIGHT.under(SIGHT.screen((399.9, 199.9))) == (399, 199)
    assert SIGHT.under(SIGHT.screen((400.1, 10.0))) is None
    assert SIGHT.under(SIGHT.screen((-0.1, 10.0))) is None


def test_pixels_of_proxies() -> None:
    assert texel((399, 199), (400, 200), (100, 50)) == (99, 49)
    assert texel((3, 4), (400, 200), (100, 50)) == (0, 1)
    assert texels((0.25, 0.0, 0.75, 1.0), (100, 50)) == (25, 0, 50, 50)
    assert texels((0.6, 0.5, 0.1, 0.2), (10, 10)) == (1, 2, 5, 3)
    assert texels((1.0, 1.0, 1.0, 1.0), (10, 10)) == (9, 9, 1, 1)


def test_the_wipe_is_held_by_its_line_and_its_end() -> None:
    assert wipe_direction(0.0) == pytest.approx((0.0, 1.0))
    assert wipe_direction(90.0) == pytest.approx((-1.0, 0.0))
    assert wipe_grip((402.0, 10.0), (400.0, 300.0), 0.0, 60.0, 5.0) == "line"
    assert wipe_grip((402.0, 361.0), (400.0, 300.0), 0.0, 60.0, 5.0) == "angle"
    assert wipe_grip((420.0, 300.0), (400.0, 300.0), 0.0, 60.0, 5.0) == ""


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, -120.0])
def test_the_handle_of_the_wipe_stays_under_the_pointer(angle: float) -> None:
    x, y = wipe_direction(angle)
    assert wipe_angle((400.0 + 60 * x, 300.0 + 60 * y), (400.0, 300.0)) == pytest.approx(angle)
    assert math.isclose(wipe_angle((399.0, 360.0), (400.0, 300.0)), 0.0, abs_tol=1e-9)  # attracted


def test_boxes_have_edges_corners_and_a_middle() -> None:
    box = (100.0, 100.0, 300.0, 200.0)
    found = [box_grip(at, box, 4.0) for at in ((100, 100), (200, 98), (302, 150), (200, 150), (130, 130), (90, 150))]
    assert found == ["nw", "n", "e", "move", "", ""]


def test_boxes_follow_the_hand_and_stay_inside() -> None:
    assert drag_box((0.2, 0.2, 0.5, 0.5), "se", (0.1, 0.2)) == pytest.approx((0.2, 0.2, 0.6, 0.7))
    assert drag_box((0.2, 0.2, 0.5, 0.5), "w", (0.4, 0.2)) == pytest.approx((0.5, 0.2, 0.6, 0.5))
    assert drag_box((0.2, 0.2, 0.5, 0.5), "move", (0.9, -0.9)) == pytest.approx((0.7, 0.0, 1.0, 0.3))
    assert order_box((0.9, -1.0, 0.1, 2.0)) == (0.1, 0.0, 0.9, 1.0)
