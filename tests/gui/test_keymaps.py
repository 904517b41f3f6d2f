"""Keys as in another program: chosen in the preferences, then everything that names or takes keys follows."""

from __future__ import annotations

from gui_driver import Ui
from halation import presets
from halation.editor.shared.keymaps import KEYMAPS


def test_a_keymap_is_chosen_and_counts_at_once(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.keys("Ctrl+Comma")
        ui.click("page Shortcuts")
        ui.click("keymap")
        ui.click("keymap Blender")
        ui.shot("keymap_preferences.png")
        ui.keys("Escape")
        assert ui.editor.store.current.keymap == "blender"
        ui.move("Graph", (0.5, 0.9))
        ui.keys("Tab")
        assert "search field" not in ui.editor.places
        ui.keys("Shift+A")
        ui.wait(3)
        assert "search field" in ui.editor.places
        ui.keys("Escape")
        ui.keys("Shift+F1")
        ui.wait(4)
        ui.shot("keymap_sheet.png")

    gui(body, presets.paths()[0])


def test_the_space_bar_of_nuke_fills_the_window_with_the_panel(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.move("Graph", (0.5, 0.9))
        ui.keys("Space")
        ui.wait(6)
        assert "Viewer" not in ui.editor.places and "Graph" in ui.editor.places
        assert not ui.editor.timeline.playback.playing
        ui.keys("Space")
        ui.wait(6)
        assert "Viewer" in ui.editor.places

    gui(body, presets.paths()[0], likes={"keymap": "nuke"})
    assert "Space" in KEYMAPS["nuke"].values()
