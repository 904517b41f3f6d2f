"""Steps: what is one, what undo brings back."""

from __future__ import annotations

from dataclasses import replace

import pytest
from halation.authoring.commands import (
    AddNode,
    Disconnect,
    MakeGroup,
    MoveElements,
    PlaceElement,
    RenameNode,
    ReplaceGraph,
    SetValue,
    ToggleMute,
)
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.authoring.state import history
from halation.errors import GraphError
from halation.graph import Graph, Port
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, chain


@pytest.fixture
def session() -> Session:
    made = Session(TOYS, sandbox=UNRESTRICTED)
    made.apply(ReplaceGraph("Start", chain(3)))
    return made


def test_a_new_document_has_one_output_and_no_past():
    session = Session(sandbox=UNRESTRICTED)
    assert session.elements == ("outputs.image",)
    assert session.history.steps == () and not session.dirty and session.name == "untitled"
    assert "blur" not in session.types and "gaussian_blur" in session.types
    with pytest.raises(GraphError, match="no node type 'gausian_blur'; did you mean 'gaussian_blur'"):
        session.apply(AddNode("gausian_blur"))


def test_undo_and_redo_bring_selection_and_place_back(session):
    session.select([ElementId("n0"), ElementId("n1")])
    group = session.apply(MakeGroup("look"))
    session.enter(group)
    session.select(ElementId("n1"))
    session.apply(ToggleMute())
    session.leave()
    assert session.active == group
    session.undo()
    assert (session.place, session.selection, session.active) == ((group,), {"n1"}, "n1")
    session.undo()
    assert (session.place, session.selection) == ((), {"n0", "n1"})
    session.redo()
    session.redo()
    assert session.place == (group,) and session.graph.muted == {"n1"}


def test_a_drag_is_one_step(session):
    for _ in range(5):
        session.apply(MoveElements([ElementId("n0")], 3.0, 1.0, merge="drag"))
    assert session.history.steps == ("Start", "Move n0")
    assert session.position(ElementId("n0")) == (275.0, 5.0)
    session.seal()
    session.apply(MoveElements([ElementId("n0")], 3.0, 1.0, merge="drag"))
    assert len(session.history.steps) == 3
    session.undo()
    session.undo()
    assert session.position(ElementId("n0")) == (260.0, 0.0)


def test_a_drag_that_comes_back_is_no_step(session):
    session.apply(MoveElements([ElementId("n0")], 3.0, 1.0, merge="drag"))
    session.apply(MoveElements([ElementId("n0")], -3.0, -1.0, merge="drag"))
    session.seal()
    assert session.history.steps == ("Start",)


def test_what_changes_nothing_is_no_step(session):
    session.apply(SetValue(Port("n0", "gain"), 1.5))
    session.apply(PlaceElement(ElementId("n0"), *session.position(ElementId("n0"))))
    assert session.history.steps == ("Start",)


def test_undone_steps_are_forgotten_by_the_next_one(session):
    session.apply(SetValue(Port("n0", "gain"), 2.0))
    session.apply(SetValue(Port("n0", "gain"), 3.0))
    session.undo()
    assert session.history.steps[-2:] == ("Set n0.gain", "Set n0.gain") and session.history.can_redo
    session.apply(RenameNode("n1", "middle"))
    assert session.history.steps == ("Start", "Set n0.gain", "Rename n1 to middle")
    assert not session.history.can_redo
    session.go_to(0)
    assert session.root.nodes == {}
    session.go_to(99)
    assert "middle" in session.graph.nodes


def test_only_so_many_steps_are_kept(session, monkeypatch):
    monkeypatch.setattr(history, "MOST", 5)
    for gain in range(9):
        session.apply(SetValue(Port("n0", "gain"), float(gain)))
    assert len(session.history.steps) == session.history.position == 5
    session.go_to(0)
    assert session.graph.value(Port("n0", "gain")) == 3.0


def test_dirty_is_about_the_document_not_about_steps(session, tmp_path):
    session.files.save_as(tmp_path / "a.json")
    assert not session.dirty
    session.apply(SetValue(Port("n0", "gain"), 3.0))
    assert session.dirty
    session.apply(SetValue(Port("n0", "gain"), 1.5))
    assert not session.dirty, "it is as it was saved"
    session.undo()
    assert session.dirty
    session.select(session.elements, "extend")
    session.go_to(0)
    assert session.dirty


def test_the_revision_grows_with_every_change(session):
    seen = [session.revision]
    acts = (
        lambda: session.select(ElementId("n0")),
        lambda: session.apply(ToggleMute()),
        session.undo,
        session.redo,
        lambda: session.views.show_element(ElementId("n1")),
    )
    for act in acts:
        act()
        seen.append(session.revision)
    assert seen == sorted(set(seen))
    session.select(ElementId("n0"))
    assert session.revision == seen[-1], "nothing changed"


def test_problems_by_element(session):
    assert session.problems == {}
    session.apply(Disconnect(Port("n1", "image")))
    assert set(session.problems) == {"n1"} and "n1.image" in session.problems["n1"][0].sentence
    session.apply(Disconnect(Port("outputs", "image")))
    assert set(session.problems) == {"n1", "outputs.image"}
    known = session.problems
    session.apply(MoveElements([ElementId("n0")], 5.0, 5.0))
    assert session.problems is known, "the layout changes no problem"
    session.select(ElementId("n1"))
    session.enter(session.apply(MakeGroup()))
    assert set(session.problems) == {"n1"}, "the output of the group is linked inside"
    session.leave()
    assert {problem.node for some in session.problems.values() for problem in some} == {"group/n1", "outputs"}


def test_layout_is_saved_with_the_first_edit_so_that_nothing_jumps():
    session = Session(TOYS, sandbox=UNRESTRICTED)
    graph = replace(chain(3), ui={})
    session.restart(graph, saved=graph)
    assert not session.dirty
    before = dict(session.positions)
    session.apply(Disconnect(Port("n1", "image")))
    assert session.positions == before
    session.undo()
    assert session.root == graph and isinstance(session.root, Graph)
