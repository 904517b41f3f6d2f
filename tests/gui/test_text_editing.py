"""The node `text` in the editor: its lines typed key by key, its place dragged on the picture."""

from __future__ import annotations

from pathlib import Path

import pytest
from gui_driver import Ui
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.input.text import Text
from halation.resources.sandbox import UNRESTRICTED


def save_graph(folder: Path) -> Path:
    graph = Graph(settings=Settings((320, 180)), outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("title", Text(text="One", size=0.2)).connect(Port("title", "out"), Port("outputs", "image"))
    document.save(graph, folder / "graph.json", sandbox=UNRESTRICTED)
    return folder / "graph.json"


def test_lines_are_typed_and_the_anchor_is_dragged(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        ui.session.select([ElementId("title")])
        ui.settled()
        left, top, right, bottom = ui.editor.places["viewer image"]
        ui.drag("handle title.anchor", (left + 0.25 * (right - left), top + 0.75 * (bottom - top)))
        assert ui.session.graph.value(Port("title", "anchor")) == pytest.approx((0.25, 0.75), abs=0.02)
        ui.reveal("field title.text")
        box = ui.editor.places["field title.text"]
        assert box[3] - box[1] > 45.0, "room for three lines"
        ui.click("field title.text")
        ui.type("Two", enter=False)
        ui.keys("Ctrl+Enter")
        for letter in "lines":
            ui.ctx.key_chars(letter)
            ui.wait(1)
        ui.keys("Enter")
        ui.settled()
        assert ui.session.graph.value(Port("title", "text")) == "Two\nlines"
        ui.session.undo()
        assert ui.session.graph.value(Port("title", "text")) == "One"
        ui.shot("text_editing.png")

    gui(body, save_graph(tmp_path))


def test_keys_of_the_window_work_in_a_text_field_and_what_was_typed_counts(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        ui.session.select([ElementId("title")])
        ui.settled()
        ui.reveal("field title.text")
        ui.click("field title.text")
        ui.type("Three", enter=False)
        ui.keys("Ctrl+N")
        ui.until(lambda: ui.editor.dialogs.question is not None)  # about what is not saved
        assert ui.session.graph.value(Port("title", "text")) == "Three"
        ui.keys("Escape")
        ui.wait(2)
        ui.click("field title.text")
        steps = ui.session.history.steps
        ui.keys("Ctrl+A")  # all of the text, not all nodes
        ui.keys("Ctrl+X")
        ui.wait(3)
        assert ui.session.history.steps == steps and "title" in ui.session.graph.nodes
        ui.keys("F12")
        ui.wait(6)
        assert "Renders" in ui.editor.places

    gui(body, save_graph(tmp_path))
