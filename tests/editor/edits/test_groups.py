"""Groups: their ends, what they keep, what is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest
from halation.authoring.edits.elements import entry
from halation.authoring.edits.folding import borrowed, check_depth, folded, inside, reread
from halation.authoring.edits.grouping import grouped
from halation.authoring.edits.layout import pinned
from halation.authoring.edits.routes import add_dot, routes
from halation.authoring.edits.ungrouping import ungrouped
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
    after, id = grouped(graph, {"blend", "soften", "inputs.a"}, "look")
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


def test_a_group_that_would_feed_itself_is_refused():
    with pytest.raises(GraphError, match=r"would feed itself: 'n1' lies between them"):
        grouped(chain(3), {"n0", "n2"})
    with pytest.raises(GraphError, match="no node is selected"):
        grouped(chain(3), {"inputs.beauty"})
    with pytest.raises(GraphError, match="cannot be called"):
        grouped(chain(3), {"n0"}, "a.b")


def test_controls_mutes_keys_and_viewers_go_along():
    graph = replace(
        pinned(chain(3)).add_control("glow", Control(port("n1.gain"), "Glow", "How much.")).mute("n2"),
        extra={"nodes.n1": {"later": 1}, "nodes.n1.values": {"x": 2}, "nodes.n0": {"y": 3}},
    )
    graph = replace(graph, ui={**graph.ui, "viewers": {"1": "n2.out", "2": "n1.out", "3": "n0.out"}})
    after, id = grouped(graph, {"n1", "n2"})
    made = body(after, id)
    assert made.controls["glow"] == Control(port("n1.gain"), "Glow", "How much.")
    assert after.controls["glow"] == Control(Port(id, "glow"), "Glow", "How much.")
    assert after.set_control("glow", 3.0).value(Port(id, "glow")) == 3.0
    assert (made.muted, after.muted) == ({"n2"}, frozenset())
    assert set(made.extra) == {"nodes.n1", "nodes.n1.values"} and set(after.extra) == {"nodes.n0"}
    assert after.ui["viewers"] == {"1": f"{id}.out", "3": "n0.out"}
    again, _ = ungrouped(after, id)
    assert again.extra == graph.extra
    assert again.controls == graph.controls
    assert again.ui["viewers"] == {"1": "n2.out", "3": "n0.out"}


def test_dots_inside_go_along_and_those_on_the_border_stay():
    graph = pinned(chain(3))
    graph, outer = add_dot(graph, port("n1.image"), (1.0, 1.0))
    graph, inner = add_dot(graph, port("n2.image"), (2.0, 2.0))
    graph, leaving = add_dot(graph, port("outputs.image"), (3.0, 3.0))
    after, id = grouped(graph, {"n1", "n2"})
    assert routes(after) == {f"{id}.image": (outer,), "outputs.image": (leaving,)}
    assert routes(body(after, id)) == {"n2.image": (inner,)}
    again, _ = ungrouped(after, id)
    assert routes(again).keys() == routes(graph).keys()


def test_frames_that_are_selected_go_along():
    graph = replace(pinned(chain(2)), ui={**pinned(chain(2)).ui, "frames": {"f1": {"x": 0, "y": 0, "title": "t"}}})
    after, id = grouped(graph, {"n0", "frames.f1"})
    assert "frames" not in after.ui
    assert entry(body(after, id), "frames.f1")["title"] == "t"
    assert entry(ungrouped(after, id)[0], "frames.f1")["title"] == "t"


def test_nodes_of_unknown_type_can_be_grouped():
    graph = Graph(inputs={"a": Input()}, outputs={"image": Output()}).add("lens", Unknown("lens")).add("n", Slope())
    graph = graph.connect(port("inputs.a"), port("lens.in")).connect(port("lens.depth"), port("n.depth"))
    graph = graph.connect(port("lens.out"), port("outputs.image"))
    after, id = grouped(graph, {"lens"})
    made = body(after, id)
    assert {name: end.kind for name, end in made.outputs.items()} == {"depth": Kind.FIELD, "out": Kind.IMAGE}
    assert links(ungrouped(after, id)[0]) == links(graph)


def test_names_that_are_taken_are_counted_up():
    graph = chain(1).add(
        "g", Group(Graph(inputs={"image": Input()}).add("n0", Gain()).connect(port("inputs.image"), port("n0.image")))
    )
    after, put = ungrouped(graph.connect(port("n0.out"), port("g.image")), "g")
    assert put == ("n1",)
    assert links(after)["n1.image"] == "n0.out"


def test_a_file_or_default_inside_becomes_an_input_of_the_graph():
    made = Graph(inputs={"plate": Input(file="a.exr"), "by": Input(Kind.VECTOR, 2)}, outputs={"image": Output()})
    made = made.add("flow", Flow()).connect(port("inputs.plate"), port("flow.image"))
    made = made.connect(port("inputs.by"), port("flow.by")).connect(port("flow.out"), port("outputs.image"))
    graph = Graph(inputs={"plate": Input()}, outputs={"image": Output()}).add("g", Group(made, values={}))
    after, _ = ungrouped(graph.connect(port("g.image"), port("outputs.image")), "g")
    assert links(after) == {"flow.image": "inputs.plate2", "outputs.image": "flow.out"}
    assert after.inputs["plate2"] == Input(file="a.exr")


def test_values_links_to_controls_and_paths_are_kept_when_a_group_opens():
    made = Graph(nodes={"n": Gain(), "p": Photo(path="a.exr")}, folder="lib").add_control("g", Control(port("n.gain")))
    made = made.add_control("t", Control(port("n.steps")))
    graph = Graph(nodes={"m": Meter(), "g": Group(made, "lib/g.json", {"t": 7})}, folder="")
    after, _ = ungrouped(graph.connect(port("m.mean"), port("g.g")), "g")
    assert links(after) == {"n.gain": "m.mean"}
    assert after.value(port("n.steps")) == 7
    assert after.value(port("p.path")) == "lib/a.exr"


def test_a_muted_group_is_not_opened():
    graph, id = grouped(chain(2), {"n0"})
    with pytest.raises(GraphError, match="unmute it first"):
        ungrouped(graph.mute(id), id)


class TestFolding:
    def test_values_become_part_of_the_body(self):
        made = Graph(nodes={"n": Gain(gain=1.0)}).add_control("glow", Control(port("n.gain")))
        graph = Graph(nodes={"g": Group(made, values={"glow": 2.0})})
        within = inside(graph, ("g",))
        assert within.value(port("n.gain")) == 2.0
        after = folded(graph, ("g",), within.set(port("n.gain"), 3.0))
        assert after.value(port("g.glow")) == 3.0
        assert after.nodes["g"] == Group(made.set(port("n.gain"), 3.0))

    def test_links_and_controls_outside_follow_renamed_ends_and_lose_those_that_are_gone(self):
        graph, id = grouped(chain(3).add_control("glow", Control(port("n1.gain"))), {"n1"})
        path = (id,)
        within = inside(graph, path).rename_input("image", "plate").rename_control("glow", "shine")
        moves = {port("inputs.image"): port("inputs.plate"), port("controls.glow"): port("controls.shine")}
        after = folded(graph, path, within, moves)
        assert links(after)[f"{id}.plate"] == "n0.out"
        assert after.controls["glow"].target == Port(id, "shine")
        bare = inside(after, path).remove_input("plate").remove_output("out").remove_control("shine")
        gone = folded(after, path, bare)
        assert links(gone) == {"n0.image": "inputs.beauty", "outputs.image": "n2.out"}
        assert not gone.controls

    def test_two_levels(self):
        graph, outer = grouped(chain(4), {"n1", "n2"}, "outer")
        made, _ = grouped(body(graph, outer), {"n1"}, "inner")
        graph = folded(graph, (outer,), made)
        path = ("outer", "inner")
        after = folded(graph, path, inside(graph, path).remove_output("out"))
        assert "n2.image" not in links(inside(after, ("outer",)))
        assert set(inside(after, path).nodes) == {"n1"}

    def test_a_body_of_another_file_is_not_changed_here(self):
        graph = Graph(nodes={"g": Group(chain(1), "lib/chain.json")})
        assert borrowed(graph, ("g",)) == (("g",), "lib/chain.json")
        with pytest.raises(GraphError, match=r"'g' comes from the file 'lib/chain.json': make it local first"):
            folded(graph, ("g",), chain(2))

    def test_groups_do_not_nest_deeper_than_a_file_may(self):
        graph = chain(1)
        for _ in range(32):
            graph, _ = grouped(graph, graph.nodes)
        check_depth(graph)
        with pytest.raises(GraphError, match="nested deeper than 32"):
            check_depth(grouped(graph, graph.nodes)[0])

    def test_bodies_that_come_from_files_are_read_again(self):
        graph = Graph(nodes={"g": Group(chain(1), "a.json"), "h": Group(Graph(nodes={"g": Group(chain(1), "a.json")}))})
        assert reread(graph, lambda path: chain(1)) is graph
        after = reread(graph, lambda path: chain(3))
        assert inside(after, ("g",)) == inside(after, ("h", "g")) == chain(3)
