"""Saving presets in the editor, and finding them there."""

from __future__ import annotations

import OpenImageIO as oiio
import pytest
from halation import document, presets
from halation.authoring.commands import AddNode
from halation.authoring.preset_versions import list_versions
from halation.document.about import find_about
from halation.editor.toolkit.keys import chord
from halation.resources.sandbox import UNRESTRICTED
from halation.resources.user_folders import own_presets_folder

BLOOM = next(path for path in presets.paths() if path.stem == "soft_bloom")


def save_as(ui, name: str, tags: str = "", doc: str = "") -> None:
    """Save a preset by keyboard alone."""
    ui.keys("Ctrl+P")
    ui.type("save as preset")
    ui.wait(4)
    ui.type(name, enter=False)
    for text in (tags, doc):
        ui.keys("Tab")
        if text:
            ui.type(text, enter=False)
    ui.wait(2)


def sentences(ui) -> list[str]:
    return [entry.sentence for entry in ui.editor.log.entries]


def test_a_graph_becomes_a_preset_that_tab_finds(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        steps = len(ui.session.history.steps)
        save_as(ui, "Evening Glow", "sodium, night", "Street lamps.")
        ui.shot("preset.png")
        ui.keys("Enter")
        path = own_presets_folder() / "evening_glow.json"
        ui.until(path.is_file)
        assert not ui.editor.dialogs.any and "saved the preset evening_glow" in sentences(ui)
        assert len(ui.session.history.steps) == steps and not ui.session.dirty
        about = find_about(document.load(path, sandbox=UNRESTRICTED))
        assert (about.doc, about.tags) == ("Street lamps.", ("sodium", "night"))
        picture = oiio.ImageBuf(str(presets.picture(path)))
        assert picture.spec().width == 320 and picture.get_pixels(oiio.UINT8).std() > 10
        ui.move("Graph", (0.5, 0.9))
        ui.keys("Tab")
        ui.type("sodium")
        assert "evening_glow" in ui.session.graph.nodes

    gui(body, BLOOM)


@pytest.mark.parametrize("answer", ["Enter", "Escape"])
def test_a_preset_is_replaced_only_after_a_question(gui, answer: str) -> None:
    def body(ui) -> None:
        ui.settled()
        path = own_presets_folder() / "mine.json"
        path.parent.mkdir(parents=True)
        path.write_text("{}")
        save_as(ui, "mine")
        ui.keys("Enter")
        assert ui.editor.dialogs.question is not None and path.read_text() == "{}"
        ui.keys(answer)
        ui.wait(4)
        assert (path.read_text() == "{}") is (answer == "Escape")
        assert ("preset" in ui.editor.dialogs.open) is (answer == "Escape")

    gui(body, BLOOM)


def test_a_new_version_keeps_the_old_one_and_a_right_click_goes_back_to_it(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        path = own_presets_folder() / "mine.json"
        path.parent.mkdir(parents=True)
        path.write_bytes(BLOOM.read_bytes())
        first = path.read_bytes()
        save_as(ui, "mine", doc="Another one.")
        ui.keys("Enter")
        ui.click("answer 0")
        ui.until(lambda: not ui.editor.dialogs.any)
        assert find_about(document.load(path, sandbox=UNRESTRICTED)).doc == "Another one."
        ui.editor.actions.run("file.start")
        ui.until(lambda: "preset mine" in ui.editor.places)
        ui.click("preset mine", button=1)
        ui.until(lambda: "version 1" in ui.editor.places)
        ui.click("version 1")
        ui.until(lambda: path.read_bytes() == first)
        assert [version.number for version in list_versions(path)] == [2, 1]

    gui(body, BLOOM)


def test_a_name_that_cannot_be_is_refused_while_it_is_typed(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        save_as(ui, "Soft Bloom")
        ui.keys("Enter")
        assert "preset" in ui.editor.dialogs.open and not own_presets_folder().exists()
        ui.keys("Escape")
        assert not ui.editor.dialogs.any

    gui(body, BLOOM)


def test_a_selection_becomes_a_preset(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.apply(AddNode("vignette"))
        ui.settled()
        ui.ask(lambda: ui.editor.actions.run("file.save_preset"))
        ui.wait(4)
        ui.type("corner", enter=False)
        ui.ctx.key_press(chord("Enter"))
        path = own_presets_folder() / "corner.json"
        ui.until(path.is_file)
        graph = document.load(path, sandbox=UNRESTRICTED)
        assert set(graph.nodes) == {"vignette"} and list(graph.inputs) == ["image"] and graph.outputs

    gui(body, BLOOM)


def test_a_broken_file_in_the_library_harms_nothing(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.move("Graph", (0.5, 0.9))
        ui.keys("Tab")
        ui.type("broken")
        assert any(str(own_presets_folder() / "broken.json") in sentence for sentence in sentences(ui))
        ui.keys("Tab")
        ui.type("vignette")
        assert "vignette" in ui.session.graph.nodes

    own_presets_folder().mkdir(parents=True)
    (own_presets_folder() / "broken.json").write_text("{")
    gui(body, BLOOM)
