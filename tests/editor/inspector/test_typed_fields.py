"""Whatever a command can set has a field in the inspector, and what is typed there reaches the document.

The commands and the settings of a graph say which there are: nothing here lists what the inspector draws.
"""

from __future__ import annotations

import dataclasses
import inspect
from pathlib import Path

import pytest
from halation.authoring.commands import AddComment, AddFrame, EditComment, EditFrame, SetInput, SetOutput
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from still_editor import StillEditor, open_still_editor

AFTER = {"color_space": "space", "working_space": "working space", "color_config": "color config",
         "reference_height": "reference height"}  # fmt: skip
"""Fields with other words than those of the document."""


def make_graph() -> Graph:
    graph = Graph().add("glow", catalogue()["bloom"]()).add_output("image", Output(Kind.IMAGE, 4))
    graph = graph.add_input("plate", Input(Kind.IMAGE, 4, file="plate.####.exr", doc="before"))
    return graph.add_input("amount", Input(Kind.NUMBER, 1, default=0.5))


def type_and_read(still: StillEditor, place: str, text: str) -> Graph:
    """The graph after text was typed; the document is as before afterwards."""
    session = still.editor.session
    before = session.root
    still.type("Inspector", place, text)
    graph = session.root
    still.calm("Inspector")
    while session.root is not before:
        session.undo()
    still.show("Inspector", 2)
    return graph


@pytest.mark.parametrize(
    ("element", "command", "left_out"),
    [("frame", EditFrame, ()), ("comment", EditComment, ()), ("inputs.plate", SetInput, ()),
     ("inputs.amount", SetInput, ("missing", "color_space")), ("outputs.image", SetOutput, ())],
)  # fmt: skip
def test_all_that_a_command_sets_has_a_field(tmp_path: Path, element: str, command: type, left_out) -> None:
    """A number has no color space, and its one file is no sequence with holes."""
    with open_still_editor(tmp_path, make_graph()) as still:
        still.select("glow")
        made = {
            "frame": lambda: still.editor.session.apply(AddFrame("Look", sizes={})),
            "comment": lambda: still.editor.session.apply(AddComment((0.0, 0.0), "words")),
        }
        key = str(made[element]() if element in made else element)
        still.select(key)
        still.show("Inspector")
        names = [*inspect.signature(command).parameters][1:]
        for name in (name for name in names if name not in ("merge", *left_out)):
            places = {f"{kind} {key} {AFTER.get(name, name)}" for kind in ("field", "name")}
            assert places & still.places.keys(), f"{name} of {element} cannot be edited"
        for name in left_out:
            assert f"name {key} {AFTER.get(name, name)}" not in still.places


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [("rate", "30", 30.0), ("preroll", "7", 7), ("overscan", "0.25", 0.25), ("reference_height", "540", 540),
     ("rate", "0.5+0.5*20", 10.5)],
)  # fmt: skip
def test_settings_of_a_graph_are_typed(tmp_path: Path, name: str, text: str, expected: float) -> None:
    with open_still_editor(tmp_path, make_graph()) as still:
        still.show("Inspector")
        if "field rate" not in still.places:
            still.click("Inspector", "fold project")
        before = still.editor.session.root.settings
        if getattr(before, name) is None:  # the first click makes a number of what is automatic
            still.click("Inspector", f"field {AFTER.get(name, name)}")
            still.calm("Inspector")
        graph = type_and_read(still, f"field {AFTER.get(name, name)}", text)
        changed = {
            field.name: getattr(graph.settings, field.name)
            for field in dataclasses.fields(Settings)
            if getattr(graph.settings, field.name) != getattr(before, field.name)
        }
        assert changed == {name: expected}


def test_all_settings_of_a_graph_have_a_field(tmp_path: Path) -> None:
    """But which files of the machine it may read: that is for whoever runs it."""
    with open_still_editor(tmp_path, make_graph()) as still:
        still.show("Inspector")
        if "field rate" not in still.places:
            still.click("Inspector", "fold project")
        named = {field.name for field in dataclasses.fields(Settings)} - {"color", "allow"}
        for name in named | {"color_config", "working_space"}:
            assert f"name {AFTER.get(name, name)}" in still.places, name


def test_texts_are_typed(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, make_graph()) as still:
        session = still.editor.session
        still.select("glow")
        frame = session.apply(AddFrame("Look", sizes={}))
        still.select(str(frame))
        still.show("Inspector")
        graph = type_and_read(still, f"field {frame} title", "A new title")
        assert "A new title" in str(graph) or "A new title" in repr(graph.layout)
        still.select("inputs.plate")
        still.show("Inspector")
        graph = type_and_read(still, "field inputs.plate doc", "Some words")
        assert graph.inputs["plate"].doc == "Some words"
        graph = type_and_read(still, "field inputs.plate name", "plate_two")
        assert set(graph.inputs) == {"plate_two", "amount"}
        graph = type_and_read(still, "field inputs.plate file", "other.exr")
        assert graph.inputs["plate"].file == "other.exr"
        still.select("outputs.image")
        still.show("Inspector")
        graph = type_and_read(still, "field outputs.image layer", "beauty")
        assert graph.outputs["image"].layer == "beauty"
        still.select("glow")
        still.show("Inspector")
        graph = type_and_read(still, "field glow name", "halo")
        assert set(graph.nodes) == {"halo"}
        graph = type_and_read(still, "field glow.intensity", "0.75")
        assert graph.value(Port("glow", "intensity")) == 0.75
