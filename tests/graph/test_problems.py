"""Problems name node and socket and say what to do; a sound graph has none."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable
from random import Random
from types import FrameType

import pytest
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Output, Port, Problem, Settings, Unknown, problems, rules
from halation.graph.unmerged import find_unmerged
from halation.nodes import Kind
from hypothesis import given, settings
from hypothesis import strategies as st
from toy_nodes import TOYS, Gain, Photo, Slope, Soften, chain, random_graph, small


def found(graph: Graph) -> list[tuple[str, str, str]]:
    return [(problem.severity, problem.node, problem.socket) for problem in problems(graph, TOYS)]


def only(graph: Graph) -> Problem:
    (problem,) = problems(graph, TOYS)
    return problem


def changed(graph: Graph, **fields: object) -> Graph:
    return dataclasses.replace(graph, **fields)


def linked(graph: Graph, target: str, source: str) -> Graph:
    return changed(graph, links={**graph.links, Port.parse(target): Port.parse(source)})


def test_a_sound_graph_has_none() -> None:
    assert problems(small()) == ()
    assert problems(chain(50)) == ()


def test_an_unbound_input_is_none() -> None:
    assert problems(changed(small(), inputs={"beauty": Input()})) == ()


@pytest.mark.parametrize(
    ("source", "says"),
    [
        ("gian.out", "there is no node 'gian'; did you mean 'gain'?"),
        ("gain.uot", "node 'gain' has no output 'uot'; did you mean 'out'?"),
        ("inputs.beuty", "the graph has no input 'beuty'; did you mean 'beauty'?"),
        ("slope.normal", "a Vector3 does not fit an Image: put 'separate_vector' and 'combine' between them"),
        ("slope.flow", "a Vector2 does not fit an Image: put 'separate_vector2' and 'combine' between them"),
    ],
)
def test_links_from_nowhere_or_of_the_wrong_kind(source: str, says: str) -> None:
    graph = linked(small().add_input("z", Input(Kind.FIELD)).add("slope", Slope()), "soften.image", source)
    assert only(linked(graph, "slope.depth", "inputs.z")) == Problem(
        "soften", "image", f"'{source}' cannot feed 'soften.image': {says}", rules.BAD_LINK
    )


@pytest.mark.parametrize(
    ("target", "says"),
    [
        ("gian.image", "there is no node 'gian'; did you mean 'gain'?"),
        ("gain.imag", "node 'gain' has no input 'imag'; did you mean 'image'?"),
        ("outputs.imge", "the graph has no output 'imge'; did you mean 'image'?"),
        ("soften.sigma", "'soften.sigma' can only be set: only values of pointwise nodes can be wired"),
    ],
)
def test_links_to_nowhere(target: str, says: str) -> None:
    problem = only(linked(small(), target, "inputs.beauty"))
    assert (f"{problem.node}.{problem.socket}", problem.severity) == (target, "error")
    assert problem.sentence == f"'inputs.beauty' cannot feed '{target}': {says}"


def test_loops_are_named_and_order_refuses_them() -> None:
    graph = linked(linked(chain(9), "n1.image", "n3.out"), "n5.image", "n6.out")
    sentences = [problem.sentence for problem in problems(graph, TOYS)]
    assert sorted(sentences) == sorted(
        {
            "the nodes n1 -> n2 -> n3 -> n1 form a loop; remove one of these links",
            "the nodes n5 -> n6 -> n5 form a loop; remove one of these links",
        }
    )
    with pytest.raises(GraphError, match="form a loop"):
        graph.order()
    assert found(linked(small(), "gain.image", "gain.out")) == [("error", "gain", "")]


def test_a_missing_input_is_an_error_only_where_it_matters() -> None:
    loose = small().add("loose", Soften())
    sentence = "'loose.image' is not linked: it needs an Image"
    assert only(loose) == Problem("loose", "image", sentence, rules.UNFINISHED_NODE)
    assert found(small().disconnect(Port("gain", "image"))) == [("error", "gain", "image")]
    assert only(small().add("slope", Slope())).sentence.endswith("it needs a Field")


@pytest.mark.parametrize(
    ("values", "name", "says"),
    [
        ({"gain": 99.0}, "gain", "99.0 is outside the range 0 to 16"),
        ({"gain": float("nan")}, "gain", "nan is not a finite number"),
        ({"gain": "much"}, "gain", "'much' does not fit: it takes a number"),
        ({"mode": "soft"}, "mode", "'soft' is not a choice: it takes one of add, soft light"),
        ({"steps": 1.5}, "steps", "1.5 does not fit: it takes a whole number"),
        ({"tint": (1.0,)}, "tint", "(1.0,) does not fit: it takes a list of 4 numbers"),
    ],
)
def test_values(values: dict[str, object], name: str, says: str) -> None:
    graph = changed(small(), nodes={**small().nodes, "gain": Gain(**values)})
    assert only(graph) == Problem("gain", name, f"gain.{name}: {says}", rules.BAD_VALUE)


@pytest.mark.parametrize(
    ("target", "says"),
    [
        ("gian.gain", "there is no node 'gian'; did you mean 'gain'?"),
        ("gain.gian", "node 'gain' has no value 'gian'; did you mean 'gain'?"),
        ("gain.image", "node 'gain' has no value 'image'"),
    ],
)
def test_controls_that_point_nowhere(target: str, says: str) -> None:
    problem = only(changed(small(), controls={"glow": Control(Port.parse(target))}))
    assert (problem.node, problem.socket) == ("controls", "glow")
    assert problem.sentence.startswith(f"control 'glow' points at '{target}': {says}")


def test_ends() -> None:
    problem = only(small().disconnect(Port("outputs", "image")))
    sentence = "nothing feeds the output 'image': link a node to 'outputs.image'"
    assert problem == Problem("outputs", "image", sentence, rules.UNFED_OUTPUT)
    assert found(Graph()) == [("warning", "", "")]
    for default in ((1.0, 2.0), float("inf"), "red"):
        assert found(changed(small(), inputs={"beauty": Input(default=default)})) == [("error", "inputs", "beauty")]
    assert found(changed(small(), inputs={"beauty": Input(default=(1.0, 0.0, 0.0, 1.0))})) == []
    assert found(changed(small(), inputs={"beauty": Input(default=0)})) == []


def test_unknown_types() -> None:
    graph = small().add("x", Unknown("sofen", {})).connect(Port("x", "anything"), Port("soften", "image"))
    sentence = "node 'x' has the unknown type 'sofen'; did you mean 'soften'?"
    assert only(graph) == Problem("x", "", sentence, rules.UNKNOWN_TYPE)


def test_leftover_keys_are_mentioned() -> None:
    graph = changed(small(), extra={"nodes.gain.values": {"gian": 2}, "": {"author": "me"}})
    assert [(problem.severity, problem.node, problem.sentence) for problem in problems(graph)] == [
        ("warning", "", "author means nothing to this version and is only kept"),
        (
            "warning",
            "gain",
            "nodes.gain.values.gian means nothing to this version and is only kept; did you mean 'gain'?",
        ),
    ]


def test_a_leftover_key_is_not_its_own_suggestion() -> None:
    graph = changed(small(), extra={"nodes.gain": {"version": 3, "verson": 3}})
    assert [problem.sentence for problem in problems(graph)] == [
        "nodes.gain.version means nothing to this version and is only kept",
        "nodes.gain.verson means nothing to this version and is only kept; did you mean 'version'?",
    ]


def test_groups_say_where() -> None:
    body = linked(small(), "soften.image", "nobody.out").set(Port("gain", "gain"), 3)
    graph = small().add("g", Group(Graph({"h": Group(body)}), values={"x": 1.0}))
    assert found(graph) == [
        ("error", "g", "x"),
        ("error", "g/h/soften", "image"),
        ("warning", "g", ""),
    ]
    assert "in group 'g': in group 'h': 'nobody.out' cannot feed" in problems(graph, TOYS)[1].sentence


def test_values_of_groups_are_checked() -> None:
    graph = changed(small(), inputs={"beauty": Input()})
    links = {Port("outputs", "o"): Port("g", "image")}
    graph = Graph({"g": Group(graph, values={"glow": 99.0})}, links, outputs={"o": Output()})
    assert found(graph) == [("error", "g", "beauty"), ("error", "g", "glow")]


def test_groups_may_not_nest_for_ever() -> None:
    graph = small()
    for _ in range(40):
        graph = Graph({"g": Group(graph)})
    assert any("nest deeper than 32" in problem.sentence for problem in problems(graph, TOYS))


def test_names_that_a_file_could_not_hold() -> None:
    control = Control(Port("a.b", "path"))
    graph = Graph({"a.b": Photo()}, {}, {"": Input()}, {"x/y": Output()}, {"c.d": control})
    assert {(node, socket) for _, node, socket in found(graph)} >= {
        ("a.b", ""),
        ("inputs", ""),
        ("outputs", "x/y"),
        ("controls", "c.d"),
    }


@settings(max_examples=40)
@given(st.integers(0, 2**32))
def test_every_sentence_is_one_line_and_names_its_place(seed: int) -> None:
    for problem in problems(random_graph(Random(seed)), TOYS):
        assert "\n" not in problem.sentence
        assert problem.node.rpartition("/")[2] in problem.sentence or problem.node in ("outputs", "controls", "inputs")
        assert not problem.socket or problem.socket in problem.sentence


@pytest.mark.parametrize("work", [Graph.order, problems], ids=["order", "problems"])
def test_four_times_the_nodes_take_about_four_times_the_work(work: Callable[[Graph], object]) -> None:
    def count_opcodes(length: int) -> int:
        """How many instructions of the interpreter it takes: the same on every machine, however busy that is."""
        graph, count = chain(length), 0

        def trace(frame: FrameType, event: str, _: object) -> Callable[..., object]:
            nonlocal count
            frame.f_trace_opcodes, frame.f_trace_lines = True, False
            count += event == "opcode"
            return trace

        before = sys.gettrace()
        sys.settrace(trace)
        try:
            work(graph)
        finally:
            sys.settrace(before)
        return count

    assert 3.5 * count_opcodes(500) < count_opcodes(2000) < 4.5 * count_opcodes(500)


def test_ten_thousand_nodes_in_a_row() -> None:
    graph = chain(10_000)
    assert graph.order() == tuple(f"n{index}" for index in range(10_000))
    assert len(graph.upstream("outputs")) == 10_000
    assert problems(graph) == ()
    assert "form a loop" in problems(linked(graph, "n0.image", "n9999.out"), TOYS)[0].sentence


@pytest.mark.parametrize(
    ("keys", "node", "socket"),
    [
        ("nodes a", "a", ""),
        ("nodes a values stops", "a", "stops"),
        ("nodes a code", "a", ""),
        ("links a.image", "a", "image"),
        ("animation a.stops", "a", "stops"),
        ("inputs beauty", "inputs", "beauty"),
        ("outputs image file", "outputs", "image"),
        ("settings size", "", ""),
        ("nodes g graph", "g", ""),
        ("nodes g graph inputs", "g/inputs", ""),
        ("nodes g graph settings", "g", ""),
        ("nodes g graph links a.image", "g/a", "image"),
        ("nodes g graph nodes a values stops", "g/a", "stops"),
        ("nodes g graph nodes h graph nodes a values stops", "g/h/a", "stops"),
        ("nodes g graph nodes h graph controls glow", "g/h/controls", "glow"),
    ],
)
def test_conflicts_are_shown_at_their_nodes(keys: str, node: str, socket: str) -> None:
    """In groups within groups, too: the problem is of the node that a user must open."""
    entry = {"at": tuple(keys.split()), "ours": 1, "theirs": 2}
    (found,) = find_unmerged({"": {"conflicts": (entry,)}})
    assert found[:2] == (node, socket) and found[3] == keys.replace(" ", ".")
    assert "ours has 1, theirs has 2" in found[2]


@pytest.mark.parametrize(("size", "says"), [((131_072, 1), []), ((1, 131_073), ["a canvas of 1x131073 pixels"])])
def test_a_canvas_has_sides_that_pictures_have(size: tuple[int, int], says: list[str]) -> None:
    graph = dataclasses.replace(Graph(), settings=Settings(size=size))
    faults = [problem for problem in problems(graph) if problem.rule is rules.HUGE_CANVAS]
    assert [problem.sentence[: len("a canvas of 1x131073 pixels")] for problem in faults] == says
