"""Commands for named items: lights that are added, copied, renamed and removed."""

from __future__ import annotations

import pytest
from halation.authoring.commands import (
    AddItem,
    DuplicateItem,
    ExchangeItems,
    RemoveItem,
    RenameItem,
    ReplaceGraph,
    ResetValue,
    SetExpression,
    SetKey,
    SetValue,
)
from halation.authoring.session import Session
from halation.document import dumps, loads
from halation.document.diff_merge import compare_graphs, describe_difference, merge_graphs
from halation.errors import GraphError
from halation.graph import Control, Expression, Graph, Group, Keys, Port, evaluate_at_frame, problems
from halation.nodes import MAX_LIGHTS, Light, LightKind, item_of, lights_of, number_lights
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Lamps

LIGHTS = Port("lamps", "lights")
INTENSITY = Port("lamps", "lights.lamp_1.intensity")
LAMPS = (Light(), Light(LightKind.SUN, intensity=3.0))


@pytest.fixture
def session() -> Session:
    session = Session(TOYS, sandbox=UNRESTRICTED)
    graph = Graph().add("lamps", Lamps(lights=number_lights(LAMPS)))
    session.apply(ReplaceGraph("Add", graph.add_control("key", Control(INTENSITY))))
    return session


def of(session: Session) -> dict[str, Light]:
    items = session.graph.value(LIGHTS)
    return dict(zip(items, lights_of(items), strict=True))


def test_lights_are_added_copied_and_removed_each_as_one_step(session):
    steps = len(session.history.steps)
    assert session.apply(AddItem(LIGHTS, "spot", {"place": (1, 2, 3)})) == "spot_1"
    assert of(session)["spot_1"] == Light(LightKind.SPOT, (1.0, 2.0, 3.0))
    assert session.apply(DuplicateItem(LIGHTS, "lamp_2")) == "lamp_3" and of(session)["lamp_3"] == LAMPS[1]
    session.apply(RemoveItem(LIGHTS, "lamp_1"))
    assert [*of(session)] == ["lamp_2", "lamp_3", "spot_1"] and not session.graph.controls
    assert len(session.history.steps) == steps + 3
    for _ in range(3):
        session.undo()
    assert [*of(session)] == ["lamp_1", "lamp_2"] and "key" in session.graph.controls


def test_keys_expressions_and_controls_follow_a_name(session):
    session.apply(SetKey(INTENSITY))
    session.apply(SetExpression(Port("lamps", "lights.lamp_2.intensity"), "2 * lamps.lights.lamp_1.intensity"))
    short = Port("lamps", "lights.lamp_2.exposure")
    session.apply(SetExpression(short, "lamps.lamp_1.intensity - 10 * lamps.lamp_1.color.r"))
    session.apply(RenameItem(LIGHTS, "lamp_1", "key light"))
    animation = session.graph.animation
    assert isinstance(animation[Port("lamps", "lights.key light.intensity")], Keys)
    expression = animation[Port("lamps", "lights.lamp_2.intensity")]
    assert isinstance(expression, Expression) and expression.text == "2 * lamps.lights.`key light`.intensity"
    assert animation[short].text == "lamps.`key light`.intensity - 10 * lamps.`key light`.color.r"
    assert session.graph.controls["key"].target == Port("lamps", "lights.key light.intensity")
    assert not [problem for problem in problems(session.graph) if problem.rule.name == "bad-animation"]
    lights = lights_of(evaluate_at_frame(session.graph, 1).value(LIGHTS))
    assert [light.intensity for light in lights] == [10.0, 20.0]
    text = dumps(session.graph)
    assert loads(text, catalogue=TOYS, sandbox=UNRESTRICTED) == session.graph


def test_exchanged_lights_have_each_others_place_with_their_keys_and_controls(session):
    session.apply(SetKey(INTENSITY))
    session.apply(ExchangeItems(LIGHTS, "lamp_1", "lamp_2"))
    assert [*of(session).values()] == [LAMPS[1], LAMPS[0]]
    other = Port("lamps", "lights.lamp_2.intensity")
    assert [*session.graph.animation] == [other] and session.graph.controls["key"].target == other
    session.undo()
    assert [*of(session).values()] == [*LAMPS]
    session.apply(ExchangeItems(LIGHTS, "lamp_1", "lamp_1"))
    assert [*of(session).values()] == [*LAMPS]


def test_a_removed_light_takes_its_keys_and_a_copy_has_them_too(session):
    session.apply(SetKey(INTENSITY))
    session.apply(DuplicateItem(LIGHTS, "lamp_1"))
    assert Port("lamps", "lights.lamp_3.intensity") in session.graph.animation
    session.apply(RemoveItem(LIGHTS, "lamp_1"))
    assert [*session.graph.animation] == [Port("lamps", "lights.lamp_3.intensity")]


def test_fields_are_set_keyed_and_reset_like_values(session):
    session.apply(SetValue(INTENSITY, 4.0))
    assert of(session)["lamp_1"].intensity == 4.0
    session.apply(SetKey(INTENSITY))
    session.apply(SetValue(INTENSITY, 6.0))
    assert session.graph.animation[INTENSITY].evaluate(1) == 6.0
    session.apply(ResetValue(INTENSITY))
    assert of(session)["lamp_1"].intensity == 10.0 and not session.graph.animation
    session.apply(SetValue(Port("lamps", "lights.lamp_1.kind"), "sun"))
    assert of(session)["lamp_1"] == LAMPS[1], "an intensity that was not set is that of the new kind"


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        (AddItem(LIGHTS, "laser"), "'laser' is no kind of light: it takes point, spot"),
        (AddItem(LIGHTS, "spot", name="lamp_1"), "a light called 'lamp_1' already exists"),
        (AddItem(LIGHTS, "spot", name="a.b"), "a light cannot be called 'a.b'"),
        (RemoveItem(LIGHTS, "lamp_9"), "'lamps.lights' has no light 'lamp_9'"),
        (RenameItem(LIGHTS, "lamp_1", "lamp_2"), "a light called 'lamp_2' already exists"),
        (ExchangeItems(LIGHTS, "lamp_1", "lamp_7"), "'lamps.lights' has no light 'lamp_7'"),
        (RenameItem(LIGHTS, "lamp_1", ""), "the name of a light cannot be empty"),
    ],
)
def test_what_cannot_be_is_said(session, command, sentence):
    before = session.graph
    with pytest.raises(GraphError) as error:
        session.apply(command)
    assert sentence in str(error.value) and session.graph == before


def test_a_full_list_takes_no_more(session):
    session.apply(SetValue(LIGHTS, number_lights((Light(),) * MAX_LIGHTS)))
    with pytest.raises(GraphError, match="there is no room for another light"):
        session.apply(DuplicateItem(LIGHTS, "lamp_1"))


def test_two_people_change_two_fields_of_one_light():
    base = Graph().add("lamps", Lamps(lights=number_lights(LAMPS)))
    ours, theirs = base.override("lamps.lamp_1.intensity", 2), base.override("lamps.lamp_1.color", (1, 0, 0))
    theirs = theirs.override("lamps.lamp_2.intensity", 5)
    merge = merge_graphs(base, ours, theirs)
    lights = lights_of(loads(merge.text, catalogue=TOYS, sandbox=UNRESTRICTED).value(LIGHTS))
    assert not merge.conflicts
    assert lights == (Light(intensity=2.0, color=(1.0, 0.0, 0.0)), Light(LightKind.SUN, intensity=5.0))


def test_two_people_change_one_field_of_one_light():
    base = Graph().add("lamps", Lamps(lights=number_lights(LAMPS)))
    merge = merge_graphs(base, base.override("lamps.lamp_1.intensity", 2), base.override("lamps.lamp_1.intensity", 3))
    (conflict,) = merge.conflicts
    assert conflict.at == ("nodes", "lamps", "values", "lights", "lamp_1", "intensity")


def test_a_difference_names_the_light_and_the_field():
    base = Graph().add("lamps", Lamps(lights=number_lights(LAMPS)))
    after = base.override("lamps.lamp_1.exposure", 2)
    after = after.put(LIGHTS, after.value(LIGHTS).without_item("lamp_2").with_item("rim", item_of(Light(size=0.3))))
    lines = describe_difference(compare_graphs(base, after), base, after)
    assert [f"{line.sign} {line.words}" for line in lines] == [
        "~ lamps.lights.lamp_1.exposure: 0 EV (default) -> 2 EV",
        "- light lamps.lights.lamp_2: sun",
        "+ light lamps.lights.rim: point",
    ]


def test_a_group_shows_a_field_of_a_light():
    inner = Graph().add("lamps", Lamps(lights=number_lights(LAMPS)))
    graph = Graph().add(
        "group", Group(inner.add_control("key", Control(INTENSITY)).add_control("all", Control(LIGHTS)))
    )
    for path in ("group.key", "group.lamps.lamp_1.intensity", "group.all.lamp_1.intensity"):
        changed = graph.override(path, 4)
        body = changed.nodes["group"].body()
        assert lights_of(body.value(LIGHTS))[0].intensity == 4.0, path
        text = dumps(changed)
        assert loads(text, catalogue=TOYS, sandbox=UNRESTRICTED) == changed and dumps(changed) == text
