"""The viewer and the scopes, moved by mouse and keyboard."""

from __future__ import annotations

import halation as hal
import numpy as np
import pytest
from gui_viewer import HEIGHT, PRESET, WIDTH, hover, inside, seen, shown_plainly
from halation.graph import Port


def test_shows_numbers_of_the_picture_below_it(gui) -> None:
    found = {}

    def body(ui) -> None:
        ui.settled()
        hover(ui)
        found["pixel"] = ui.editor.viewer.pixel
        ui.keys("Ctrl+C")
        found["text"] = ui.editor.clipboard.get()

    gui(body, PRESET)
    x, y = found["pixel"]
    name, numbers = found["text"].split(": ")
    assert name == f"outputs.image {x} {y}"
    expected = hal.render(hal.load(PRESET))["image"][y, x]
    assert [float(part) for part in numbers.split()] == pytest.approx([float(part) for part in expected], rel=1e-5)


def test_keys_choose_channels_and_again_all(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        hover(ui)
        for key, channels in (("R", "red"), ("G", "green"), ("L", "luminance"), ("L", "color"), ("A", "alpha")):
            ui.keys(key)
            assert ui.editor.viewer.channels == channels
        assert (seen(ui, 0.3, 0.7) == 255).all()  # it is opaque
        hover(ui)
        ui.keys("R")
        gray = seen(ui, 0.3, 0.7)
        assert gray[0] == gray[1] == gray[2] < 255

    gui(body, PRESET)


def test_exposure_is_dragged_and_reset(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        before = seen(ui, 0.3, 0.7)
        left, top, right, bottom = ui.editor.places["field viewer exposure"]
        ui.drag("field viewer exposure", ((left + right) / 2 + 60, (top + bottom) / 2))
        assert ui.editor.viewer.exposure > 0.5
        assert (seen(ui, 0.3, 0.7) > before).all()
        ui.click("button viewer.neutral")
        assert ui.editor.viewer.exposure == 0.0
        assert (seen(ui, 0.3, 0.7) == before).all()
        assert not ui.session.dirty

    gui(body, PRESET)


def test_the_wipe_shows_both_and_is_dragged(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        a = seen(ui, 0.8, 0.85)
        ui.session.views.show(Port("inputs", "beauty"), "B")
        hover(ui)
        ui.keys("W")
        ui.settled()
        assert ui.editor.preview.find_whole_image("B").port == Port("inputs", "beauty")
        b = seen(ui, 0.8, 0.85)
        assert (a != b).any()
        # The line of numbers for B makes the picture a little smaller: A is what both sides show then.
        ui.session.views.show(Port("outputs", "image"), "B")
        ui.settled()
        a = seen(ui, 0.8, 0.85)
        assert (a != b).any()
        ui.session.views.show(Port("inputs", "beauty"), "B")
        ui.settled()
        ui.drag("viewer wipe", inside(ui, 0.95, 0.5))
        assert ui.editor.viewer.wipe == pytest.approx((0.95, 0.5), abs=0.01)
        assert (seen(ui, 0.8, 0.85) == a).all()
        left, top = ui.at("viewer wipe")
        ui.drag("viewer wipe angle", (left - 80.0, top))
        assert ui.editor.viewer.wipe_angle == pytest.approx(90.0)
        assert (seen(ui, 0.8, 0.85) == b).all()
        hover(ui, 0.3, 0.3)
        ui.keys("Q")
        alone = seen(ui, 0.3, 0.2)
        ui.editor.viewer.compare, ui.editor.viewer.wipe = "wipe", (0.5, 0.0)  # B everywhere
        ui.wait(3)
        assert (seen(ui, 0.3, 0.2) == alone).all()

    gui(body, PRESET)


def test_the_wheel_keeps_the_pixel_under_the_pointer(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        viewer = ui.editor.viewer
        hover(ui, 0.3, 0.6)
        before = viewer.pixel
        ui.wheel(12)
        ui.wait(3)
        assert viewer.zoom > 5.0 and viewer.pixel == pytest.approx(before, abs=1)
        near = viewer.zoom, viewer.pan
        ui.session.views.show(Port("inputs", "beauty"))
        viewer.proxy = 0.5
        ui.settled()
        assert (viewer.zoom, viewer.pan) == near and viewer.pixel == pytest.approx(before, abs=1)
        start = ui.at("viewer panel")
        ui.drag(start, (start[0] + 50.0, start[1] + 20.0), button=2)
        assert viewer.pan == pytest.approx((near[1][0] + 50.0, near[1][1] + 20.0), abs=1.0)
        ui.keys("F")
        assert viewer.zoom == 0.0
        ui.keys("0")
        assert viewer.zoom == 1.0

    gui(body, PRESET)


def test_keys_move_the_picture_by_an_eighth_of_the_panel(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        hover(ui)
        ui.keys("0")
        left, top, right, bottom = ui.editor.places["Viewer"]
        before, viewer = inside(ui, 0.5, 0.5), ui.editor.viewer
        step = viewer.panel[0] / 8, viewer.panel[1] / 8
        ui.keys("Ctrl+Shift+RightArrow")
        ui.keys("Ctrl+Shift+DownArrow")
        ui.keys("Ctrl+Shift+DownArrow")
        after = inside(ui, 0.5, 0.5)
        assert after == pytest.approx((before[0] - step[0], before[1] - 2 * step[1]), abs=1.0)
        ui.keys("Ctrl+Shift+LeftArrow")
        for _ in range(2):
            ui.keys("Ctrl+Shift+UpArrow")
        assert inside(ui, 0.5, 0.5) == pytest.approx(before, abs=1.0)
        for _ in range(20):
            ui.keys("Ctrl+Shift+LeftArrow")
        assert left < inside(ui, 0.0, 0.5)[0] < right and top < before[1] < bottom, "a part of it stays visible"

    gui(body, PRESET)


def test_at_full_size_pixels_are_shown_one_to_one(gui) -> None:
    """The noise of the picture makes every pixel different: a shift or a blur would be seen."""
    shot = {}

    def body(ui) -> None:
        ui.settled()
        ui.editor.viewer.zoom = 1.0
        ui.editor.viewer.view = "none"
        ui.move((5.0, 5.0))
        ui.wait(3)
        left, top, right, bottom = (int(part) for part in ui.editor.places["viewer image"])
        shot["seen"] = ui.pixels()[top:bottom, left:right]

    gui(body, PRESET, size=(1600, 1200))
    expected = shown_plainly(hal.render(hal.load(PRESET))["image"])
    assert shot["seen"].shape == (HEIGHT, WIDTH, 3)
    assert np.abs(shot["seen"].astype(int) - expected).max() <= 1
