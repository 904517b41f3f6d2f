"""What fields remember between frames, and what their edits do to one or several nodes."""

from __future__ import annotations

import pytest
from halation.authoring.commands import ReplaceGraph
from halation.authoring.session import Session
from halation.editor.fields.fields import Edit, Fields
from halation.editor.inspector.applying import apply, as_text, common, from_text, reset
from halation.editor.theme.palette import DARK
from halation.errors import HalationError, UsageError
from halation.graph import Graph, Port, Unknown
from halation.nodes import Value
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Blend, Gain, Soften

GAIN = Gain.values["gain"]


@pytest.fixture
def session() -> Session:
    made = Session(TOYS, sandbox=UNRESTRICTED)
    made.apply(
        ReplaceGraph("Start", Graph({"one": Gain(gain=1.0), "two": Gain(gain=3.0), "blend": Blend(), "soft": Soften()}))
    )
    return made


def gains(session: Session) -> tuple[float, float]:
    return session.graph.value(Port("one", "gain")), session.graph.value(Port("two", "gain"))


class TestTyping:
    def test_a_field_that_is_gone_hands_over_what_was_typed(self):
        fields = Fields(DARK)
        fields.type_in("one.gain", "1", 1.0, GAIN)
        fields.typing.starting, fields.typing.text = False, "*4"
        fields.begin()
        fields.typing.is_drawn = True
        assert fields.end() is None
        fields.begin()
        assert fields.end() == ("one.gain", Edit(4.0, text="*4"))
        assert fields.typing is None

    def test_a_part_hands_over_the_whole(self):
        fields = Fields(DARK)
        fields.type_in("one.tint picker light#1", "1", 1.0, GAIN)
        fields.typing.starting, fields.typing.text = False, "0.25"
        fields.part("one.tint picker light#1", "one.tint picker light", lambda edit: Edit((9.0, edit.value)))
        fields.part("one.tint picker light", "one.tint", lambda edit: edit)
        fields.begin()
        assert fields.end() == ("one.tint", Edit((9.0, 0.25)))

    @pytest.mark.parametrize("text", ["1", "nonsense", "99"])
    def test_nothing_new_and_mistakes_are_dropped(self, text):
        fields = Fields(DARK)
        fields.type_in("one.gain", "1", 1.0, GAIN)
        fields.typing.starting, fields.typing.text = False, text
        fields.begin()
        assert fields.end() is None

    def test_the_reason_of_a_mistake(self):
        fields = Fields(DARK)
        fields.type_in("one.gain", "1", 1.0, GAIN)
        fields.typing.text = "99"
        assert fields.typing.fault == "99 is too large: type a number from 0 to 16"
        with pytest.raises(UsageError):
            fields.typing.result()

    def test_tab_goes_through_the_fields_of_the_frame_before(self):
        fields = Fields(DARK)
        fields.order[:] = ["a", "b", "c"]
        fields.begin()
        assert [fields.next_after("a", 1), fields.next_after("a", -1), fields.next_after("x", 1)] == ["b", "c", ""]

    def test_gestures_differ(self):
        fields = Fields(DARK)
        first = fields.start_gesture()
        assert fields.merge == first != fields.start_gesture()


class TestApplying:
    def test_several_nodes_are_one_step(self, session):
        ports = Port("one", "gain"), Port("two", "gain")
        steps = len(session.history.steps)
        apply(session, ports, GAIN, Edit(2.0))
        assert gains(session) == (2.0, 2.0)
        assert len(session.history.steps) == steps + 1
        reset(session, ports)
        assert gains(session) == (1.0, 1.0)
        session.undo()
        session.undo()
        assert gains(session) == (1.0, 3.0)

    def test_what_was_typed_relative_to_the_old_number_counts_for_each(self, session):
        apply(session, (Port("one", "gain"), Port("two", "gain")), GAIN, Edit(2.0, text="*2"))
        assert gains(session) == (2.0, 6.0)

    def test_a_number_that_one_of_them_cannot_take_changes_none(self, session):
        with pytest.raises(HalationError, match=r"two\.gain: 18 is too large"):
            apply(session, (Port("one", "gain"), Port("two", "gain")), GAIN, Edit(16.0, text="+15"))
        assert gains(session) == (1.0, 3.0)

    def test_a_drag_of_several_is_one_step(self, session):
        ports = Port("one", "gain"), Port("two", "gain")
        steps = len(session.history.steps)
        for number in (1.5, 1.75):
            apply(session, ports, GAIN, Edit(number, merge="drag"))
        assert (gains(session), len(session.history.steps)) == ((1.75, 1.75), steps + 1)

    def test_what_nodes_have_in_common(self, session):
        graph = session.graph
        assert [value.name for value in common(graph, ("one", "two"))] == list(Gain.values)
        assert [value.name for value in common(graph, ("one", "blend"))] == ["gain"]
        of_masks = common(graph, ("one", "soft"))
        assert [(value.name, value.folded) for value in of_masks] == [("mix", True), ("invert_mask", True)]
        assert common(graph, ("blend", "soft")) == ()
        assert common(graph.add("odd", Unknown("odd")), ("one", "odd")) == ()

    @pytest.mark.parametrize("plain", [1.5, 3, True, "soft light", (1.0, 2.0)])
    def test_values_pass_the_clipboard(self, plain):
        assert from_text(as_text(Value("any", "float", 0.0), plain)) == plain

    def test_what_is_no_value(self):
        assert from_text(" plain words ") == "plain words"
        with pytest.raises(UsageError, match="holds no value"):
            from_text('{"a": 1}')


def test_an_edit_of_text_is_taken_as_it_is():
    fields = Fields(DARK)
    fields.type_in("one.note", "", "", None)
    fields.typing.text = "1+1"
    assert fields.typing.result() == Edit("1+1", text="1+1")
