"""Panels that fill the window, the viewer on the whole screen, and handles that are hidden."""

from __future__ import annotations

import pytest
from halation import presets
from halation.authoring.commands import AddNode
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.toolkit.keys import chord
from imgui_bundle import imgui

BLOOM = next(path for path in presets.paths() if path.stem == "soft_bloom")


def width_of(ui, title: str) -> float:
    left, _, right, _ = ui.editor.places.get(title, (0.0, 0.0, 0.0, 0.0))
    return right - left


@pytest.mark.parametrize(("title", "place"), [("Viewer", (0.5, 0.5)), ("Graph", (0.5, 0.9)), ("Inspector", (0.5, 0.9))])
def test_the_panel_under_the_pointer_fills_the_window(gui, title: str, place: tuple[float, float]) -> None:
    def body(ui) -> None:
        ui.settled()
        narrow = width_of(ui, title)
        ui.move(title, place)
        ui.keys("Ctrl+Space")
        ui.wait(6)
        left, top, right, bottom = ui.editor.places[title]
        assert right - left > 1390 > narrow and bottom - top > 700
        assert not imgui.get_current_context().nav_cursor_visible, "nobody has chosen anything in it by the keyboard"
        ui.keys("Ctrl+Space")
        ui.wait(6)
        assert width_of(ui, title) == narrow and not ui.editor.timeline.playback.playing

    gui(body, BLOOM)


def test_the_tabs_in_front_stay_in_front(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.ctx.window_focus("//Problems")
        ui.wait(3)
        front = {title for title in PanelTitle if title in ui.editor.places}
        assert {"Problems", "Scopes"} <= front and not {"Graph", "History"} & front
        ui.move("Viewer")
        for _ in range(2):
            ui.keys("Ctrl+Space")
            ui.wait(15)
        assert {title for title in PanelTitle if title in ui.editor.places} == front

    gui(body, BLOOM)


def test_a_panel_that_is_asked_for_is_seen(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.keys("F11")
        ui.wait(6)
        assert "Inspector" not in ui.editor.places
        ui.keys("F12")
        ui.wait(15)
        assert {"Renders", "Inspector"} <= ui.editor.places.keys()

    gui(body, BLOOM)


def test_letting_go_of_ctrl_first_does_not_play(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.move("Graph", (0.5, 0.9))
        ui.ctx.key_down(chord("Ctrl+Space"))
        ui.wait(2)
        ui.ctx.key_up(chord("Ctrl+Space") - chord("Space"))
        ui.wait(2)
        ui.ctx.key_up(chord("Space"))
        ui.wait(6)
        assert width_of(ui, "Graph") > 1390 and not ui.editor.timeline.playback.playing

    gui(body, BLOOM)


def test_the_viewer_fills_the_screen_and_comes_back(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        bars = ui.window.params.imgui_window_params
        before = dict(ui.editor.places)
        ui.keys("Ctrl+F11")
        ui.wait(10)
        left, top, right, _ = ui.editor.places["Viewer"]
        assert (left, top, bars.show_menu_bar, bars.show_status_bar) == (0.0, 0.0, False, False)
        assert right > 1390 and "Inspector" not in ui.editor.places
        ui.keys("Ctrl+F11")
        ui.wait(10)
        assert bars.show_menu_bar and bars.show_status_bar
        assert ui.editor.places["Inspector"] == before["Inspector"]

    gui(body, BLOOM)


def test_handles_can_be_hidden(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.apply(AddNode("vignette"))
        ui.settled()
        handles = [place for place in ui.editor.places if place.startswith("handle ")]
        assert handles
        at = ui.at(handles[0])
        ui.move("Viewer", (0.5, 0.5))
        ui.keys("H")
        ui.wait(3)
        assert not [place for place in ui.editor.places if place.startswith("handle ")]
        before = ui.session.graph
        ui.drag(at, (at[0] + 60, at[1] + 10))
        assert ui.session.graph is before
        ui.move("Viewer", (0.5, 0.5))
        ui.keys("H")
        ui.wait(3)
        assert handles == [place for place in ui.editor.places if place.startswith("handle ")]

    gui(body, BLOOM)


def test_controls_stand_first_on_a_small_screen(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        bottom = ui.editor.places["Inspector"][3]
        assert all(ui.editor.places[f"more controls.{name}"][3] < bottom for name in ui.session.graph.controls)
        assert "field frames" not in ui.editor.places
        ui.click("fold project")
        assert "field frames" in ui.editor.places

    gui(body, BLOOM, size=(1366, 768))
