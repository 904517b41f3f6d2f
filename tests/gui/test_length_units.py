"""The unit of a length in the inspector, and the reference height of the graph."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED


@pytest.fixture
def file(tmp_path: Path) -> Path:
    graph = Graph(settings=Settings((64, 36))).add("noise", catalogue()["noise"]()).add_output("image", Output())
    path = tmp_path / "graph.json"
    graph = graph.connect(Port("noise", "out"), Port("outputs", "image"))
    document.save(graph, path, sandbox=UNRESTRICTED)
    return path


def value(ui, port: str):
    return ui.session.graph.value(Port.parse(port))


def select(ui, *keys: str) -> int:
    """Select elements; how many steps the history has."""
    ui.session.select([*map(ElementId, keys)])
    ui.wait(3)
    return len(ui.session.history.steps)


def test_the_unit_of_a_length_changes_without_changing_the_picture(gui, file) -> None:
    """The number is converted for the picture that is shown, 36 pixels high; it is one step to undo."""

    def body(ui) -> None:
        steps = select(ui, "noise")
        ui.settled()
        ui.click("name noise.size", button=1)
        ui.click("menu Unit: height")
        port = Port("noise", "size")
        assert ui.session.graph.declaration(port).unit == "height"
        assert value(ui, "noise.size") == pytest.approx(64.0 / 36.0)
        ui.click("name noise.size", button=1)
        ui.click("menu Unit: px@1080")
        assert ui.session.graph.declaration(port).unit == "px@1080"
        assert value(ui, "noise.size") == pytest.approx(64.0 * 1080 / 36)
        assert len(ui.session.history.steps) == steps + 2
        ui.session.undo()
        ui.session.undo()
        assert ui.session.graph.declaration(port).unit == "px" and value(ui, "noise.size") == 64.0
        select(ui)
        ui.click("field reference height")
        assert ui.session.graph.settings.reference_height == 36
        ui.click("button no reference height")
        assert ui.session.graph.settings.reference_height is None
        assert not ui.editor.faults

    gui(body, file)
