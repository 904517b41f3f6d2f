"""Select lets one picture through: the others are not in the plan."""

from __future__ import annotations

import numpy as np
import pytest
from halation.compiler import Request, compile_graph
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Output, Port, Settings, problems
from halation.nodes import Kind
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.merge.select import Select
from halation.resources.picture import Picture
from headers import Headers


def make_graph(**values: object) -> Graph:
    """The input `beauty` as it is, blurred, and brighter, into a selection."""
    graph = Graph(settings=Settings((64, 48))).add_input("beauty", Input(Kind.IMAGE, 4)).add("pick", Select(**values))
    graph = graph.add("soft", GaussianBlur(sigma=9.0)).add("bright", Exposure(stops=1.0))
    for node in ("soft", "bright"):
        graph = graph.connect(Port("inputs", "beauty"), Port(node, "image"))
    for socket, source in (("a", Port("inputs", "beauty")), ("b", Port("soft", "out")), ("c", Port("bright", "out"))):
        graph = graph.connect(source, Port("pick", socket))
    return graph.add_output("out", Output(Kind.IMAGE, 4)).connect(Port("pick", "out"), Port("outputs", "out"))


@pytest.mark.parametrize(("which", "nodes"), [(1, set()), (2, {"soft"}), (3, {"bright"})])
def test_what_is_not_chosen_is_not_planned(which, nodes):
    picture = Picture("beauty", "", Kind.IMAGE, 4, in_memory=True)
    plan = compile_graph(make_graph(which=which), Request(bindings={"beauty": picture}), Headers((64, 48)))
    assert {node for step in plan.passes for node in step.nodes} - {"outputs.out", "inputs.beauty"} == nodes


def test_the_chosen_picture_comes_through(run, hdr):
    picture = hdr(64, 48)
    np.testing.assert_array_equal(run(make_graph(which=1), {"beauty": picture}), picture)
    bright = run(make_graph(which=3), {"beauty": picture})
    np.testing.assert_array_equal(bright, run(Exposure(stops=1.0), {"image": picture}))
    assert not run(make_graph(which=7), {"beauty": picture}).any()


def test_pictures_keep_their_size(run, hdr):
    small, large = hdr(20, 10), hdr(50, 30)
    np.testing.assert_array_equal(run(Select(which=2), {"a": small, "b": large}), large)
    np.testing.assert_array_equal(run(Select(which=1), {"a": small, "b": large}), small)


@pytest.mark.parametrize("which", range(1, 9))
def test_a_measured_number_chooses_too(run, which):
    pictures = {name: np.full((6, 8, 4), number + 1.0, np.float32) for number, name in enumerate("abcdefgh")}
    numbers = {"which": np.full((6, 8), float(which), np.float32)}
    out = run(Select(), pictures | numbers)
    np.testing.assert_array_equal(out, float(which))


NAMES = "day, night,, day off"


def plan_nodes(graph: Graph) -> set[str]:
    """The nodes that the plan of a graph draws."""
    picture = Picture("beauty", "", Kind.IMAGE, 4, in_memory=True)
    plan = compile_graph(graph, Request(bindings={"beauty": picture}), Headers((64, 48)))
    return {node for step in plan.passes for node in step.nodes} - {"outputs.out", "inputs.beauty"}


@pytest.mark.parametrize(
    ("choice", "nodes"), [("day", set()), ("night", {"soft"}), ("2", {"soft"}), ("3", {"bright"}), ("", {"bright"})]
)
def test_what_is_chosen_by_name_alone_is_planned(choice, nodes):
    assert plan_nodes(make_graph(names=NAMES, choice=choice, which=3)) == nodes


def test_a_name_or_a_number_is_set(run, hdr):
    graph, picture = make_graph(names=NAMES), hdr(64, 48)
    assert plan_nodes(graph.override("pick.choice", "night")) == {"soft"}
    assert plan_nodes(graph.override("pick.choice", 3)) == {"bright"}
    night = run(graph.override("pick.choice", "night"), {"beauty": picture})
    np.testing.assert_array_equal(night, run(make_graph(which=2), {"beauty": picture}))


def test_an_unknown_name_is_refused():
    graph = make_graph(names=NAMES)
    sentence = "pick.choice: 'nite' is not a choice: it takes one of day, night, day off, or a number up to 8"
    for wrong in ("nite", "9", "0", "02"):
        with pytest.raises(GraphError, match=sentence.replace("nite", wrong)):
            graph.override("pick.choice", wrong)
    with pytest.raises(GraphError, match="it takes a name in 'names', which lists none"):
        make_graph().override("pick.choice", "night")
    assert [problem.sentence for problem in problems(make_graph(names=NAMES, choice="nite"))] == [sentence]


def test_a_control_is_a_list_of_the_names():
    graph = make_graph(names=NAMES, choice="night").add_control("time", Control(Port("pick", "choice"), "Time"))
    declared = Group(graph).signature.values["time"]
    assert (declared.type, declared.choices, declared.default) == ("choice", ("", "day", "night", "day off"), "night")
    assert plan_nodes(graph.override("time", "day")) == set()
    with pytest.raises(GraphError, match="'noon' is not a choice"):
        graph.override("time", "noon")
