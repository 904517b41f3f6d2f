"""The dialog that exports the document."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname

from gui_driver import Ui
from halation import presets
from imgui_bundle import imgui

PRESET = next(path for path in presets.paths() if path.stem == "soft_bloom")


def test_a_page_is_tried_shown_and_written_and_a_table_is_refused(gui, tmp_path: Path, monkeypatch) -> None:
    shown: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda address: shown.append(address) or True)
    target = tmp_path / "page"

    def body(ui: Ui) -> None:
        ui.settled()
        ui.window._contexts.dialogs.actions.run("file.export")
        dialog = ui.window._overlays["Export"]
        ui.wait(3)
        ui.click("export size")
        ui.type("96x54")
        ui.until(lambda: dialog._trial is not None and dialog._trial.outcome is not None)
        ui.until(lambda: dialog._trial is not None and dialog._trial.choices.size == "96x54" and dialog._trial.outcome)
        assert not dialog._trial.outcome.fault
        ui.wait(3)
        ui.shot("export.png")
        ui.click("export preview")
        page = Path(url2pathname(urlparse(shown[0]).path))
        assert "<html" in page.read_text(encoding="utf-8")
        ui.click("export write")
        ui.wait(3)
        assert ui.editor.dialogs.browse is not None and ui.editor.dialogs.browse.name.endswith(".html")
        browse, ui.editor.dialogs.browse = ui.editor.dialogs.browse, None
        browse.then(target)
        ui.until(lambda: dialog._export is not None and dialog._export.outcome is not None)
        assert "<html" in target.with_suffix(".html").read_text(encoding="utf-8")
        ui.click("export kind")
        ui.click("export kind cube: a table of colors with a shaper, for grading programs")
        ui.until(lambda: dialog._trial.choices.kind == "cube" and dialog._trial.outcome is not None)
        assert "bloom" in dialog._trial.outcome.fault
        ui.shot("export_refused.png")
        ui.click("export close")
        ui.wait(3)
        assert "export" not in ui.editor.dialogs.open and dialog._trial is None

    gui(body, PRESET)


def test_the_enter_that_opens_a_dialog_does_not_answer_it(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.window._contexts.dialogs.actions.run("file.export")
        dialog = ui.window._overlays["Export"]
        ui.until(lambda: dialog._trial is not None and dialog._trial.outcome is not None)
        ui.wait(3)
        ui.keys("Tab")
        first = imgui.get_current_context().nav_id  # the format
        ui.keys("Tab")
        while imgui.get_current_context().nav_id != first:
            last = imgui.get_current_context().nav_id
            ui.keys("Tab")
        ui.keys("Shift+Tab")
        assert imgui.get_current_context().nav_id == last
        ui.keys("Enter")
        assert ui.editor.dialogs.browse is not None and dialog._export is None
        ui.keys("Escape")
        assert ui.editor.dialogs.browse is None

        ui.keys("Escape")
        ui.keys("Ctrl+P")
        ui.type("save as", enter=False)
        ui.keys("Enter")
        assert ui.editor.dialogs.browse is not None
        assert "palette" not in ui.editor.dialogs.open

    gui(body, PRESET)
