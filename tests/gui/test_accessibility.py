"""High contrast, less motion, and the smallest and the largest interface."""

from __future__ import annotations

import numpy as np
import pytest
from gui_driver import Ui
from halation import presets
from halation.authoring.log import TOAST_SECONDS
from halation.editor.shared.window_commands import PanelTitle
from imgui_bundle import imgui


def test_high_contrast_is_chosen_in_the_preferences(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.keys("Ctrl+Comma")
        ui.click("theme contrast")
        ui.shot("contrast_preferences.png")
        ui.keys("Escape")
        ui.settled()
        pixels = ui.pixels("contrast.png").reshape(-1, 3)
        assert (pixels == 0).all(1).mean() > 0.3  # most of the window is plain black
        assert ui.editor.palette.name == "contrast"

    gui(body, presets.paths()[0])


def test_less_motion_stops_what_blinks_and_fades(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        assert imgui.get_io().config_input_text_cursor_blink
        ui.keys("Ctrl+Comma")
        ui.click("preference reduced_motion", fraction=(0.05, 0.5))
        assert ui.editor.store.current.reduced_motion
        ui.keys("Escape")
        ui.wait(2)
        assert not imgui.get_io().config_input_text_cursor_blink
        ui.editor.log.add("a message", "warning")
        ui.wait(3)
        box = tuple(int(part) for part in ui.editor.places["toast 0"])
        first = ui.pixels()[box[1] : box[3], box[0] : box[2]]
        ui.until(lambda: ui.editor.log.age(ui.editor.log.entries[-1]) > TOAST_SECONDS - 0.3)
        last = ui.pixels()[box[1] : box[3], box[0] : box[2]]
        assert np.array_equal(first, last)

    gui(body, presets.paths()[0])


@pytest.mark.parametrize(("scale", "size"), [(0.75, (1366, 768)), (3.0, (3840, 2160))])
def test_the_smallest_and_the_largest_interface_cut_nothing_off(gui, scale: float, size: tuple[int, int]) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.shot(f"scale_{scale:g}.png")
        assert not ui.editor.faults
        for place in ("Viewer", "Graph", "Inspector"):
            left, top, right, bottom = ui.editor.places[place]
            assert left >= -1 and top >= -1 and right <= size[0] + 1 and bottom <= size[1] + 1
            assert right - left > 150 * scale and bottom - top > 100 * scale
        ui.keys("Ctrl+Comma")
        left, top, right, bottom = ui.editor.places["close preferences"]
        assert right <= size[0] and bottom <= size[1]
        ui.shot(f"scale_preferences_{scale:g}.png")

    gui(body, presets.paths()[0], size=size, likes={"ui_scale": scale})


@pytest.mark.parametrize(("panel", "count"), [("Scopes", 6), ("Renders", 8), ("Log", 3), ("Inspector", 8)])
def test_the_keyboard_walks_through_a_panel(gui, panel: str, count: int) -> None:
    """Each press of Tab leads to another field with a ring around it, also after the pointer was over the graph."""

    def body(ui: Ui) -> None:
        ui.settled()
        ui.show_panel(panel)
        ui.click(panel, fraction=(0.5, 0.98))
        ui.editor.scope = "graph"
        reached = set[int]()
        for _ in range(count):
            ui.keys("Tab")
            navigation = imgui.get_current_context()
            assert navigation.nav_cursor_visible and navigation.nav_window.root_window.name.startswith(panel)
            reached.add(navigation.nav_id)
        assert len(reached) == count and 0 not in reached
        assert not imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup))

    gui(body, presets.paths()[0], size=(1366, 768))


def test_the_graph_and_the_bars_of_panels_are_reached_by_keyboard(gui) -> None:
    """Ctrl+Tab leads to panels, wherever the pointer rests; arrows with Alt lead through the graph."""

    def lead_to(ui: Ui, panel: PanelTitle) -> None:
        for presses in range(1, 14):  # each time further back in the order in which windows had the focus
            with ui.held("Ctrl"):
                for _ in range(presses):
                    ui.ctx.key_press(int(imgui.Key.tab))
                    ui.wait(2)
            ui.wait(3)
            if ui.editor.interface.walked_panel == panel:
                return
        raise AssertionError(f"no way leads to {panel}")

    def body(ui: Ui) -> None:
        ui.settled()
        ui.move("Inspector", (0.5, 0.98))
        lead_to(ui, PanelTitle.GRAPH)
        assert ui.editor.scope == "graph"
        ui.keys("Alt+LeftArrow")
        first = ui.session.active
        assert first
        ui.keys("Alt+RightArrow")
        ui.keys("Alt+LeftArrow")
        assert ui.session.active and ui.session.selection == {ui.session.active}
        ui.keys("Ctrl+Shift+RightArrow")
        assert len(ui.session.selection) == 2
        ui.shot("graph_walked.png")
        lead_to(ui, PanelTitle.VIEWER)
        ui.keys("Tab")
        context = imgui.get_current_context()
        assert context.nav_cursor_visible and context.nav_window.root_window.name.startswith("Viewer")
        assert not imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup))
        ui.move("Viewer", (0.5, 0.5))
        assert ui.editor.interface.walked_panel is None

    gui(body, presets.paths()[0], size=(1366, 768))
