"""The graph by keyboard: every element is reached from every other one by steps to a neighbor."""

from __future__ import annotations

import pytest
from halation import document, presets
from halation.authoring.commands import AddNode, ConnectSelection
from halation.authoring.edits.appending import estimate_sizes
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import list_elements
from halation.authoring.edits.layout import positions
from halation.authoring.session import Session
from halation.editor.canvas.walking import find_middles, find_neighbor
from halation.errors import GraphError
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED
from selection import list_cases

PATHS = presets.paths()


def test_a_step_goes_to_what_lies_ahead() -> None:
    middles = {
        ElementId(name): place
        for name, place in {"a": (0.0, 0.0), "b": (200.0, 20.0), "c": (150.0, 300.0), "d": (400.0, 0.0)}.items()
    }
    a, b = ElementId("a"), ElementId("b")
    assert [find_neighbor(middles, a, way) for way in ("right", "down", "left", "up")] == ["b", "b", None, None]
    assert [find_neighbor(middles, b, way) for way in ("right", "down", "left", "up")] == ["d", "c", "a", "a"]


@pytest.mark.parametrize("path", list_cases(PATHS[::6], PATHS), ids=lambda path: path.stem)
def test_every_element_is_reached(path) -> None:
    graph = document.load(path, sandbox=UNRESTRICTED)
    sizes = estimate_sizes(graph)
    middles = find_middles(positions(graph, sizes), sizes)
    assert middles.keys() >= {key for key in list_elements(graph) if key.kind in ("frame", "dot")}
    first = next(iter(middles))
    reached, new = {first}, [first]
    while new:
        key = new.pop()
        for way in ("left", "right", "up", "down"):
            found = find_neighbor(middles, key, way)
            if found is not None and found not in reached:
                reached.add(found)
                new.append(found)
    assert reached == set(middles)


def test_what_is_selected_is_linked_to_what_was_selected_last() -> None:
    session = Session(sandbox=UNRESTRICTED)
    for kind, y in (("constant", 0.0), ("noise", 400.0), ("merge", 800.0)):
        session.apply(AddNode(kind, (0.0, y)))
    session.select(map(ElementId, ("constant", "noise", "merge")))
    session.apply(ConnectSelection())
    assert {target.socket: source.node for target, source in session.graph.links.items()} == {
        "a": "constant",
        "b": "noise",
    }
    end = ElementId.of("output", "image")
    session.select([ElementId("merge"), end])
    session.apply(ConnectSelection())
    assert session.graph.links[Port("outputs", "image")] == Port("merge", "out")
    with pytest.raises(GraphError, match="free socket"):  # it is fed already
        session.apply(ConnectSelection())
    session.select([end])
    with pytest.raises(GraphError, match="target last"):
        session.apply(ConnectSelection())
