"""Edits: each returns a new graph, follows what it moves, and refuses what makes no sense."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from random import Random

import numpy as np
import pytest
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Output, Port, Unknown, conversion, problems, signature
from halation.nodes import Kind
from hypothesis import given, settings
from hypothesis import strategies as st
from toy_nodes import TOYS, Blend, Flow, Gain, Meter, Slope, Soften, Split, chain, random_edit, random_graph, small


def check_invariants(graph: Graph) -> None:
    """What no edit may break, said without the graph's own checks where that is possible."""
    for target, source in graph.links.items():
        start, end = graph.source(source), graph.target(target)
        assert start is None or end is None or conversion(start, end) is None
    place = {id: index for index, id in enumerate(graph.order())}
    assert set(place) == set(graph.nodes)
    for target, source in graph.links.items():
        if source.node != "inputs" and target.node != "outputs":
            assert place[source.node] < place[target.node]
    for control in graph.controls.values():
        face = signature(graph.nodes[control.target.node])
        assert face.anything or control.target.socket in face.values
    assert graph.muted <= set(graph.nodes)
    assert set(graph.ui.get("nodes", {})) <= set(graph.nodes)
    for path in graph.extra:
        section, _, name = path.partition(".")
        assert not name or name.removesuffix(".values") in getattr(graph, section)


@settings(max_examples=60)
@given(st.integers(0, 2**32))
def test_edits_keep_a_graph_sound(seed: int) -> None:
    rng = Random(seed)
    graph = dataclasses.replace(random_graph(rng), ui={"nodes": {"n": 1, "m": 2}}, extra={"nodes.n": {"later": 1}})
    graph = graph if {"n", "m"} <= set(graph.nodes) else dataclasses.replace(graph, ui={}, extra={"": {"later": 1}})
    for _ in range(40):
        before = (dict(graph.nodes), dict(graph.links))
        after = random_edit(rng, graph)
        assert (dict(graph.nodes), dict(graph.links)) == before
        check_invariants(after)
        graph = after
    kinds = {(problem.severity, problem.sentence.partition(" ")[0]) for problem in problems(graph, TOYS)}
    assert not {start for severity, start in kinds if severity == "error"} & {"the"}, "no loops, no dead controls"


def test_a_graph_cannot_be_changed_in_place() -> None:
    graph = small()
    for mapping in (graph.nodes, graph.links, graph.inputs, graph.outputs, graph.controls, graph.ui, graph.ui["nodes"]):
        with pytest.raises(TypeError):
            mapping["x"] = 1
    assert graph == small()
    assert Graph(folder="a") == Graph(folder="b")


@pytest.mark.parametrize("name", ["", "a.b", "a/b", "inputs", "outputs", "a\nb"])
def test_names_that_no_node_may_have(name: str) -> None:
    with pytest.raises(GraphError):
        Graph().add(name, Gain())
    with pytest.raises(GraphError):
        small().rename("gain", name)


def test_fresh_ids_count_up() -> None:
    graph = Graph().add("n", Gain()).add("n2", Gain())
    assert graph.fresh_id("n") == "n3"
    assert graph.fresh_id("m") == "m"
    assert graph.fresh_id("inputs") == "inputs2"


def test_adding_twice_is_refused() -> None:
    with pytest.raises(GraphError, match="'gain' already exists"):
        small().add("gain", Gain())


class TestRemove:
    def test_heal_links_what_fed_it_to_what_it_fed(self) -> None:
        graph = small().remove("gain")
        assert dict(graph.links) == {
            Port("soften", "image"): Port("inputs", "beauty"),
            Port("outputs", "image"): Port("soften", "out"),
        }
        assert not graph.controls
        assert set(graph.ui["nodes"]) == {"soften"}

    def test_without_heal_the_ends_stay_loose(self) -> None:
        assert dict(small().remove("gain", heal=False).links) == {Port("outputs", "image"): Port("soften", "out")}

    def test_heal_takes_the_first_input_that_fits(self) -> None:
        """`by` of flow is no image and comes second; a Field output can only be fed by a Field."""
        graph = Graph(inputs={"flow": Input(Kind.VECTOR, 2), "image": Input(), "depth": Input(Kind.FIELD)})
        graph = graph.add("flow", Flow()).add("soften", Soften()).add("split", Split()).add("slope", Slope())
        graph = graph.connect(Port("inputs", "flow"), Port("flow", "by"))
        graph = graph.connect(Port("inputs", "image"), Port("flow", "image"))
        graph = graph.connect(Port("flow", "out"), Port("soften", "image"))
        graph = graph.connect(Port("inputs", "image"), Port("split", "image"))
        graph = graph.connect(Port("split", "grey"), Port("slope", "depth"))
        assert graph.remove("flow").links[Port("soften", "image")] == Port("inputs", "image")
        assert graph.remove("flow").remove("soften").links.keys() == {Port("split", "image"), Port("slope", "depth")}
        assert Port("slope", "depth") not in graph.remove("split").links, "an image is no field"

    def test_heal_feeds_every_reader(self) -> None:
        graph = chain(2).add("b", Blend()).connect(Port("n0", "out"), Port("b", "first"))
        graph = graph.connect(Port("n0", "out"), Port("b", "second")).remove("n0")
        ends = {Port("n1", "image"), Port("b", "first"), Port("b", "second")}
        assert {target for target, source in graph.links.items() if source == Port("inputs", "beauty")} == ends

    def test_unknown_nodes_heal_too(self) -> None:
        graph = chain(3)
        graph = graph.replace("n1", Unknown("lens", {}))
        assert graph.links == chain(3).links
        assert graph.remove("n1").links[Port("n2", "image")] == Port("n0", "out")

    def test_of_what_is_not_there(self) -> None:
        with pytest.raises(GraphError, match="no node 'sofen'; did you mean 'soften'"):
            small().remove("sofen")


class TestConnect:
    def test_takes_the_place_of_the_old_link(self) -> None:
        graph = small().connect(Port("inputs", "beauty"), Port("soften", "image"))
        assert graph.links[Port("soften", "image")] == Port("inputs", "beauty")
        assert len(graph.links) == 3

    def test_refuses_and_names_a_loop(self) -> None:
        with pytest.raises(GraphError, match=r"'n3\.out' cannot feed 'n1\.image'.*n1 -> n2 -> n3 -> n1 form a loop"):
            chain(5).connect(Port("n3", "out"), Port("n1", "image"))
        with pytest.raises(GraphError, match="n1 -> n1 form a loop"):
            chain(5).connect(Port("n1", "out"), Port("n1", "image"))

    @pytest.mark.parametrize(
        ("source", "target", "says"),
        [
            ("slope.normal", "gain.image", "a Vector3 does not fit an Image.*'separate_vector' and 'combine'"),
            ("inputs.beauty", "slope.depth", "an Image does not fit a Field.*'luminance'"),
            ("inputs.beauty", "soften.sigma", "only values of pointwise nodes can be wired"),
            ("inputs.beauty", "gain.mode", "a choice cannot be wired"),
            ("slope.normal", "gain.center", "a Vector3 does not fit a vector value.* Field or Number or Vector2"),
            ("slope.norml", "gain.center", "no output 'norml'; did you mean 'normal'"),
            ("slope.normal", "gian.center", "no node 'gian'; did you mean 'gain'"),
            ("inputs.beuty", "gain.image", "no input 'beuty'; did you mean 'beauty'"),
            ("inputs.beauty", "outputs.imgae", "no output 'imgae'; did you mean 'image'"),
            ("inputs.beauty", "gain.imag", "no input 'imag'; did you mean 'image'"),
            ("slope.normal", "flow.by", "a Vector3 does not fit a Vector2.*'separate_vector' and 'combine_vector2'"),
        ],
    )
    def test_refuses_what_does_not_fit(self, source: str, target: str, says: str) -> None:
        graph = small().add("slope", Slope()).add("flow", Flow())
        with pytest.raises(GraphError, match=f"'{source}' cannot feed '{target}'.*{says}"):
            graph.connect(Port.parse(source), Port.parse(target))

    def test_a_measured_number_drives_a_value(self) -> None:
        graph = small().add("meter", Meter()).connect(Port("inputs", "beauty"), Port("meter", "image"))
        graph = graph.connect(Port("meter", "mean"), Port("gain", "gain"))
        assert graph.order().index("meter") < graph.order().index("gain")

    def test_disconnect(self) -> None:
        assert Port("gain", "image") not in small().disconnect(Port("gain", "image")).links
        with pytest.raises(GraphError, match=r"nothing is linked to 'gain\.tint'"):
            small().disconnect(Port("gain", "tint"))


class TestSet:
    def test_keeps_the_type(self) -> None:
        graph = small().set(Port("gain", "gain"), 3).set(Port("gain", "tint"), [1, 0, 0, 1])
        assert graph.nodes["gain"] == Gain(gain=3.0, tint=(1.0, 0.0, 0.0, 1.0))
        assert isinstance(graph.value(Port("gain", "gain")), float)

    @pytest.mark.parametrize(
        ("name", "value", "says"),
        [
            ("gain", 17.0, "17.0 is outside the range 0 to 16"),
            ("gain", float("nan"), "not a finite number"),
            ("gain", True, "takes a number"),
            ("gain", "2", "takes a number"),
            ("steps", 2.0, "takes a whole number"),
            ("steps", 0, "outside the range of 1 and more"),
            ("steps", 2**31, "too large for 32 bits"),
            ("tint", [1, 2, 3], "a list of 4 numbers"),
            ("tint", [1, 2, 3, 1e39], "too large for 32 bits"),
            ("center", (0.0, float("inf")), "not a finite number"),
            ("mode", "sot light", "one of add, soft light"),
            ("clamp", 1, "true or false"),
            ("note", 1, "a string"),
            ("gian", 1.0, "no value 'gian'; did you mean 'gain'"),
            ("image", 1.0, "is an input"),
        ],
    )
    def test_refuses(self, name: str, value: object, says: str) -> None:
        with pytest.raises(GraphError, match=says):
            small().set(Port("gain", name), value)

    def test_floats_are_as_large_as_those_of_32_bits(self) -> None:
        most = float(np.finfo(np.float32).max)
        for name, setting in (("tint", (0.0, -most, most, 1.0)), ("center", (most, -most))):
            assert small().set(Port("gain", name), setting).value(Port("gain", name)) == setting
            for number in (1.0001 * most, -1.0001 * most):
                with pytest.raises(GraphError, match="too large for 32 bits"):
                    small().set(Port("gain", name), (number, *setting[1:]))
        assert small().set(Port("gain", "steps"), 2**31 - 1).value(Port("gain", "steps")) == 2**31 - 1

    def test_unknown_nodes_cannot_be_set(self) -> None:
        with pytest.raises(GraphError, match="the type of node 'x' is unknown"):
            Graph({"x": Unknown("lens", {})}).set(Port("x", "a"), 1)

    def test_controls(self) -> None:
        assert small().set_control("glow", 5.0).value(Port("gain", "gain")) == 5.0
        with pytest.raises(GraphError, match="no control 'glwo'; did you mean 'glow'"):
            small().set_control("glwo", 5.0)
        with pytest.raises(GraphError, match="outside the range"):
            small().set_control("glow", -1.0)


def test_rename_takes_everything_along() -> None:
    graph = small().mute("gain")
    graph = Graph(**{**vars_of(graph), "extra": {"nodes.gain": {"memo": 1}, "nodes.gain.values": {"x": 2}}})
    graph = graph.rename("gain", "lift")
    assert list(graph.nodes) == ["lift", "soften"]
    assert graph.links[Port("lift", "image")] == Port("inputs", "beauty")
    assert graph.links[Port("soften", "image")] == Port("lift", "out")
    assert graph.controls["glow"].target == Port("lift", "gain")
    assert graph.muted == {"lift"}
    assert graph.ui["nodes"]["lift"] == (10, 20.5)
    assert dict(graph.extra) == {"nodes.lift": {"memo": 1}, "nodes.lift.values": {"x": 2}}
    assert graph.rename("lift", "lift") is graph
    with pytest.raises(GraphError, match="'soften' already exists"):
        graph.rename("lift", "soften")


def vars_of(graph: Graph) -> dict[str, object]:
    return {name: getattr(graph, name) for name in graph.__dataclass_fields__}


class TestReplace:
    def test_same_names_stay(self) -> None:
        graph = small().replace("gain", Soften())
        assert graph.links == small().links
        assert not graph.controls, "soften has no value 'gain'"

    def test_else_the_first_free_one_that_fits(self) -> None:
        graph = chain(3).replace("n1", Blend())
        assert graph.links[Port("n1", "first")] == Port("n0", "out")
        assert Port("n1", "image") not in graph.links
        graph = graph.connect(Port("inputs", "beauty"), Port("n1", "second")).replace("n1", Gain())
        assert graph.links[Port("n1", "image")] == Port("n0", "out"), "the first input wins"

    def test_both_inputs_from_one_source_survive(self) -> None:
        graph = chain(1).add("b", Blend()).connect(Port("n0", "out"), Port("b", "first"))
        graph = graph.connect(Port("n0", "out"), Port("b", "second"))
        assert graph.replace("b", Blend(gain=0.1)).links == graph.links

    def test_outputs_move_by_kind(self) -> None:
        graph = chain(3).replace("n1", Split())
        assert graph.links[Port("n2", "image")] == Port("n1", "grey"), "a field fits an image"
        graph = graph.add("slope", Slope()).connect(Port("n1", "grey"), Port("slope", "depth"))
        assert Port("slope", "depth") not in graph.replace("n1", Gain()).links

    def test_what_fits_nowhere_goes(self) -> None:
        graph = chain(3).replace("n1", Slope())
        assert not {target for target in graph.links if target.node == "n1"}
        assert Port("n2", "image") not in graph.links

    def test_controls_of_values_that_stay(self) -> None:
        assert small().replace("gain", Blend()).controls == small().controls


class TestEnds:
    def test_rename_moves_links(self) -> None:
        graph = small().rename_input("beauty", "plate").rename_output("image", "final").rename_control("glow", "amount")
        assert graph.links[Port("gain", "image")] == Port("inputs", "plate")
        assert graph.links[Port("outputs", "final")] == Port("soften", "out")
        assert set(graph.controls) == {"amount"}

    def test_remove_takes_links_away(self) -> None:
        graph = small().remove_input("beauty").remove_output("image").remove_control("glow")
        assert set(graph.links) == {Port("soften", "image")}
        assert not graph.inputs
        assert not graph.outputs
        assert not graph.controls

    @pytest.mark.parametrize(
        "edit",
        [
            lambda graph: graph.add_input("beauty", Input()),
            lambda graph: graph.add_output("image", Output()),
            lambda graph: graph.add_output("a.b", Output()),
            lambda graph: graph.add_control("glow", Control(Port("gain", "gain"))),
            lambda graph: graph.add_control("new", Control(Port("gain", "nothing"))),
            lambda graph: graph.add_control("new", Control(Port("nobody", "gain"))),
            lambda graph: graph.remove_input("image"),
            lambda graph: graph.rename_output("image", ""),
            lambda graph: Input(Kind.VECTOR, 5),
        ],
    )
    def test_refused(self, edit: Callable[[Graph], object]) -> None:
        with pytest.raises(GraphError):
            edit(small())


class TestGroups:
    @staticmethod
    def nested() -> Graph:
        inner = Group(small())
        middle = Graph(
            {"inner": inner},
            {Port("inner", "beauty"): Port("inputs", "plate"), Port("outputs", "o"): Port("inner", "image")},
            {"plate": Input()},
            {"o": Output()},
            {"more": Control(Port("inner", "glow"))},
        )
        return Graph({"g": Group(middle)})

    def test_face(self) -> None:
        face = signature(Group(small()))
        assert [(name, socket.kind) for name, socket in face.inputs.items()] == [("beauty", Kind.IMAGE)]
        assert face.inputs["beauty"].optional, "it has a file of its own"
        assert [socket.name for socket in face.outputs.values()] == ["image"]
        assert face.values["glow"].default == 2.0
        assert face.values["glow"].maximum == 16.0
        assert not face.pointwise

    def test_set_reaches_through_two_groups(self) -> None:
        graph = self.nested()
        assert graph.value(Port("g", "more")) == 2.0
        graph = graph.set(Port("g", "more"), 7)
        assert graph.value(Port("g", "more")) == 7.0
        group = graph.nodes["g"]
        assert isinstance(group, Group)
        inner = group.body().nodes["inner"]
        assert isinstance(inner, Group)
        assert inner.body().nodes["gain"] == Gain(gain=7.0)
        assert group.graph == self.nested().nodes["g"].graph, "the body itself stays"
        with pytest.raises(GraphError, match="outside the range"):
            graph.set(Port("g", "more"), 17)

    def test_override_looks_inside(self) -> None:
        graph = self.nested().set(Port("g", "more"), 7).override("g.inner.soften.sigma", 9.0)
        graph = graph.override("g.more", 8.0)
        body = graph.nodes["g"].body().nodes["inner"].body()
        assert (body.nodes["gain"].gain, body.nodes["soften"].sigma) == (8.0, 9.0)
        assert graph.override("g.inner.gain.gain", 1.0).value(Port("g", "more")) == 1.0
        assert small().override("glow", 3).override("soften.sigma", 1).nodes["gain"] == Gain(gain=3.0)

    @pytest.mark.parametrize(
        ("path", "says"),
        [
            ("glwo", "no control 'glwo'; did you mean 'glow'"),
            ("gan.gain", "did you mean 'gain'"),
            ("gain.gian", "did you mean 'gain'"),
            ("gain.gain.x", "'gain', which is not a group"),
        ],
    )
    def test_override_that_points_nowhere(self, path: str, says: str) -> None:
        with pytest.raises(GraphError, match=says):
            small().override(path, 1.0)

    def test_a_control_of_a_pointwise_value_can_be_wired(self) -> None:
        graph = self.nested().add("meter", Meter()).connect(Port("meter", "mean"), Port("g", "more"))
        assert graph.links[Port("g", "more")] == Port("meter", "mean")
        stiff = Group(small().add_control("blur", Control(Port("soften", "sigma"))))
        with pytest.raises(GraphError, match="only values of pointwise nodes"):
            graph.add("stiff", stiff).connect(Port("meter", "mean"), Port("stiff", "blur"))


def test_mute_and_what_passes_through() -> None:
    graph = small().mute("gain")
    assert graph.muted == {"gain"}
    assert graph.bypass("gain", graph.target(Port("soften", "image"))) == Port("inputs", "beauty")
    assert graph.mute("gain", False).muted == frozenset()
    with pytest.raises(GraphError):
        graph.mute("nobody")


@settings(max_examples=30)
@given(st.integers(0, 2**32))
def test_equal_graphs_have_one_order(seed: int) -> None:
    graph = random_graph(Random(seed))
    shuffled = Graph(**{**vars_of(graph), "nodes": dict(reversed(graph.nodes.items()))})
    assert graph == shuffled
    assert graph.order() == shuffled.order()


def test_upstream_and_downstream() -> None:
    graph = chain(4).add("loose", Gain())
    assert graph.upstream("n2") == {"n0", "n1"}
    assert graph.downstream("n2") == {"n3"}
    assert graph.upstream("outputs") == graph.downstream("inputs") == {"n0", "n1", "n2", "n3"}
