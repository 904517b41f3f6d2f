"""The preferences: every widget changes what it says, at once, and keeps it in the file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from gui_driver import Ui
from halation import presets
from halation.authoring.preferences import Preferences

PRESET = presets.paths()[0]
SWITCHES = ("reduced_motion", "separate_windows", "thumbnails", "timings", "minimap", "proxy_while_dragging")


def open_page(ui: Ui, page: str) -> None:
    ui.settled()
    ui.keys("Ctrl+Comma")
    ui.click(f"page {page}")


def read_file(ui: Ui) -> dict[str, object]:
    ui.editor.store.flush()
    return json.loads(ui.editor.store.file.read_text())


def test_the_page_of_the_interface(gui) -> None:
    def body(ui: Ui) -> None:
        open_page(ui, "Interface")
        store = ui.editor.store
        for theme in ("light", "contrast", "dark"):
            ui.click(f"theme {theme}", fraction=(0.1, 0.5))
            assert store.current.theme == theme
        for name in SWITCHES:
            before = getattr(store.current, name)
            ui.click(f"preference {name}", fraction=(0.03, 0.5))
            assert getattr(store.current, name) is not before, name
        flipped = {name: not getattr(Preferences(), name) for name in SWITCHES}
        assert {name: read_file(ui)[name] for name in SWITCHES} == flipped
        ui.click("language")
        ui.click("language Deutsch")
        assert store.current.language == "de"
        ui.click("language")
        ui.click("language Wie das System")
        assert store.current.language == ""
        ui.click("ui scale")
        ui.click("ui scale 125%")
        assert store.current.ui_scale == 1.25
        ui.wait(4)
        ui.click("ui scale")
        ui.click("ui scale Same as the system")
        assert store.current.ui_scale == 0.0

    gui(body, PRESET, size=(1200, 900))


def test_the_page_of_the_system(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        open_page(ui, "System")
        store = ui.editor.store
        for name, typed, value in (("autosave", "2.5", 2.5), ("memory_budget", "1024", 1024)):
            ui.click(f"preference {name}", keys="Ctrl")
            ui.type(typed)
            assert getattr(store.current, name) == value
        assert ui.editor.recovery.interval == 2.5
        for kind in ("preset", "isf"):
            folders = tuple(str(tmp_path / f"{kind}{number}") for number in range(2))
            for folder in folders:
                ui.click(f"field {kind} folder")
                ui.type(folder, enter=False)
                ui.click(f"button add {kind}")
            assert getattr(store.current, f"{kind}_folders") == folders
            ui.click(f"forget {kind} 0")
            assert getattr(store.current, f"{kind}_folders") == folders[1:]
        assert read_file(ui)["isf_folders"] == [str(tmp_path / "isf1")]
        ui.click("reset preferences")
        assert (store.current.autosave, store.current.memory_budget) == (5.0, 512)
        assert store.current.isf_folders == (str(tmp_path / "isf1"),), "lists are no settings"
        ui.click("close preferences")
        assert "preferences" not in ui.editor.dialogs.open

    gui(body, PRESET, size=(1200, 900))


@pytest.mark.parametrize("way", ["Escape", "outside"])
def test_it_closes(gui, way: str) -> None:
    def body(ui: Ui) -> None:
        open_page(ui, "Interface")
        left, top, _, _ = ui.editor.places["dialog Preferences"]
        if way == "Escape":
            ui.keys("Escape")
        else:
            ui.click((left - 30.0, top + 60.0))
        assert "preferences" not in ui.editor.dialogs.open

    gui(body, PRESET, size=(1200, 900))
