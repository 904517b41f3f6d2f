"""What panels draw has the looks of the style guide, whatever they show and wherever the pointer is, and no others."""

from __future__ import annotations

import json
import shutil
from collections import defaultdict
from collections.abc import Callable

import pytest
from gui_screens import write_many_things
from halation import document
from halation.authoring.commands import (
    AddComment,
    AddDot,
    AddFrame,
    MakeGroup,
    ReplaceGraph,
    ToggleCollapse,
    ToggleMute,
)
from halation.graph import Graph, Port
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui
from still_editor import StillEditor, name_kind, open_still_editor
from still_pictures import show_files, show_handles, show_lessons, show_passes, show_search, show_status, show_viewer
from still_screens import (
    Screens,
    show_animation,
    show_dialogs,
    show_more_dialogs,
    show_panels,
    show_renders,
    show_typical_nodes,
    show_values,
)
from style_guide import UNNAMED, name_shape, read_guide, use_guide


def show_canvas(still: StillEditor) -> Screens:
    """Every element of a graph in every state, at a zoom of 1."""
    session, canvas = still.editor.session, still.editor.canvas
    still.show("Graph", 2)
    canvas.center, canvas.zoom = (300.0, 100.0), 1.0
    yield "plain", "Graph"
    still.select("bloom", "grade")
    yield "selected", "Graph"
    session.apply(ToggleMute())
    yield "muted", "Graph"
    session.apply(AddFrame("Look", sizes={}))
    yield "frame", "Graph"
    session.apply(AddComment((40.0, -160.0), "Check the highlights"))
    session.apply(AddComment((240.0, -160.0), ""))
    still.select("bloom", "grade")
    session.apply(ToggleCollapse())
    still.select()
    yield "comment", "Graph"
    session.apply(AddDot(Port("bloom", "image"), (60.0, 60.0)))
    yield "dot", "Graph"
    still.select("grade")
    session.apply(MakeGroup("look"))
    yield "group", "Graph"
    session.views.show(Port("bloom", "out"))
    session.views.show(Port("vignette", "out"), "B")
    yield "viewed", "Graph"
    session.apply(ReplaceGraph("Start", Graph()))
    still.show("Graph", 2)
    canvas.center, canvas.zoom = (0.0, 0.0), 1.0
    yield "empty", "Graph"
    session.apply(ReplaceGraph("Start", document.loads(json.dumps(FAULTY), "text", sandbox=UNRESTRICTED)))
    still.show("Graph", 2)
    canvas.center, canvas.zoom = (0.0, 0.0), 1.0
    yield "faulty", "Graph"


FAULTY = {
    "halation": 1,
    "nodes": {"nope": {"type": "no_such_node"}, "grade": {"type": "grade"}, "noise": {"type": "noise"}},
    "links": {"grade.image": "noise.nothing", "grade.mask": "noise.out"},
}
"""A node that nobody knows, and links that cannot be."""


SCREENS: tuple[Callable[[StillEditor], Screens], ...] = (
    show_typical_nodes, show_values, show_panels, show_animation, show_renders, show_handles, show_viewer, show_files,
    show_passes, show_lessons, show_search, show_status, show_dialogs, show_more_dialogs, show_canvas,
)  # fmt: skip


def list_looks(still: StillEditor, title: str) -> set[str]:
    """The looks of a panel, with the pointer away and over each kind of place."""
    still.show(title, 4)
    seen, looks, places = set[str](), set[str](), {"": (0.0, 0.0, 2.0, 2.0), **still.places}
    for place, box in places.items():
        kind = name_kind(place)
        if kind in seen:
            continue
        seen.add(kind)
        still.pane.point(((box[0] + box[2]) / 2, (box[1] + box[3]) / 2))
        still.show(title, 3)
        looks |= {name_shape(shape) for shape in still.pane.shapes.shapes if shape.kind not in UNNAMED}
        if (pointer := imgui.MouseCursor_(imgui.get_mouse_cursor())) != imgui.MouseCursor_.arrow:
            looks.add(f"pointer: {pointer.name}")
    still.pane.point((1.0, 1.0))
    return looks


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> dict[str, set[str]]:
    """The looks of each panel on all its screens."""
    folder, looks = tmp_path_factory.mktemp("guide"), defaultdict[str, set[str]](set)
    path = write_many_things(folder)
    with use_guide():
        for screens in SCREENS:
            shutil.rmtree(folder / "state", ignore_errors=True)
            size = (1400.0, 1400.0) if screens is show_canvas else (340.0, 900.0)
            with open_still_editor(folder, path, screen=(3000.0, 3000.0), size=size) as still:
                for _, title in screens(still):
                    if title != "Graph" or screens is show_canvas:  # others show it at some zoom
                        looks[title] |= list_looks(still, title)
    return looks


@pytest.mark.parametrize("title", read_guide())
def test_a_panel_has_the_looks_of_the_guide_and_no_others(drawn: dict[str, set[str]], title: str) -> None:
    assert drawn[title] - read_guide()[title] == set(), "looks that the guide does not know"
    assert read_guide()[title] - drawn[title] == set(), "looks that nothing has"


def test_the_guide_knows_all_panels(drawn: dict[str, set[str]]) -> None:
    assert {title for title, looks in drawn.items() if looks} == {*read_guide()}
