"""Keys and expressions go where their values go."""

from __future__ import annotations

import pytest
from halation.authoring.commands import (
    ExposeValue,
    HideControl,
    MakeGroup,
    PasteText,
    RenameControl,
    ReplaceGraph,
    ResetValue,
    Ungroup,
)
from halation.authoring.edits import timing
from halation.authoring.edits.clipboard import copy_elements
from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.document import dumps, loads
from halation.errors import GraphError
from halation.graph import Control, Expression, Graph, Keys, Output, Port, evaluate_at_frame, problems
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain


def port(text: str) -> Port:
    return Port.parse(text)


KEYS = Keys().set(1, 0.5).set(9, 2.0)


@pytest.fixture
def session() -> Session:
    made = Session({**TOYS, "gain": Gain}, sandbox=UNRESTRICTED)
    graph = Graph(outputs={"image": Output()})
    for id in ("a", "b", "c"):
        graph = graph.add(id, Gain())
    graph = graph.connect(port("a.out"), port("b.image")).connect(port("b.out"), port("c.image"))
    graph = graph.connect(port("c.out"), port("outputs.image")).add_control("strength", Control(port("b.gain")))
    graph = graph.animate(port("a.gain"), KEYS).animate(port("b.gain"), Expression("a.gain * 2"))
    made.apply(ReplaceGraph("Start", graph.animate(port("c.gain"), Expression("strength + 0.25"))))
    return made


def gains(graph: Graph, frame: int) -> list[object]:
    """The gain of every node, groups looked into, at a frame."""
    found, todo = dict[str, object](), [evaluate_at_frame(graph, frame)]
    while todo:
        for id, item in todo.pop().nodes.items():
            if isinstance(item, Gain):
                found[id] = item.gain
            else:
                todo.append(item.body())
    return [found[id] for id in sorted(found)]


FRAMES = (1, 4, 9)


def test_a_group_and_its_end(session):
    before = [gains(session.root, frame) for frame in FRAMES]
    session.select([ElementId("a"), ElementId("b")])
    with pytest.raises(GraphError, match="other side of the group's border"):
        session.apply(MakeGroup())  # b.gain is outside now, as a control, and reads a.gain, which has none
    session.apply(ExposeValue(port("a.gain")))
    session.select([ElementId("a"), ElementId("b")])
    id = session.apply(MakeGroup())
    graph = session.root
    assert graph.animation[Port(id, "gain")] == KEYS
    assert graph.animation[Port(id, "strength")] == Expression(f"{id}.gain * 2")
    assert [gains(graph, frame) for frame in FRAMES] == before
    assert [problem.socket for problem in problems(graph, session.types)] == ["image"], "the end of the chain is open"
    assert loads(dumps(graph), catalogue=session.types, sandbox=UNRESTRICTED) == graph
    session.apply(Ungroup(id))
    assert session.root.animation[port("b.gain")] == Expression("a.gain * 2")
    assert [gains(session.root, frame) for frame in FRAMES] == before


def test_what_a_group_holds_is_animated_inside(session):
    session.apply(ResetValue(port("b.gain")))
    session.apply(ResetValue(port("c.gain")))
    session.apply(HideControl("strength"))
    session.select([ElementId("a")])
    id = session.apply(MakeGroup())
    assert session.root.nodes[id].graph.animation == {port("a.gain"): KEYS} and not session.root.animation


def test_copies_have_keys_and_read_each_other(session):
    session.select([ElementId("a"), ElementId("b")])
    text = copy_elements(session.graph, session.selection)
    keys = session.apply(PasteText(text))
    first, second = (key for key in keys if key in session.graph.nodes)
    assert session.graph.animation.get(Port(first, "gain")) == KEYS
    assert session.graph.animation.get(Port(second, "gain")) == Expression(f"{first}.gain * 2")


def test_a_control_of_a_group_that_is_renamed_or_hidden(session):
    session.apply(ExposeValue(port("a.gain"), "power"))
    session.select([ElementId("a"), ElementId("b")])
    id = session.apply(MakeGroup())
    session.enter(id)
    session.apply(RenameControl("power", "force"))
    assert session.root.animation[Port(id, "force")] == KEYS
    assert session.root.animation[Port(id, "strength")] == Expression(f"{id}.force * 2")
    session.apply(HideControl("strength"))
    assert Port(id, "strength") not in session.root.animation


def test_names_are_changed_all_at_once():
    names = {"a": "b", "b": "a", "c.gain": "group.glow"}
    assert timing.rename_in_expression(Expression("a.gain + b.gain * c.gain.x - c.sigma"), names) == Expression(
        "b.gain + a.gain * group.glow.x - c.sigma"
    )
