"""Groups: their ends, what they keep, what is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import entry
from halation.authoring.edits.folding import body_at, check_depth, find_borrowed_group, put_body, reread_groups
from halation.authoring.edits.grouping import make_group
from halation.authoring.edits.layout import pin_places
from halation.authoring.edits.routes import add_dot, routes
from halation.authoring.edits.ungrouping import ungroup
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Output, Port, Unknown
from halation.nodes import Kind
from toy_nodes import Blend, Flow, Gain, Meter, Photo, Slope, Soften, Split, chain


def port(text: str) -> Port:
    return Port.parse(text)


def links(graph: Graph) -> dict[str, str]:
    return {str(end): str(start) for end, start in graph.links.items()}


def body(graph: Graph, id: str) -> Graph:
    item = graph.nodes[id]
    assert isinstance(item, Group)
    return item.graph


def test_ends_are_named_and_typed_by_what_crosses_the_border():
    graph = Graph(inputs={"a": Input(), "depth": Input(Kind.FIELD)}, outputs={"image": Output(), "second": Output()})
    graph = graph.add("blend", Blend()).add("soften", Soften()).add("meter", Meter()).add("split", Split())
    for start, end in (
        ("inputs.a", "blend.first"),
        ("inputs.a", "blend.second"),
        ("inputs.depth", "blend.mask"),
        ("inputs.a", "meter.image"),
        ("meter.mean", "blend.gain"),
        ("blend.out", "soften.image"),
        ("blend.out", "split.image"),
        ("soften.out", "outputs.image"),
        ("split.rest", "outputs.second"),
    ):
        graph = graph.connect(port(start), port(end))
    after, id = make_group(graph, {ElementId("blend"), ElementId("soften"), ElementId("inputs.a")}, "look")
    assert id == "look"
    made = body(after, "look")
    assert {name: (end.kind, end.width) for name, end in made.inputs.items()} == {
        "first": (Kind.IMAGE, 4),
        "mask": (Kind.FIELD, 1),
        "gain": (Kind.NUMBER, 1),
    }
    assert links(made) == {
        "blend.first": "inputs.first",
        "blend.second": "inputs.first",
        "blend.mask": "inputs.mask",
        "blend.gain": "inputs.gain",
        "soften.image": "blend.out",
        "outputs.out": "soften.out",
        "outputs.out2": "blend.out",
    }
    assert set(after.inputs) == {"a", "depth"}
    assert links(after) == {
        "look.first": "inputs.a",
        "look.mask": "inputs.depth",
        "look.gain": "meter.mean",
        "meter.image": "inputs.a",
        "outputs.image": "look.out",
        "split.image": "look.out2",
        "outputs.second": "split.rest",
    }


def test_nodes_that_nobody_reads_yet_become_a_group_with_an_output():
    graph = Graph(inputs={"a": Input()}, outputs={"image": Output()}).add("soften", Soften()).add("split", Split())
    graph = graph.connect(port("inputs.a"), port("soften.image")).connect(port("soften.out"), port("split.image"))
    after, id = make_group(graph, {ElementId("soften"), ElementId("split")})
    first = next(iter(Split().outputs))
    assert list(body(after, id).outputs) == [first]
    assert links(body(after, id))[f"outputs.{first}"] == f"split.{first}"
    both, _ = make_group(graph.disconnect(port("split.image")), {ElementId("soften"), ElementId("split")})
    assert len(body(both, "group").outputs) == 2


def test_a_group_that_would_feed_itself_is_refused():
    with pytest.raises(GraphError, match=r"would feed itself: 'n1' lies between them"):
        make_group(chain(3), {ElementId("n0"), ElementId("n2")})
    with pytest.raises(GraphError, match="no node is selected"):
        make_group(chain(3), {ElementId("inputs.beauty")})
    with pytest.raises(GraphError, match="cannot be called"):
        make_group(chain(3), {ElementId("n0")}, "a.b")


def test_controls_mutes_keys_and_viewers_go_along():
    graph = replace(
        pin_places(chain(3)).add_control("glow", Control(port("n1.gain"), "Glow", "How much.")).mute("n2"),
        extra={"nodes.n1": {"later": 1}, "nodes.n1.values": {"x": 2}, "nodes.n0": {"y": 3}},
    )
    graph = replace(graph, ui={**graph.ui, "viewers": {"1": "n2.out", "2": "n1.out", "3": "n0.out"}})
    after, id = make_group(graph, {ElementId("n1"), ElementId("n2")})
    made = body(after, id)
    assert made.controls["glow"] == Control(port("n1.gain"), "Glow", "How much.")
    assert after.controls["glow"] == Control(Port(id, "glow"), "Glow", "How much.")
    assert after.set_control("glow", 3.0).value(Port(id, "glow")) == 3.0
    assert (made.muted, after.muted) == ({"n2"}, frozenset())
    assert set(made.extra) == {"nodes.n1", "nodes.n1.values"} and set(after.extra) == {"nodes.n0"}
    assert after.ui["viewers"] == {"1": f"{id}.out", "3": "n0.out"}
    again, _ = ungroup(after, id)
    assert again.extra == graph.extra
    assert again.controls == graph.controls
    assert again.ui["viewers"] == {"1": "n2.out", "3": "n0.out"}


def test_dots_inside_go_along_and_those_on_the_border_stay():
    graph = pin_places(chain(3))
    graph, outer = add_dot(graph, port("n1.image"), (1.0, 1.0))
    graph, inner = add_dot(graph, port("n2.image"), (2.0, 2.0))
    graph, leaving = add_dot(graph, port("outputs.image"), (3.0, 3.0))
    after, id = make_group(graph, {ElementId("n1"), ElementId("n2")})
    assert routes(after) == {f"{id}.image": (outer.name,), "outputs.image": (leaving.name,)}
    assert routes(body(after, id)) == {"n2.image": (inner.name,)}
    again, _ = ungroup(after, id)
    assert routes(again).keys() == routes(graph).keys()


def test_frames_that_are_selected_go_along():
    graph = replace(
        pin_places(chain(2)), ui={**pin_places(chain(2)).ui, "frames": {"f1": {"x": 0, "y": 0, "title": "t"}}}
    )
    after, id = make_group(graph, {ElementId("n0"), ElementId("frames.f1")})
    assert "frames" not in after.ui
    assert entry(body(after, id), ElementId("frames.f1"))["title"] == "t"
    assert entry(ungroup(after, id)[0], ElementId("frames.f1"))["title"] == "t"


def test_nodes_of_unknown_type_can_be_grouped():
    graph = Graph(inputs={"a": Input()}, outputs={"image": Output()}).add("lens", Unknown("lens")).add("n", Slope())
    graph = graph.connect(port("inputs.a"), port("lens.in")).connect(port("lens.depth"), port("n.depth"))
    graph = graph.connect(port("lens.out"), port("outputs.image"))
    after, id = make_group(graph, {ElementId("lens")})
    made = body(after, id)
    assert {name: end.kind for name, end in made.outputs.items()} == {"depth": Kind.FIELD, "out": Kind.IMAGE}
    assert links(ungroup(after, id)[0]) == links(graph)


def test_names_that_are_taken_are_counted_up():
    graph = chain(1).add(
        "g", Group(Graph(inputs={"image": Input()}).add("n0", Gain()).connect(port("inputs.image"), port("n0.image")))
    )
    after, put = ungroup(graph.connect(port("n0.out"), port("g.image")), "g")
    assert put == ("n1",)
    assert links(after)["n1.image"] == "n0.out"


def test_a_file_or_default_inside_becomes_an_input_of_the_graph():
    made = Graph(inputs={"plate": Input(file="a.exr"), "by": Input(Kind.VECTOR, 2)}, outputs={"image": Output()})
    made = made.add("flow", Flow()).connect(port("inputs.plate"), port("flow.image"))
    made = made.connect(port("inputs.by"), port("flow.by")).connect(port("flow.out"), port("outputs.image"))
    graph = Graph(inputs={"plate": Input()}, outputs={"image": Output()}).add("g", Group(made, values={}))
    after, _ = ungroup(graph.connect(port("g.image"), port("outputs.image")), "g")
    assert links(after) == {"flow.image": "inputs.plate2", "outputs.image": "flow.out"}
    assert after.inputs["plate2"] == Input(file="a.exr")


def test_an_input_has_another_name_than_a_control_that_goes_along():
    """A control that stays outside has its name, which an input of the group may have too."""
    for target, name in (("n1.gain", "image2"), ("n0.gain", "image")):
        after, id = make_group(chain(3).add_control("image", Control(port(target))), {ElementId("n1")}, "g")
        made = body(after, id)
        assert list(made.inputs) == [name] and list(made.controls) == ["image"] * (target == "n1.gain")
        assert links(made)["n1.image"] == f"inputs.{name}"


def test_values_links_to_controls_and_paths_are_kept_when_a_group_opens():
    made = Graph(nodes={"n": Gain(), "p": Photo(path="a.exr")}, folder="lib").add_control("g", Control(port("n.gain")))
    made = made.add_control("t", Control(port("n.steps")))
    graph = Graph(nodes={"m": Meter(), "g": Group(made, "lib/g.json", {"t": 7})}, folder="")
    after, _ = ungroup(graph.connect(port("m.mean"), port("g.g")), "g")
    assert links(after) == {"n.gain": "m.mean"}
    assert after.value(port("n.steps")) == 7
    assert after.value(port("p.path")) == "lib/a.exr"


def test_a_muted_group_is_not_opened():
    graph, id = make_group(chain(2), {ElementId("n0")})
    with pytest.raises(GraphError, match="unmute it first"):
        ungroup(graph.mute(id), id)


class TestFolding:
    def test_values_become_part_of_the_body(self):
        made = Graph(nodes={"n": Gain(gain=1.0)}).add_control("glow", Control(port("n.gain")))
        graph = Graph(nodes={"g": Group(made, values={"glow": 2.0})})
        within = body_at(graph, ("g",))
        assert within.value(port("n.gain")) == 2.0
        after = put_body(graph, ("g",), within.set(port("n.gain"), 3.0))
        assert after.value(port("g.glow")) == 3.0
        assert after.nodes["g"] == Group(made.set(port("n.gain"), 3.0))

    def test_links_and_controls_outside_follow_renamed_ends_and_lose_those_that_are_gone(self):
        graph, id = make_group(chain(3).add_control("glow", Control(port("n1.gain"))), {ElementId("n1")})
        path = (id,)
        within = body_at(graph, path).rename_input("image", "plate").rename_control("glow", "shine")
        moves = {port("inputs.image"): port("inputs.plate"), port("controls.glow"): port("controls.shine")}
        after = put_body(graph, path, within, moves)
        assert links(after)[f"{id}.plate"] == "n0.out"
        assert after.controls["glow"].target == Port(id, "shine")
        bare = body_at(after, path).remove_input("plate").remove_output("out").remove_control("shine")
        gone = put_body(after, path, bare)
        assert links(gone) == {"n0.image": "inputs.beauty", "outputs.image": "n2.out"}
        assert not gone.controls

    def test_two_levels(self):
        graph, outer = make_group(chain(4), {ElementId("n1"), ElementId("n2")}, "outer")
        made, _ = make_group(body(graph, outer), {ElementId("n1")}, "inner")
        graph = put_body(graph, (outer,), made)
        path = ("outer", "inner")
        after = put_body(graph, path, body_at(graph, path).remove_output("out"))
        assert "n2.image" not in links(body_at(after, ("outer",)))
        assert set(body_at(after, path).nodes) == {"n1"}

    def test_a_body_of_another_file_is_not_changed_here(self):
        graph = Graph(nodes={"g": Group(chain(1), "lib/chain.json")})
        assert find_borrowed_group(graph, ("g",)) == (("g",), "lib/chain.json")
        with pytest.raises(GraphError, match=r"'g' comes from the file 'lib/chain.json': make it local first"):
            put_body(graph, ("g",), chain(2))

    def test_groups_do_not_nest_deeper_than_a_file_may(self):
        graph = chain(1)
        for _ in range(32):
            graph, _ = make_group(graph, graph.nodes)
        check_depth(graph)
        with pytest.raises(GraphError, match="nested deeper than 32"):
            check_depth(make_group(graph, graph.nodes)[0])

    def test_bodies_that_come_from_files_are_read_again(self):
        graph = Graph(nodes={"g": Group(chain(1), "a.json"), "h": Group(Graph(nodes={"g": Group(chain(1), "a.json")}))})
        assert reread_groups(graph, lambda path: chain(1)) is graph
        after = reread_groups(graph, lambda path: chain(3))
        assert body_at(after, ("g",)) == body_at(after, ("h", "g")) == chain(3)
