"""Values that change over time: what a graph is at a frame, and what edits do to keys and expressions."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from halation import document
from halation.errors import DocumentError, GraphError
from halation.graph import (
    Control,
    Expression,
    Graph,
    Group,
    Key,
    Keys,
    Output,
    Port,
    Settings,
    evaluate_at_frame,
    find_key_range,
    is_animated,
    problems,
    value_at,
)
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.grade import Grade
from halation.nodes.distort.transform import Transform
from halation.resources.sandbox import UNRESTRICTED

STOPS, GAIN, MOVE = Port("light", "stops"), Port("grade", "gain"), Port("move", "position")
RISING = Keys((Key(1, 0.0, "linear"), Key(11, 5.0)))


@pytest.fixture
def graph() -> Graph:
    made = Graph(settings=Settings(frames=(1, 24), rate=12.0))
    for name, node in (("light", Exposure()), ("grade", Grade()), ("move", Transform()), ("blur", GaussianBlur())):
        made = made.add(name, node)
    return made.add_control("glow", Control(Port("blur", "sigma")))


def at(graph: Graph, port: Port, frame: int) -> object:
    return getattr(evaluate_at_frame(graph, frame).nodes[port.node], port.socket)


def faults(graph: Graph) -> list[str]:
    return [problem.sentence for problem in problems(graph) if problem.severity == "error"]


def test_keys_and_expressions_make_values(graph):
    graph = graph.animate(STOPS, RISING).animate(MOVE, Expression("[light.stops * 2, glow]"))
    assert [at(graph, STOPS, frame) for frame in (-3, 1, 3, 11, 20)] == [0.0, 0.0, 1.0, 5.0, 5.0]
    assert at(graph, MOVE, 3) == (2.0, graph.value(Port("blur", "sigma")))
    assert value_at(graph, MOVE, 11) == (10.0, graph.value(Port("blur", "sigma")))
    assert is_animated(graph) and not is_animated(evaluate_at_frame(graph, 3)) and find_key_range(graph) == (1, 11)


def test_time_is_in_seconds_since_the_first_frame(graph):
    graph = graph.animate(STOPS, Expression("time + rate / 100"))
    assert [at(graph, STOPS, frame) for frame in (1, 13, 25)] == pytest.approx([0.12, 1.12, 2.12])


def test_values_keep_their_type_and_range(graph):
    """One number does for all channels; a whole number is rounded; what leaves the hard range stays at its end."""
    graph = graph.animate(GAIN, Expression("frame")).animate(Port("blur", "sigma"), Expression("-5"))
    assert at(graph, GAIN, 2) == (2.0, 2.0, 2.0, 2.0)
    assert at(graph, Port("blur", "sigma"), 2) == 0.0
    whole = graph.animate(STOPS, Keys((Key(1, 1, "linear"), Key(2, 2))))
    assert whole.animation[STOPS].keys[0].value == 1.0 and isinstance(whole.animation[STOPS].keys[0].value, float)


@pytest.mark.parametrize(
    ("port", "animation", "said"),
    [
        (Port("light", "nothing"), RISING, "no value 'nothing'"),
        (Port("nobody", "stops"), RISING, "no node 'nobody'"),
        (STOPS, Keys(()), "there are no keys"),
        (STOPS, Keys((Key(1, (1.0, 2.0)),)), "light.stops at frame 1"),
        (Port("blur", "edge"), Keys((Key(1, 1.0),)), "a choice cannot change over time"),
        (STOPS, Expression("1 +"), "light.stops"),
    ],
)
def test_what_cannot_be(graph, port, animation, said):
    with pytest.raises(GraphError, match=said):
        graph.animate(port, animation)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nobody.x", "no node 'nobody'"),
        ("gloww", "did you mean 'glow'"),
        ("grade.gain.q", "no channel 'q'"),
        ("light.stops", "depends on itself"),
        ("blur.edge", "is no number|is a choice"),
    ],
)
def test_names_that_mean_nothing_are_problems(graph, text, said):
    found = faults(graph.animate(STOPS, Expression(text)))
    assert len(found) == 1 and re.search(said, found[0]), found


def test_a_circle_of_expressions(graph):
    graph = graph.animate(STOPS, Expression("grade.gain.r")).animate(GAIN, Expression("light.stops"))
    assert len([said for said in faults(graph) if "depends on itself" in said]) == 2
    with pytest.raises(GraphError, match="depends on itself"):
        evaluate_at_frame(graph, 1)


def test_an_expression_without_a_value_says_where_and_when(graph):
    graph = graph.animate(STOPS, Expression("1 / (frame - 3)"))
    with pytest.raises(GraphError, match=r"light\.stops at frame 3"):
        evaluate_at_frame(graph, 3)


def test_renaming_moves_keys_and_names(graph):
    graph = graph.animate(STOPS, RISING).animate(MOVE, Expression("[light.stops, glow]"))
    renamed = graph.rename("light", "lamp").rename_control("glow", "soft")
    assert renamed.animation == {
        Port("lamp", "stops"): RISING,
        MOVE: Expression("[lamp.stops, soft]"),
    }
    assert not faults(replace(renamed, outputs={"x": Output()}, links={Port("outputs", "x"): Port("light", "out")}))[1:]


def test_removing_and_replacing(graph):
    graph = graph.animate(STOPS, RISING).animate(GAIN, Expression("1"))
    assert graph.remove("light").animation.keys() == {GAIN}
    assert graph.replace("light", Exposure(stops=2.0)).animation.keys() == {STOPS, GAIN}
    assert graph.replace("light", GaussianBlur()).animation.keys() == {GAIN}


def test_setting_a_value_ends_its_animation(graph):
    assert graph.animate(STOPS, RISING).set(STOPS, 2.0).animation == {}
    assert graph.set(STOPS, RISING).animation == {STOPS: RISING}
    assert graph.animate(STOPS, RISING).animate(STOPS, None).value(STOPS) == 0.0


def test_groups_live_in_the_same_time(graph):
    """A group's body has animation of its own; what the group itself sets or animates comes first."""
    body = graph.animate(Port("blur", "sigma"), Keys((Key(1, 1.0, "linear"), Key(11, 11.0)))).animate(STOPS, RISING)
    outer = Graph(settings=Settings(frames=(5, 9))).add("group", Group(body))
    inner = evaluate_at_frame(outer, 3).nodes["group"].graph
    assert inner.value(Port("blur", "sigma")) == 3.0 and inner.value(STOPS) == 1.0
    for way, expected in ((7.0, 7.0), (Expression("frame * 2"), 6.0)):
        made = evaluate_at_frame(outer.set(Port("group", "glow"), way), 3).nodes["group"].graph
        assert (made.value(Port("blur", "sigma")), made.value(STOPS)) == (expected, 1.0)
    assert find_key_range(outer) == (1, 11)


def test_the_document_keeps_it(graph):
    bent, held = Key(1, 0.0, "bezier", right=(2.0, 0.5)), Key(4.5, 2.0, "constant")
    keys = Keys((bent, held, Key(8, 1.0, left=(-1.0, 0.0))), "loop")
    graph = graph.animate(STOPS, keys).animate(MOVE, Expression("[frame, 2]"))
    text = document.dumps(graph)
    again = document.loads(text, sandbox=UNRESTRICTED)
    assert again.animation == graph.animation and again.settings == graph.settings and document.dumps(again) == text
    assert '{"frame": 1, "interpolation": "bezier", "right": [2.0, 0.5], "value": 0.0}' in text
    assert '"frames": [1, 24]' in text and '"rate": 12.0' in text


@pytest.mark.parametrize(
    ("entry", "where"),
    [
        ('{"keys": [{"frame": 1}]}', r"animation.light.stops.keys\[0\]"),
        ('{"keys": [{"frame": 1, "value": "x"}]}', r"keys\[0\].value"),
        ('{"keys": [{"frame": 2, "value": 1}, {"frame": 1, "value": 1}]}', "list the keys by frame"),
        ('{"keys": [{"frame": 1, "value": 1, "left": [1]}]}', r"keys\[0\].left"),
        ('{"keys": [{"frame": 1, "value": 1, "interpolation": "soft"}]}', "interpolation"),
        ('{"keys": [], "expression": "1"}', 'either "keys" or an "expression"'),
        ("{}", 'either "keys" or an "expression"'),
        ("3", "animation.light.stops"),
        ('{"keys": [{"frame": 1e999, "value": 1}]}', "animation"),
    ],
)
def test_documents_at_fault_are_named(entry, where):
    text = f'{{"halation": 1, "nodes": {{"light": {{"type": "exposure"}}}}, "animation": {{"light.stops": {entry}}}}}'
    with pytest.raises(DocumentError, match=where):
        document.loads(text, sandbox=UNRESTRICTED)


def test_animation_of_what_is_unknown_is_kept(graph):
    text = document.dumps(
        document.loads(
            '{"halation": 1, "nodes": {"odd": {"type": "from_the_future"}}, '
            '"animation": {"odd.x": {"keys": [{"frame": 1, "value": 3}], "later": true}}}',
            sandbox=UNRESTRICTED,
        )
    )
    assert (
        '"later": true' in text
        and '"value": 3' in text
        and document.loads(text, sandbox=UNRESTRICTED).nodes["odd"] is not None
    )
    assert not [
        p for p in problems(document.loads(text, sandbox=UNRESTRICTED)) if p.severity == "error" and p.socket == "x"
    ]
