"""Keys, expressions and frames of a document that is open."""

from __future__ import annotations

import pytest
from halation.authoring.commands import (
    AnimateValues,
    BakeKeys,
    ExposeValue,
    MakeGroup,
    RemoveKey,
    ReplaceGraph,
    ResetValue,
    SetCanvasSize,
    SetExpression,
    SetFrameRange,
    SetFrameRate,
    SetKey,
    SetPreroll,
    SetValue,
    ToggleKey,
)
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.values import can_animate, find_expression_fault, is_default
from halation.authoring.session import Session
from halation.errors import GraphError
from halation.graph import Expression, Keys, Port
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain, chain


def port(text: str) -> Port:
    return Port.parse(text)


GAIN = port("gain.gain")


@pytest.fixture
def session() -> Session:
    made = Session({**TOYS, "gain": Gain}, sandbox=UNRESTRICTED)
    made.apply(ReplaceGraph("Start", chain(2).add("gain", Gain())))
    return made


def test_frames_are_the_documents_or_measured(session):
    assert (session.time.frames, session.time.frame) == ((1, 1), 1)
    session.time.measure_frames = lambda graph, bindings: (1001, 1024)
    session.time.remeasure()
    assert (session.time.frames, session.time.frame) == ((1001, 1024), 1001)
    session.apply(SetFrameRange(10, 20))
    session.time.seek(14.6)
    assert (session.time.frames, session.time.frame) == ((10, 20), 15)
    session.undo()
    assert (session.time.frames, session.time.frame) == ((1001, 1024), 15), "the frame is view state"
    with pytest.raises(GraphError, match="comes after"):
        session.apply(SetFrameRange(5, 4))


def test_a_range_that_cannot_be_measured_is_that_of_the_keys(session):
    def fails(graph, bindings):
        raise GraphError("no")

    session.time.measure_frames = fails
    session.time.seek(12)
    session.apply(SetKey(GAIN))
    assert session.time.frames == (1, 12)


def test_settings_stay_beside_each_other_and_are_the_documents_in_groups(session):
    session.apply(SetFrameRate(25))
    session.apply(SetCanvasSize((8, 4)))
    session.select([ElementId("n0"), ElementId("n1")])
    group = session.apply(MakeGroup())
    session.enter(group)
    session.apply(SetPreroll(6))
    found = session.root.settings
    assert (found.rate, found.size, found.preroll) == (25.0, (8, 4), 6)
    assert session.history.steps[-1] == "Set pre-roll" and session.place == (group,)


def test_a_value_with_keys_gets_keys_and_undo_is_one_step(session):
    session.apply(SetKey(GAIN, 1.0))
    session.time.seek(11)
    steps = session.history.position
    for value in (2.0, 2.5, 3.0):
        session.apply(SetValue(GAIN, value, merge="drag"))
    session.seal()
    assert session.history.position == steps + 1
    assert [(key.frame, key.value) for key in session.graph.animation.get(GAIN).keys] == [(1, 1.0), (11, 3.0)]
    session.time.seek(6)
    assert session.time.evaluate(GAIN) == pytest.approx(2.0) and session.graph.value(GAIN) == 1.0
    assert (
        session.time.evaluated_graph.value(GAIN) == session.time.evaluate(GAIN)
        and session.time.evaluated_graph is session.time.evaluated_graph
    )
    assert session.time.find_key(GAIN) is None and not is_default(session.graph, GAIN)
    session.undo()
    assert session.graph.animation.get(GAIN).frames == (1.0,)


def test_toggling_a_key_keeps_the_value(session):
    session.apply(SetValue(GAIN, 2.0))
    session.apply(ToggleKey(GAIN))
    assert session.time.find_key(GAIN).value == 2.0
    session.time.seek(9)
    session.apply(SetValue(GAIN, 4.0))
    session.time.seek(1)
    session.apply(ToggleKey(GAIN))
    session.time.seek(9)
    session.apply(ToggleKey(GAIN))
    assert session.graph.animation.get(GAIN) is None and session.graph.value(GAIN) == 4.0
    with pytest.raises(GraphError, match="no key at frame 9"):
        session.apply(RemoveKey(GAIN))


def test_a_key_beyond_the_hard_range_changes_nothing(session):
    session.apply(SetKey(GAIN, 1.0))
    before = session.root
    with pytest.raises(GraphError):
        session.apply(SetValue(GAIN, 99.0))
    assert session.root is before


def test_expressions_are_set_edited_baked_and_removed(session):
    session.apply(SetFrameRange(1, 4))
    session.apply(SetExpression(GAIN, "= frame / 2"))
    assert session.graph.animation.get(GAIN) == Expression("frame / 2")
    session.time.seek(3)
    assert session.time.evaluate(GAIN) == 1.5
    for edit in (lambda: session.apply(SetValue(GAIN, 1.0)), lambda: session.apply(SetKey(GAIN))):
        with pytest.raises(GraphError, match="expression"):
            edit()
    session.apply(BakeKeys(GAIN))
    assert [key.value for key in session.graph.animation.get(GAIN).keys] == [0.5, 1.0, 1.5, 2.0]
    session.undo()
    session.apply(SetExpression(GAIN, ""))
    assert session.graph.animation.get(GAIN) is None and session.graph.value(GAIN) == 1.5
    assert "^" in find_expression_fault(session.graph, GAIN, "1 +")
    with pytest.raises(GraphError, match="no node 'nobody'"):
        session.apply(SetExpression(GAIN, "nobody.gain"))


def test_jumping_goes_by_the_selected_nodes_else_by_all(session):
    other = port("gain.steps")
    session.apply(AnimateValues({GAIN: Keys().set(3, 1.0).set(9.6, 2.0), other: Keys().set(5, 2)}, "Keys"))
    assert session.time.list_key_frames() == (3, 5, 10) and session.time.list_key_frames(other) == (5,)
    assert (session.time.find_next_key(), session.time.find_previous_key()) == (3, None)
    session.time.seek(10)
    assert (session.time.find_next_key(), session.time.find_previous_key()) == (None, 5)
    assert session.time.find_previous_key(GAIN) == 3
    session.select([ElementId("n0")])
    assert session.time.list_key_frames() == (3, 5, 10), "a node without keys: all of them"


def test_what_cannot_change_over_time(session):
    assert can_animate(session.graph, GAIN) and can_animate(session.graph, port("gain.tint"))
    assert not can_animate(session.graph, port("gain.note")) and not can_animate(session.graph, port("gain.mode"))
    assert not can_animate(session.graph, port("nobody.gain"))


def test_resetting_removes_keys(session):
    session.apply(SetKey(GAIN, 2.0))
    session.apply(ResetValue(GAIN))
    assert session.graph.animation.get(GAIN) is None and is_default(session.graph, GAIN)


def test_inside_a_group_an_animated_control_is_what_it_is_outside(session):
    session.select([ElementId("gain")])
    group = session.apply(MakeGroup())
    session.enter(group)
    name = session.apply(ExposeValue(GAIN))
    session.leave()
    outer = Port(group, name)
    session.apply(SetKey(outer, 1.0))
    session.time.seek(5)
    session.apply(SetValue(outer, 3.0))
    session.enter(group)
    assert session.time.evaluate(GAIN) == 3.0 == session.time.evaluated_graph.value(GAIN)
    assert session.time.find_outer_animation(GAIN) == ((), outer)
    with pytest.raises(GraphError, match="change it there"):
        session.apply(SetValue(GAIN, 1.0))


def test_another_document_begins_at_its_first_frame(session, tmp_path):
    session.time.seek(40)
    session.apply(SetFrameRange(7, 9))
    session.files.save_as(tmp_path / "a.json")
    session.files.new()
    assert session.time.frame == 1
