"""The file browser in the real window, mostly by keyboard."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from halation import presets
from halation.editor.shared.dialogs import Browse
from imgui_bundle import imgui

FOLDER = presets.paths()[0].parent


@pytest.fixture
def shelf(tmp_path: Path) -> Path:
    """A folder with graphs, pictures, and a folder inside."""
    made = tmp_path / "shelf"
    shutil.copytree(FOLDER / "samples", made / "inner" / "samples")
    for name in ("agx_look", "soft_bloom"):
        shutil.copy(FOLDER / f"{name}.json", made / "inner")
        shutil.copy(FOLDER / "pictures" / f"{name}.jpg", made)
    (made / "broken.png").write_text("this is no picture")
    return made


def at(ui, folder: Path) -> None:
    """Let dialogs begin in a folder: a document without a file begins where a file was chosen last."""
    ui.editor.session.path = None
    for purpose in ("graph", "image", "export"):
        ui.editor.store.note_folder(purpose, folder / "x")


def test_a_graph_is_opened_by_keyboard(gui, shelf: Path) -> None:
    def body(ui) -> None:
        at(ui, shelf)
        ui.keys("Ctrl+O")
        ui.until(lambda: "file inner" in ui.editor.places)
        ui.keys("Enter")
        ui.until(lambda: "file soft_bloom.json" in ui.editor.places)
        ui.keys("Backspace")
        ui.until(lambda: "file inner" in ui.editor.places)
        ui.keys("Enter")
        ui.until(lambda: "file soft_bloom.json" in ui.editor.places)
        ui.type("soft", enter=False)
        ui.shot("browser.png")
        ui.keys("Enter")
        assert ui.session.path == shelf / "inner" / "soft_bloom.json"
        assert not ui.editor.dialogs.any
        assert ui.editor.store.folder("graph") == str(shelf / "inner")

    gui(body)


def test_arrows_choose_and_escape_closes(gui, shelf: Path) -> None:
    def body(ui) -> None:
        at(ui, shelf / "inner")
        ui.keys("Ctrl+O")
        ui.until(lambda: "file soft_bloom.json" in ui.editor.places)
        ui.keys("DownArrow")
        ui.keys("DownArrow")
        ui.keys("UpArrow")
        ui.keys("Enter")
        assert ui.session.path == shelf / "inner" / "agx_look.json"
        ui.keys("Ctrl+O")
        ui.keys("Escape")
        assert not ui.editor.dialogs.any

    gui(body, presets.paths()[0])


def test_saving_asks_before_it_replaces(gui, shelf: Path) -> None:
    def body(ui) -> None:
        at(ui, shelf / "inner")
        target = shelf / "inner" / "soft_bloom.json"
        before = target.read_bytes()
        ui.editor.session.path = None
        ui.keys("Ctrl+Shift+S")
        ui.until(lambda: "file soft_bloom.json" in ui.editor.places)
        ui.click("file soft_bloom.json")
        ui.keys("Enter")
        assert ui.editor.dialogs.question is not None
        ui.shot("replace.png")
        ui.keys("Escape")
        assert ui.editor.dialogs.browse is not None
        assert target.read_bytes() == before
        ui.keys("Enter")
        ui.click("answer 0")
        assert target.read_bytes() != before
        assert ui.session.path == target

    gui(body, next(path for path in presets.paths() if path.stem == "agx_look"))


def test_a_new_folder_and_a_new_name(gui, shelf: Path) -> None:
    def body(ui) -> None:
        at(ui, shelf)
        ui.editor.session.path = None
        ui.keys("Ctrl+Shift+S")
        ui.until(lambda: "file inner" in ui.editor.places)
        ui.click("new folder")
        ui.type("takes")
        ui.wait(5)
        assert (shelf / "takes").is_dir()
        ui.click("file field")
        ui.type("first")
        ui.wait(5)
        assert ui.session.path == shelf / "takes" / "first.json"

    gui(body, presets.paths()[0])


def test_pictures_are_seen_and_broken_ones_told(gui, shelf: Path) -> None:
    chosen: list[Path] = []

    def body(ui) -> None:
        at(ui, shelf)
        ui.editor.dialogs.open.clear()
        ui.editor.dialogs.browse = Browse("Choose a picture", "image", chosen.append)
        ui.until(lambda: "file agx_look.jpg" in ui.editor.places)
        kept = ui.folder / "state" / "thumbnails"
        ui.until(lambda: kept.is_dir() and len(list(kept.iterdir())) == 2)
        ui.wait(5)
        ui.shot("pictures.png")
        ui.click("list or grid")
        assert "file broken.png" in ui.editor.places
        ui.double_click("file agx_look.jpg")
        assert chosen == [shelf / "agx_look.jpg"]
        assert ui.editor.faults == {}

    gui(body)


def test_a_typed_path_that_leads_nowhere_is_a_sentence(gui, shelf: Path) -> None:
    def body(ui) -> None:
        ui.keys("Ctrl+O")
        ui.click("path field")
        ui.type(str(shelf / "nowhere"))
        ui.wait(5)
        ui.shot("nowhere.png")
        assert "file inner" not in ui.editor.places
        ui.click("path field")
        ui.type(str(shelf))
        ui.until(lambda: "file inner" in ui.editor.places)
        assert ui.editor.dialogs.browse is not None

    gui(body, presets.paths()[0])


def test_ten_thousand_files_are_listed(gui, tmp_path: Path) -> None:
    many = tmp_path / "many"
    many.mkdir()
    for index in range(10_000):
        (many / f"shot{index}.json").touch()

    def body(ui) -> None:
        at(ui, many)
        ui.keys("Ctrl+O")
        ui.until(lambda: "file shot0.json" in ui.editor.places)
        assert len([name for name in ui.editor.places if name.startswith("file shot")]) < 100
        ui.type("9999", enter=False)
        assert "file shot9999.json" in ui.editor.places

    gui(body, presets.paths()[0])


def test_an_absolute_path_is_typed_to_save_and_to_open(gui, shelf: Path) -> None:
    def body(ui) -> None:
        at(ui, shelf)
        target = shelf / "inner" / "my look.json"
        ui.keys("Ctrl+Shift+S")
        ui.type(str(target))
        assert target.is_file() and ui.session.path == target
        assert not ui.editor.dialogs.any and not ui.session.history.steps
        ui.keys("Ctrl+O")
        ui.type(str(shelf / "inner" / "soft_bloom.json"))
        assert ui.session.path == shelf / "inner" / "soft_bloom.json"
        ui.keys("Ctrl+O")
        ui.type(f"{shelf}/")
        ui.until(lambda: "file inner" in ui.editor.places)

    gui(body, presets.paths()[0])


def test_the_buttons_are_reached_by_keyboard(gui, shelf: Path) -> None:
    def body(ui) -> None:
        at(ui, shelf)
        (shelf / ".secret.json").write_text("{}")
        ui.keys("Ctrl+O")
        ui.until(lambda: "file inner" in ui.editor.places)
        ui.keys("Shift+Tab")
        context = imgui.get_current_context()
        assert context.nav_cursor_visible and not imgui.get_io().want_text_input
        ui.keys("Tab")
        ui.keys("Tab")  # past the new folder, to hidden files
        ui.keys("Enter")
        ui.until(lambda: "file .secret.json" in ui.editor.places)
        ui.keys("Tab")
        ui.keys("Tab")  # the first place
        ui.shot("files_walked.png")
        ui.keys("Enter")
        ui.until(lambda: imgui.get_io().want_text_input)  # the field takes letters again
        assert ui.editor.dialogs.browse is not None
        ui.keys("Escape")

    gui(body, presets.paths()[0])
