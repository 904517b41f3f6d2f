"""The mix of nodes in the inspector: of several nodes at once, and as a control of a group."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation import document
from halation.authoring.commands import ExposeValue, MakeGroup
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Port, Settings
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "graph.json"
    graph = Graph(settings=Settings((64, 36)))
    for id in ("noise", "grade", "vignette"):
        graph = graph.add(id, catalogue()[id]())
    document.save(graph, path, sandbox=UNRESTRICTED)
    return path


def value(ui, port: str):
    return ui.session.graph.value(Port.parse(port))


def select(ui, *keys: str) -> int:
    """Select elements; how many steps the history has."""
    ui.session.select([*map(ElementId, keys)])
    ui.wait(3)
    return len(ui.session.history.steps)


def test_the_masks_of_several_nodes_are_changed_together(gui, path) -> None:
    def body(ui) -> None:
        steps = select(ui, "vignette", "grade")
        assert "field grade.mix" not in ui.editor.places
        ui.reveal("fold mask grade vignette")
        ui.click("fold mask grade vignette")
        ui.reveal("field grade.mix")
        ui.click("field grade.mix")
        ui.type("0.25")
        assert (value(ui, "grade.mix"), value(ui, "vignette.mix")) == (0.25, 0.25)
        assert len(ui.session.history.steps) == steps + 1
        select(ui, "noise")
        select(ui, "grade", "vignette")
        assert "field vignette.mix" in ui.editor.places

    gui(body, path)


def test_a_group_shows_its_control_over_the_mix_of_a_node(gui, path) -> None:
    def body(ui) -> None:
        select(ui, "grade", "vignette")
        id = ui.session.apply(MakeGroup())
        ui.session.enter(id)
        ui.session.apply(ExposeValue(Port("grade", "mix")))
        ui.session.leave()
        (control,) = ui.session.graph.nodes[id].signature.values
        select(ui, id)
        ui.click(f"field {id}.{control}")
        ui.type("0.5")
        assert value(ui, f"{id}.{control}") == 0.5

    gui(body, path)
