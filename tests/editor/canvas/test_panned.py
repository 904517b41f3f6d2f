"""How wheels and dragging near a border move the view: by so many pixels, whatever the zoom."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.canvas.frame import CanvasFrame, apply_wheel, pan_at_border
from halation.editor.canvas.geometry import CanvasTransform, make_transform

PANEL = (100.0, 50.0, 900.0, 650.0)


def make_frame(zoom: float, scale: float, screen: tuple[float, float] = (500.0, 350.0)) -> CanvasFrame:
    """A canvas whose middle is the point 40, -20 of the graph."""
    to = make_transform(PANEL, (40.0, -20.0), zoom * scale)
    context: Any = SimpleNamespace(canvas=SimpleNamespace(center=(40.0, -20.0), zoom=zoom))
    scene: Any = None
    return CanvasFrame(context, scene, to, PANEL, scale, True, to.to_canvas(*screen), screen)


def moved(frame: CanvasFrame) -> tuple[float, float]:
    """How many pixels the view has moved."""
    x, y = frame.context.canvas.center
    return (x - 40.0) * frame.to.scale, (y + 20.0) * frame.to.scale


def turn(frame: CanvasFrame, across: float, down: float, *, shift: bool = False, ctrl: bool = False) -> None:
    io: Any = SimpleNamespace(mouse_wheel_h=across, mouse_wheel=down, key_shift=shift, key_ctrl=ctrl)
    apply_wheel(frame, io, on_field=True)


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("zoom", [0.5, 1.0, 3.0])
def test_a_wheel_pans_by_pixels(zoom: float, scale: float) -> None:
    for words, expected in (
        ({"across": 2.0, "down": 0.0}, (-120.0, 0.0)),
        ({"across": 1.0, "down": 3.0}, (-60.0, -180.0)),
        ({"across": 0.0, "down": 2.0, "shift": True}, (-120.0, 0.0)),
        ({"across": 0.0, "down": 2.0, "ctrl": True}, (0.0, 0.0)),
        ({"across": 0.0, "down": 0.0}, (0.0, 0.0)),
    ):
        frame = make_frame(zoom, scale)
        turn(frame, **words)
        assert moved(frame) == pytest.approx((expected[0] * scale, expected[1] * scale))
        assert frame.context.canvas.zoom == zoom


@pytest.mark.parametrize("down", [-2.0, 1.0])
def test_a_wheel_zooms_about_the_pointer(down: float) -> None:
    frame = make_frame(0.8, 1.0, (700.0, 200.0))
    turn(frame, 0.0, down)
    view = frame.context.canvas
    assert view.zoom == pytest.approx(0.8 * 1.15**down)
    to = CanvasTransform(500.0 - view.center[0] * view.zoom, 350.0 - view.center[1] * view.zoom, view.zoom)
    assert to.to_screen(*frame.pointer) == pytest.approx((700.0, 200.0), abs=1.0)


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("zoom", [0.5, 1.0, 3.0])
def test_dragging_at_a_border_pans_by_pixels_a_second(zoom: float, scale: float) -> None:
    """900 a second right at it, half of that in the middle of its 28, and never more than a twentieth of a second's."""
    for (x, y), seconds, expected in (
        ((100.0, 350.0), 0.02, (-18.0, 0.0)),
        ((900.0 - 14.0 * scale, 350.0), 0.02, (9.0, 0.0)),
        ((500.0, 650.0), 0.04, (0.0, 36.0)),
        ((500.0, 50.0), 3.0, (0.0, -45.0)),
        ((100.0 + 29.0 * scale, 350.0), 0.02, (0.0, 0.0)),
    ):
        frame = make_frame(zoom, scale, (x, y))
        io: Any = SimpleNamespace(delta_time=seconds)
        pan_at_border(frame, io)
        assert moved(frame) == pytest.approx((expected[0] * scale, expected[1] * scale))


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_click_may_move_by_four_pixels(scale: float) -> None:
    frame = make_frame(0.5, scale, (500.0, 350.0))
    start = frame.to.to_canvas(500.0 - 4.0 * scale, 350.0 + 3.0 * scale)
    assert not frame.is_far(start)
    assert frame.is_far(frame.to.to_canvas(500.0 - 4.5 * scale, 350.0)) and frame.is_far(
        frame.to.to_canvas(500.0, 350.0 + 4.5 * scale)
    )
