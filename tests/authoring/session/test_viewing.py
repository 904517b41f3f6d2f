"""What the viewer shows."""

from __future__ import annotations

import pytest
from halation.authoring.commands import (
    AddNode,
    AssignViewer,
    DeleteSelection,
    Disconnect,
    MakeGroup,
    RenameEnd,
    RenameNode,
    ReplaceGraph,
)
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.compiler import Request, compile_graph
from halation.errors import GraphError
from halation.graph import Graph, Input, Output, Port
from halation.nodes import catalogue
from halation.resources.picture import Picture
from halation.resources.sandbox import UNRESTRICTED
from headers import Headers
from toy_nodes import TOYS, chain


def port(text: str) -> Port:
    return Port.parse(text)


@pytest.fixture
def session() -> Session:
    made = Session(TOYS, sandbox=UNRESTRICTED)
    made.apply(ReplaceGraph("Start", chain(3)))
    return made


def test_without_a_choice_a_shows_the_output_and_b_nothing(session):
    assert session.views.find_port() == port("outputs.image") and session.views.find_port("B") is None
    session.apply(Disconnect(port("outputs.image")))
    assert session.views.find_port() == port("n2.out"), "the last node"
    session.select(session.elements, "extend")
    session.apply(DeleteSelection())
    assert session.views.find_port() is None


def test_a_port_that_vanishes_comes_back(session):
    session.views.show(port("n1.out"))
    session.views.show(port("n0.out"), "B")
    session.select([ElementId("n0"), ElementId("n1")])
    session.apply(DeleteSelection())
    assert (session.views.find_port(), session.views.find_port("B")) == (port("outputs.image"), None)
    session.undo()
    assert (session.views.find_port(), session.views.find_port("B")) == (port("n1.out"), port("n0.out"))
    session.views.clear("B")
    assert session.views.find_port("B") is None


def test_the_view_follows_a_new_name_and_back(session):
    session.views.show(port("n1.out"))
    session.views.show(port("inputs.beauty"), "B")
    session.apply(RenameNode("n1", "middle"))
    session.apply(RenameEnd(ElementId("inputs.beauty"), "plate"))
    assert (session.views.find_port(), session.views.find_port("B")) == (port("middle.out"), port("inputs.plate"))
    session.undo()
    session.undo()
    assert (session.views.find_port(), session.views.find_port("B")) == (port("n1.out"), port("inputs.beauty"))


def test_viewing_a_node_again_shows_its_next_output(session):
    id = session.apply(AddNode("split", link=port("n2.out")))
    seen = []
    for _ in range(3):
        session.views.show_element(ElementId(id))
        seen.append(str(session.views.find_port()))
    assert seen == ["split.grey", "split.rest", "split.grey"]
    session.views.show_element(ElementId("outputs.image"))
    assert session.views.find_port() == port("outputs.image")
    with pytest.raises(GraphError, match=r"no 'n9\.out' to show"):
        session.views.show(port("n9.out"))


def test_every_group_has_a_view_of_its_own(session):
    session.views.show(port("n0.out"))
    session.select(ElementId("n1"))
    session.enter(session.apply(MakeGroup("look")))
    assert session.views.find_port() == port("outputs.out")
    session.views.show_element(ElementId("n1"))
    session.leave()
    assert session.views.find_port() == port("n0.out")
    session.enter("look")
    assert session.views.find_port() == port("n1.out")
    assert session.views.find_root_port() == port("look/n1.out")
    session.views.show(port("inputs.image"))
    assert session.views.find_root_port() == port("n0.out"), "what feeds the group"


def test_what_the_compiler_is_asked_for():
    session = Session(sandbox=UNRESTRICTED)
    graph = Graph(inputs={"image": Input()}, outputs={"image": Output()})
    for id, before in (("a", "inputs.image"), ("b", "a.out"), ("c", "b.out")):
        graph = graph.add(id, catalogue()["gaussian_blur"]()).connect(port(before), Port(id, "image"))
    session.apply(ReplaceGraph("Start", graph.connect(port("c.out"), port("outputs.image"))))

    def key(target: Port | None) -> str:
        assert target is not None
        request = Request({"x": target}, {"image": Picture("image", "", Input().kind, 4, in_memory=True)})
        plan = compile_graph(session.root, request, Headers((8, 6)))
        return plan.surfaces[plan.outputs["x"]].key

    wanted = {name: key(port(name)) for name in ("inputs.image", "a.out", "b.out", "c.out")}
    session.select([ElementId("a"), ElementId("b")])
    session.enter(session.apply(MakeGroup("outer")))
    session.select([ElementId("b")])
    session.enter(session.apply(MakeGroup("inner")))
    for name, same in (("inputs.image", "a.out"), ("b.out", "b.out"), ("outputs.out", "b.out")):
        session.views.show(port(name))
        assert key(session.views.find_root_port()) == wanted[same]
    session.leave()
    for name, same in (("inputs.image", "inputs.image"), ("a.out", "a.out"), ("inner.out", "b.out")):
        session.views.show(port(name))
        assert key(session.views.find_root_port()) == wanted[same]


def test_viewer_keys(session):
    session.select(ElementId("n1"))
    session.apply(AssignViewer(1))
    session.apply(AssignViewer(2, port("inputs.beauty")))
    assert session.views.numbered_ports == {1: port("n1.out"), 2: port("inputs.beauty")}
    assert session.graph.ui["viewers"] == {"1": "n1.out", "2": "inputs.beauty"}
    session.views.recall(1, "B")
    assert session.views.find_port("B") == port("n1.out") and session.views.find_port() == port("inputs.beauty")
    session.apply(RenameNode("n1", "middle"))
    assert session.views.numbered_ports[1] == port("middle.out")
    session.select(ElementId("middle"))
    session.apply(DeleteSelection())
    assert set(session.views.numbered_ports) == {2}
    for number, said in ((3, "nothing is assigned"), (1, "nothing is assigned")):
        with pytest.raises(GraphError, match=said):
            session.views.recall(number)
    with pytest.raises(GraphError, match="choose 1 to 9"):
        session.apply(AssignViewer(0))


def test_another_document_forgets_what_was_viewed(session):
    session.views.show(port("n0.out"))
    session.files.new()
    session.apply(ReplaceGraph("Start", chain(3)))
    assert session.views.find_port() == port("outputs.image")


def test_a_new_document_has_no_error_until_it_has_a_node() -> None:
    session = Session(sandbox=UNRESTRICTED)
    assert not session.problems
    session.apply(AddNode("checker"))
    (problem,) = session.problems[ElementId.of("output", "image")]
    assert problem.severity == "error" and "nothing feeds" in problem.sentence
    session.undo()
    assert not session.problems
