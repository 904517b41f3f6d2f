"""Code that is written in the window: typed, broken, mended, undone, saved to files, dropped."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation import document
from halation.authoring.commands import InsertNode, SetCode, SetValue, SpliceChain
from halation.authoring.edits.element_id import ElementId
from halation.custom_nodes import CustomNode
from halation.editor.problems.findings import list_problems
from halation.editor.toolkit.keys import chord
from halation.graph import Graph, Output, Port, Settings, Unknown
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED

SIZE = (1100, 760)
GAIN = 'vec4 gain(\n    vec4 image,\n    float k  // = 2, 0..4, "How Much": times\n) {\n    return image * k;\n}\n'


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A graph with a picture of 0.25, and a file of code beside it."""
    graph = Graph(settings=Settings((64, 36)), outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("fill", catalogue()["constant"](color=(0.25, 0.25, 0.25, 1.0)))
    document.save(
        graph.connect(Port("fill", "out"), Port("outputs", "image")), tmp_path / "graph.json", sandbox=UNRESTRICTED
    )
    (tmp_path / "gain.glsl").write_text(GAIN)
    return tmp_path / "graph.json"


def red(ui) -> float:
    return ui.ask(lambda: float(ui.editor.probe.read_pixel(ui.editor.preview.find_whole_image("A").texture, 3, 3)[0]))


def begin(ui, text: str = GAIN) -> None:
    """A node of code before the output, and the cursor at the beginning of its text."""
    ui.settled()
    ui.session.apply(InsertNode("glsl", Port("outputs", "image")))
    ui.session.apply(SetCode("code", text))
    ui.editor.dialogs.open.clear()
    ui.settled()
    ui.double_click("title code")
    ui.wait(4)
    ui.click("code text")
    ui.ctx.key_press(chord("Ctrl+Home"))
    ui.wait(2)


def write(ui, text: str) -> None:
    """Type, and wait until it is taken over."""
    before = ui.session.root
    for line in text.split("\n"):
        if line:
            ui.ctx.key_chars(line)
        if line != text.split("\n")[-1]:
            ui.ctx.key_press(chord("Enter"))
    ui.until(lambda: ui.session.root is not before)
    ui.settled()


def text_of(ui, id: str = "code") -> str:
    return ui.session.code_files.find_code(id).text


def test_typing_changes_the_picture(gui, path) -> None:
    def body(ui) -> None:
        begin(ui)
        assert red(ui) == pytest.approx(0.5, abs=1e-3)
        steps = ui.session.history.steps
        ui.ctx.key_press(chord("DownArrow"), 4)
        ui.ctx.key_press(chord("End"))
        ui.ctx.key_press(chord("LeftArrow"), 2)
        write(ui, "-")  # a single letter, which is one burst however slow the machine is
        assert "return image * -k;" in text_of(ui)
        ui.until(lambda: red(ui) == pytest.approx(-0.5, abs=1e-3))
        assert ui.session.history.steps == (*steps, "Edit code of code")

        ui.keys("Ctrl+Z")
        ui.until(lambda: text_of(ui) == GAIN)
        ui.until(lambda: red(ui) == pytest.approx(0.5, abs=1e-3))
        ui.keys("Ctrl+Shift+Z")
        ui.until(lambda: red(ui) == pytest.approx(-0.5, abs=1e-3))
        ui.ctx.window_focus("//Graph")
        ui.wait(3)
        ui.keys("Ctrl+Z")
        ui.until(lambda: red(ui) == pytest.approx(0.5, abs=1e-3))
        assert text_of(ui) == GAIN
        ui.keys("Ctrl+Shift+Z")
        ui.until(lambda: red(ui) == pytest.approx(-0.5, abs=1e-3))
        ui.ctx.window_focus("//Code")
        ui.wait(3)
        ui.shot("code_dark.png")
        assert "code fault" not in ui.editor.places

    gui(body, path, size=SIZE)


def test_a_broken_line_is_marked_and_the_picture_stays(gui, path) -> None:
    def body(ui) -> None:
        begin(ui)
        ui.session.apply(SetValue(Port("code", "k"), 3.0))
        ui.settled()
        links = ui.session.graph.links
        for line, sentence in (("uniform int x;", "'uniform' has no place here"), ("int y = wrong(1);", "wrong")):
            shown = ui.editor.preview.find_whole_image("A").key
            write(ui, f"{line}\n")
            ui.until(lambda: "code fault" in ui.editor.places)
            ui.until(lambda: any(sentence in one for one in ui.editor.preview.faults.values()))  # noqa: B023
            assert ui.editor.preview.find_whole_image("A").key == shown and ui.session.graph.links == links
            fault = page(ui).fault
            assert fault.line == 1 and sentence in fault.sentence
            assert isinstance(ui.session.graph.nodes["code"], Unknown) == ("uniform" in line)
            assert any(
                one.where == "code" and "line 1" in one.sentence for one in list_problems(ui.window._contexts.problems)
            )

            before = ui.session.root
            ui.ctx.key_press(chord("Shift+UpArrow"))
            ui.ctx.key_press(chord("Delete"))
            ui.until(lambda: ui.session.root is not before and "code fault" not in ui.editor.places)  # noqa: B023
            ui.settled()
            assert not ui.editor.preview.faults and ui.session.graph.links == links
            assert isinstance(ui.session.graph.nodes["code"], CustomNode) and ui.session.graph.nodes["code"].k == 3.0

    gui(body, path, size=SIZE)


def page(ui):
    return ui.window._panels["Code"]._page


def test_labels_and_colors_of_code_are_shown(gui, path) -> None:
    def body(ui) -> None:
        begin(
            ui,
            'vec4 f(vec4 image, vec3 shade // = (1, 0.5, 0.2), color, "The Shade"\n) '
            "{ return vec4(image.rgb * shade, 1.0); }",
        )
        ui.ctx.window_focus("//Graph")
        ui.session.select(ElementId("code"))
        ui.wait(3)
        boxes = ui.window._panels["Graph"]._mouse.preview.scene.boxes
        assert [row.label for row in boxes["code"].layout.rows if row.value] == ["The Shade"]
        ui.click("field code.shade")
        ui.wait(2)
        ui.ctx.key_press(chord("Escape"))
        x, y = ui.at("widget code.shade", (0.8, 0.5))
        ui.click((x, y))
        ui.shot("code_color.png")
        ui.keys("Escape")
        ui.session.apply(SetValue(Port("code", "shade"), (0.0, 1.0, 0.0, 1.0)))
        ui.until(lambda: red(ui) == 0.0)

    gui(body, path, size=SIZE)


def test_a_file_that_is_dropped_is_edited_and_saved(gui, path) -> None:
    file = path.with_name("gain.glsl")

    def body(ui) -> None:
        ui.settled()
        ui.window._dropped.append(str(file))
        ui.until(lambda: "gain" in ui.session.graph.nodes)
        assert ui.session.code_files.find_code("gain").file == "gain.glsl"
        ui.session.apply(SpliceChain(["gain"], Port("outputs", "image")))
        ui.until(lambda: red(ui) == pytest.approx(0.5, abs=1e-3))
        file.write_text(GAIN.replace("= 2", "= 4"))
        ui.until(lambda: red(ui) == pytest.approx(1.0, abs=1e-3))

        ui.session.select(ElementId("gain"))
        ui.wait(3)
        ui.click("button code gain")
        ui.wait(5)
        ui.click("code text")
        ui.ctx.key_press(chord("Ctrl+Home"))
        write(ui, "// mine\n")
        assert ui.session.code_files.drafts == {file: "// mine\n" + GAIN.replace("= 2", "= 4")} and ui.session.dirty
        ui.shot("code_file.png")
        ui.keys("Ctrl+S")
        ui.until(lambda: not ui.session.code_files.drafts)
        assert file.read_text().startswith("// mine\n")

        write(ui, "// draft\n")
        file.write_text(GAIN)
        ui.until(lambda: ui.editor.dialogs.question is not None)
        assert "gain.glsl" in ui.editor.dialogs.question.sentence
        ui.editor.dialogs.question.answers[0][1]()
        ui.editor.dialogs.question = None
        ui.until(lambda: text_of(ui, "gain") == GAIN)
        ui.until(lambda: red(ui) == pytest.approx(0.5, abs=1e-3))
        ui.wait(3)
        ui.click("button inline code")
        assert not ui.session.code_files.find_code("gain").file and text_of(ui, "gain") == GAIN

    gui(body, path, size=SIZE)


def test_typing_is_saved_with_the_graph_and_helped(gui, path) -> None:
    def body(ui) -> None:
        begin(ui)
        ui.ctx.key_chars(" ")
        ui.keys("Ctrl+S")
        ui.wait(3)
        assert '" vec4 gain("' in path.read_text()
        ui.editor.store.change(theme="light")
        ui.click("button code help")
        ui.wait(2)
        ui.wheel(-40)
        _, top, _, _ = ui.editor.places["Code"]
        for _ in range(40):
            if ui.editor.places.get("include lib/color", (0, 0))[1] > top + 60.0:  # below the title and the search
                break
            ui.wheel(1)
        ui.click("include lib/color")
        ui.until(lambda: text_of(ui).startswith('#include "lib/color.glsl"\n'))
        ui.settled()
        ui.shot("code_light.png")
        assert not ui.editor.preview.faults

    gui(body, path, size=SIZE)


def test_code_is_added_from_the_list(gui, path) -> None:
    (path.parent / "isf").mkdir()
    head = '/*{"ISFVSN": "2", "CATEGORIES": ["Fun"], "INPUTS": []}*/'
    (path.parent / "isf/Red Room.fs").write_text(head + "\nvoid main() { gl_FragColor = vec4(1.0, 0.0, 0.0, 1.0); }")

    def body(ui) -> None:
        ui.settled()
        ui.editor.store.change(isf_folders=[str(path.parent / "isf")])
        for query, id, kind in (("code", "code", "glsl"), ("red room", "Red_Room", "isf")):
            ui.editor.canvas.searching = True
            ui.wait(4)
            ui.until(lambda: ui.editor.shaders.find(ui.editor.store.current.isf_folders) is not None)
            ui.ctx.key_chars(query)
            ui.wait(3)
            ui.shot(f"code_search_{kind}.png")
            ui.keys("Enter")
            assert ui.session.active == id and ui.session.graph.nodes[id].id == kind
        assert ui.session.code_files.find_code("Red_Room").file == "isf/Red Room.fs"

    gui(body, path, size=SIZE)


def test_keys_of_the_window_work_in_the_code_and_what_was_typed_counts(gui, path) -> None:
    def body(ui) -> None:
        begin(ui)
        ui.ctx.key_chars(" ")
        ui.keys("Ctrl+P")
        ui.until(lambda: "palette" in ui.editor.dialogs.open)
        assert text_of(ui) == " " + GAIN
        ui.keys("Escape")

    gui(body, path, size=SIZE)
