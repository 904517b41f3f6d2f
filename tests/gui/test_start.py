"""The window opens, shows a graph, and closes."""

from __future__ import annotations

import shutil
from pathlib import Path

from halation import document, presets
from halation.editor.window import assembly
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui


def test_opens_a_graph_and_shows_its_picture(gui) -> None:
    path = presets.paths()[0]

    def body(ui) -> None:
        ui.settled()
        assert ui.session.path == path
        shown = ui.editor.preview.find_whole_image("A")
        assert shown is not None and shown.full_size[0] > 100
        assert ui.pixels().std() > 5

    gui(body, path)


def test_starts_without_a_graph(gui) -> None:
    def body(ui) -> None:
        assert "start" in ui.editor.dialogs.open
        assert ui.session.graph.nodes == {}

    gui(body)


def test_keys_go_to_the_start_screen_whatever_took_the_focus(gui) -> None:
    """On a real display the bars of the window appear after it, and take the focus."""

    def body(ui) -> None:
        ui.ask(lambda: imgui.set_window_focus("Viewer"))
        ui.wait(2)
        ui.keys("Escape")
        assert "start" not in ui.editor.dialogs.open

    gui(body)


def type_keys(ui, text: str) -> None:
    """Letters as a keyboard sends them: a frame for each."""
    for letter in text:
        ui.ctx.key_chars(letter)
        ui.wait(1)
    ui.wait(3)


def test_typing_searches_the_presets_and_enter_opens_the_first(gui) -> None:
    def body(ui) -> None:
        ui.wait(3)
        type_keys(ui, "tilt shift")
        assert [place for place in ui.editor.places if place.startswith("preset ")] == ["preset miniature"]
        ui.keys("Enter")
        ui.until(lambda: "start" not in ui.editor.dialogs.open)
        assert "variable_blur" in {type(item).id for item in ui.session.graph.nodes.values()}

    gui(body)


def test_categories_and_cards_are_reached_by_keyboard(gui) -> None:
    def body(ui) -> None:
        ui.click("category print")
        cards = [place for place in ui.editor.places if place.startswith("preset ")]
        assert "preset risograph" in cards and "preset soft_bloom" not in cards
        ui.click("start search")
        ui.keys("DownArrow")
        ui.wait(2)
        before = ui.pixels()
        ui.keys("RightArrow")
        ui.wait(2)
        assert (ui.pixels() != before).any()  # the focus can be seen
        ui.keys("Enter")
        ui.until(lambda: "start" not in ui.editor.dialogs.open)
        second = document.load(own_path(cards[1]), sandbox=UNRESTRICTED)
        assert set(ui.session.graph.nodes) == set(second.nodes)

    gui(body)


def own_path(place: str) -> Path:
    return presets.paths()[0].parent / f"{place.removeprefix('preset ')}.json"


def test_recent_documents_have_the_picture_that_was_saved(gui, tmp_path: Path) -> None:
    path = Path(shutil.copy(presets.paths()[0].parent / "clay_city.json", tmp_path / "city.json"))

    def save(ui) -> None:
        ui.settled()
        pictures = ui.editor.store.file.parent / "recent"
        ui.keys("Ctrl+S")
        ui.until(lambda: len(list(pictures.glob("*.jpg"))) == 1)

    def look(ui) -> None:
        ui.wait(3)
        left, top, right, bottom = map(round, ui.editor.places["recent 0"])
        box = ui.pixels()[top:bottom, left : left + (right - left) // 4]
        assert box.std(axis=(0, 1)).max() > 20
        ui.click("recent 0")
        ui.until(lambda: ui.session.path == path)

    gui(save, path)
    gui(look)


def test_a_preset_of_an_installation_opens_as_a_new_document(gui, monkeypatch) -> None:
    """To save it needs a place of the user's own."""
    monkeypatch.setattr(assembly, "is_installed", lambda path: True)
    path = presets.paths()[0]

    def body(ui) -> None:
        ui.settled()
        assert ui.session.path is None and ui.session.graph.nodes == document.load(path, sandbox=UNRESTRICTED).nodes

    gui(body, path)
