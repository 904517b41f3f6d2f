"""What a user meets in the first hour: searches that find nothing, code that is broken, files that are gone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation import document, presets
from halation.authoring.commands import AddNode, SetCode
from halation.authoring.edits.element_id import ElementId
from halation.authoring.recovery import RecoveryFile
from halation.editor.problems.findings import list_problems
from halation.editor.toolkit.keys import chord
from halation.graph import Graph, Output, Port
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui

BROKEN = "vec4 gain(vec4 image) {\n    return image * nothing;\n}\n"


@pytest.fixture
def shot(tmp_path: Path) -> Path:
    """A graph that reads a picture."""
    pixels = np.full((18, 32, 4), 0.5, np.float32)
    picture = oiio.ImageBuf(oiio.ImageSpec(32, 18, 4, "float"))
    picture.set_pixels(oiio.ROI(), pixels)
    picture.write(str(tmp_path / "render.exr"))
    graph = Graph(outputs={"image": Output(Kind.IMAGE)}).add("read", catalogue()["read_image"](path="render.exr"))
    graph = graph.connect(Port("read", "out"), Port("outputs", "image"))
    document.save(graph, tmp_path / "shot.json", sandbox=UNRESTRICTED)
    return tmp_path / "shot.json"


def sentences(ui) -> list[str]:
    return [entry.sentence for entry in ui.editor.log.entries]


def type_keys(ui, text: str) -> None:
    """Letters as a keyboard sends them: a frame for each."""
    for letter in text:
        ui.ctx.key_chars(letter)
        ui.wait(1)


@pytest.mark.parametrize("opens", ["Tab", "Ctrl+P"])
def test_a_search_without_a_hit_goes_on_after_enter(gui, opens: str) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.move("Graph", (0.5, 0.9))
        ui.keys(opens)
        ui.wait(3)
        type_keys(ui, "zzzz")
        ui.keys("Enter")
        ui.wait(3)
        ui.keys("Ctrl+A")
        type_keys(ui, "vignette")
        ui.wait(3)
        assert any(place.startswith(("search vignette", "command")) for place in ui.editor.places)
        ui.keys("Enter")
        ui.wait(3)
        assert "vignette" in ui.session.graph.nodes

    gui(body, presets.paths()[0])


def test_ctrl_enter_compiles_code_and_adds_no_line(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.apply(AddNode("glsl"))
        ui.session.apply(SetCode("code", "vec4 gain(vec4 image) {\n    return image;\n}\n"))
        ui.settled()
        ui.editor.code_files.show() if hasattr(ui.editor, "code_files") else ui.editor.actions.run("code.edit")
        ui.wait(6)
        ui.click("code text")
        ui.ctx.key_press(chord("Ctrl+Home"))
        ui.wait(2)
        lines = ui.session.code_files.find_code("code").text.count("\n")
        ui.keys("Ctrl+Enter")
        ui.wait(30)
        assert ui.session.code_files.find_code("code").text.count("\n") == lines
        ui.keys("Enter")
        ui.wait(30)
        assert ui.session.code_files.find_code("code").text.count("\n") == lines + 1

    gui(body, presets.paths()[0])


def test_broken_code_that_nothing_reads_shows_its_error(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.apply(AddNode("glsl"))
        ui.session.apply(SetCode("code", BROKEN))
        ui.until(lambda: "code" in ui.editor.preview.faults)
        assert ui.editor.preview.errors["code"].line == 2
        problems = list_problems(ui.window._contexts.problems)
        assert any(finding.where == "code" and "nothing" in finding.sentence for finding in problems)
        ui.session.apply(SetCode("code", BROKEN.replace("nothing", "2.0")))
        ui.until(lambda: "code" not in ui.editor.preview.faults)
        assert ui.editor.preview.find_whole_image("A") is not None

    gui(body, presets.paths()[0])


def test_a_tooltip_after_a_key_is_at_the_pointer(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.move("Graph", (0.4, 0.4))
        ui.keys("Tab")
        ui.wait(3)
        type_keys(ui, "vignette")
        ui.keys("Enter")
        ui.settled()
        ui.session.select(())
        ui.move("title vignette", (0.3, 0.5))
        ui.keys("Tab")
        ui.wait(2)
        ui.keys("DownArrow")
        ui.keys("Escape")
        ui.wait(90)
        tooltips = [window for window in _list_windows() if window.name.startswith("##Tooltip") and window.active]
        mouse = imgui.get_mouse_pos()
        assert tooltips
        for window in tooltips:
            assert abs(window.pos.x - mouse.x) < 60 and abs(window.pos.y - mouse.y) < 60

    gui(body, presets.paths()[0])


def _list_windows() -> list:
    return list(imgui.get_current_context().windows)


def test_a_new_reader_without_a_file_is_no_error(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        for kind in ("read_render", "read_image"):
            ui.session.apply(AddNode(kind))
            ui.session.views.show_element(ui.session.active)
            ui.settled()
            assert not ui.editor.preview.faults
            assert "no file is chosen" in ui.editor.preview.fault("A")
            assert all(kind not in finding.sentence for finding in list_problems(ui.window._contexts.problems))

    gui(body, presets.paths()[0])


def test_a_picture_that_is_deleted_was_not_read_again(gui, shot: Path) -> None:
    def body(ui) -> None:
        ui.settled()
        shot.with_name("render.exr").unlink()
        ui.until(lambda: any("render.exr" in sentence for sentence in sentences(ui)))
        said = [sentence for sentence in sentences(ui) if "render.exr" in sentence]
        assert any("deleted" in sentence for sentence in said)
        assert not any("read again" in sentence for sentence in said)

    gui(body, shot)


def test_memory_over_the_budget_is_a_warning(gui, shot: Path) -> None:
    def body(ui) -> None:
        ui.settled()
        textures = ui.editor.preview.renderer.runner.textures
        textures.budget = 1
        ui.until(lambda: any("budget" in sentence for sentence in sentences(ui)))
        assert [entry.level for entry in ui.editor.log.entries if "budget" in entry.sentence] == ["warning"]

    gui(body, shot)


def test_two_editors_on_one_document_warn(gui, shot: Path, tmp_path: Path) -> None:
    other = RecoveryFile(tmp_path / "state")
    other.claim(shot.parent / ".." / shot.parent.name / shot.name)

    def body(ui) -> None:
        ui.until(lambda: any("another editor" in sentence for sentence in sentences(ui)))
        assert any("another editor" in finding.sentence for finding in list_problems(ui.window._contexts.problems))
        other.close()
        ui.until(lambda: not ui.editor.recovery.find_rivals())

    try:
        gui(body, shot)
    finally:
        other.close()


def test_nodes_added_by_keyboard_make_a_chain_that_can_be_seen(gui) -> None:
    def body(ui) -> None:
        ui.editor.dialogs.open.clear()
        ui.settled()
        ui.move("Graph", (0.5, 0.4))
        chain = ["constant", "bloom", "vignette", "film_grain", "exposure", "sharpen"]
        for kind in chain:
            ui.keys("Tab")
            ui.wait(3)
            type_keys(ui, kind.replace("_", " "))
            ui.keys("Enter")
            ui.settled()
            left, top, right, bottom = ui.editor.places[f"node {kind}"]
            panel = ui.editor.places["Graph"]
            assert panel[0] <= left < right <= panel[2] and panel[1] <= top, kind
            assert bottom <= panel[3] + 1 or bottom - top > 0.8 * (panel[3] - panel[1]), kind
        links = ui.session.graph.links
        assert [links[Port(id, "image")].node for id in chain[1:]] == chain[:-1]
        boxes = [ui.editor.canvas.sizes[ElementId(id)] for id in chain]
        spots = [ui.session.position(ElementId(id)) for id in chain]
        assert all(x + w <= next_x for (x, _), (w, _), (next_x, _) in zip(spots, boxes, spots[1:], strict=False))

    gui(body, size=(1366, 768))


def test_one_drag_links_all_sockets_of_the_same_name(gui) -> None:
    def body(ui) -> None:
        ui.editor.dialogs.open.clear()
        ui.settled()
        ui.session.apply(AddNode("read_render", (0.0, 0.0)))
        ui.session.apply(AddNode("ambient_occlusion", (400.0, 0.0)))
        ui.editor.canvas.fit()
        ui.settled()
        ui.drag("pin out read_render.depth", "pin in ambient_occlusion.depth")
        fed = {end.socket: start.socket for end, start in ui.session.graph.links.items()}
        assert fed == {name: name for name in ("depth", "normal", "camera", "albedo")}
        ui.session.undo()
        ui.drag("pin out read_render.depth", "pin in ambient_occlusion.depth", keys="Ctrl")
        assert list(ui.session.graph.links) == [Port("ambient_occlusion", "depth")]

    gui(body, size=(1366, 768))


def test_a_picture_is_opened_in_a_new_graph_with_a_reader(gui, shot: Path) -> None:
    def body(ui) -> None:
        ui.settled()
        ((id, node),) = ui.session.graph.nodes.items()
        assert node.id == "read_image" and node.path.endswith("render.exr")
        assert ui.session.graph.links[Port("outputs", "image")].node == id
        assert ui.session.path is None and not ui.session.dirty and ui.session.name == "render"
        assert ui.session.selection == {id}
        image = ui.editor.preview.find_whole_image("A")
        assert ui.ask(lambda: ui.editor.probe.read_pixel(image.texture, 3, 3)[0]) == pytest.approx(0.5, abs=1e-3)
        assert "start" not in ui.editor.dialogs.open

    gui(body, shot.with_name("render.exr"))


def test_a_merge_mode_is_added_by_its_name(gui) -> None:
    def body(ui) -> None:
        ui.editor.dialogs.open.clear()
        ui.settled()
        ui.move("Graph", (0.5, 0.4))
        ui.keys("Tab")
        ui.wait(3)
        type_keys(ui, "linear dodge")
        ui.keys("Enter")
        ui.wait(3)
        assert ui.session.graph.nodes["merge"].mode == "plus"
        assert ui.session.history.steps == ("Add merge",)

    gui(body, size=(1366, 768))


def test_a_picture_is_opened_by_a_path_that_tab_completes(gui, shot: Path) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.keys("Ctrl+O")
        ui.wait(6)
        type_keys(ui, f"{shot.parent}/ren")
        ui.keys("Tab")
        ui.wait(3)
        ui.keys("Enter")
        ui.until(lambda: ui.session.name == "render")
        assert [node.id for node in ui.session.graph.nodes.values()] == ["read_image"]

    gui(body, presets.paths()[0])
