"""What is drawn of a value depends on the value, on nodes and in the inspector, and fields that hold one say so.

The values are those that declarations allow. Nothing here knows how a field looks, only that a user must be able to
tell two values apart, and that both panels agree on whether a value is written as words.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.authoring.commands import MakeGroup, ReplaceGraph, SetValue
from halation.editor.canvas.layout import _describe_item  # pyright: ignore[reportPrivateUsage]
from halation.editor.theme.palette import DARK
from halation.graph import Graph, Port
from halation.nodes import Plain, Value, catalogue
from still_editor import StillEditor, open_still_editor
from still_screens import list_typical_nodes

NODES = {node.id: node for node in list_typical_nodes()} | {
    id: catalogue()[id] for id in ("bloom", "vignette", "tone_map", "noise", "grade", "levels") if id in catalogue()
}


def find_others(value: Value) -> list[Plain]:
    """Values far from the default, that every field shows in full."""
    match value.type:
        case "bool":
            return [not value.default]
        case "float" | "int":
            numbers = {value.low, value.high, value.low + (value.high - value.low) * 0.25}
            numbers = {int(number) for number in numbers} if value.type == "int" else numbers
            return [*(numbers - {value.default})]
        case "choice":
            return [choice for choice in value.choices if choice != value.default][:2]
        case "color":
            return [(0.1, 0.8, 0.3, 1.0)]
        case _:
            return []


def draw(still: StillEditor, title: str) -> list[object]:
    still.pane.point((1.0, 1.0))
    still.show(title, 3)
    return [(shape.kind, shape.points, shape.lengths, shape.color, shape.text) for shape in still.pane.shapes.shapes]


@pytest.mark.parametrize("id", NODES)
def test_two_values_look_different(tmp_path: Path, id: str) -> None:
    with open_still_editor(tmp_path, Graph().add("node", NODES[id]()), size=(1200.0, 2400.0)) as still:
        session, canvas = still.editor.session, still.editor.canvas
        still.select("node")
        still.show("Graph", 3)
        shown = {place.partition(".")[2] for place in still.places if place.startswith("widget ")}
        canvas.zoom, canvas.center = 1.0, (100.0, 200.0)
        plain = {title: draw(still, title) for title in ("Graph", "Inspector")}
        fields = {place.partition(".")[2] for place in still.places if place.startswith("field ")}
        for name, value in NODES[id].values.items():
            for other in find_others(value):
                before = session.root
                session.apply(SetValue(Port("node", name), other))
                for title, names in (("Graph", shown), ("Inspector", fields)):
                    if name in names:
                        assert draw(still, title) != plain[title], f"{title} shows nothing of {name} = {other}"
                still.undo_to(before)
        assert {title: draw(still, title) for title in plain} == plain, "what is undone looks as before"


def test_the_color_of_a_header_is_that_of_the_menu() -> None:
    """Of what is in no menu, it says what it is."""
    graph = Graph()
    for id, node in NODES.items():
        graph = graph.add(id, node())
        assert _describe_item("a name", graph.nodes[id], "node")[2] == node.category
        assert DARK.category(node.category) in {*DARK.categories.values()}


def test_a_group_has_the_color_of_groups(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, Graph().add("noise", catalogue()["noise"]())) as still:
        still.select("noise")
        still.editor.session.apply(MakeGroup("look"))
        (group,) = still.editor.session.graph.nodes.values()
        assert _describe_item("look", group, "group")[2] == "group"
        assert DARK.category("group") != DARK.category(catalogue()["noise"].category)
        still.editor.session.apply(ReplaceGraph("End", Graph()))
