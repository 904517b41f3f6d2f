"""A plan says which pixels it makes, for every port that the editor can look at."""

from __future__ import annotations

import pytest
from halation.compiler import UpstreamHashes
from halation.errors import GraphError, InputError
from halation.graph import Graph, Group, Input, Output, Port, Settings, Unknown
from halation.nodes import Kind, catalogue
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.saturation import Saturation
from headers import Headers

NODES = catalogue()


def graph(nodes, links: dict[str, str], **rest) -> Graph:
    ports = {Port.parse(target): Port.parse(source) for target, source in links.items()}
    ends = {"inputs": {"image": Input(Kind.IMAGE)}, "outputs": {"image": Output()}} | rest
    return Graph(nodes=nodes, links=ports, **ends)


PASSING = graph({}, {"outputs.image": "inputs.image"})


def chain(stops: float = 1.0) -> Graph:
    """A blur between two pointwise nodes, of which the first is fused into nothing and the last is the output."""
    return graph(
        {"light": Exposure(stops=stops), "blur": GaussianBlur(sigma=2.0), "color": Saturation(saturation=0.5)},
        {
            "light.image": "inputs.image",
            "blur.image": "light.out",
            "color.image": "blur.out",
            "outputs.image": "color.out",
        },
    )


def grouped(muted: bool = False) -> Graph:
    made = graph(
        {"g": Group(chain()), "last": Exposure(stops=-1.0)},
        {"g.image": "inputs.image", "last.image": "g.image", "outputs.image": "last.out"},
    )
    return made.mute("g", muted)


def found(plan) -> dict[str, str]:
    return {f"{port}": plan.surfaces[number].key for port, number in plan.results.items()}


def test_results_are_the_ports_whose_pixels_exist(plan):
    planned = plan(chain())
    assert set(found(planned)) == {"inputs.image", "light.out", "blur.out", "color.out"}
    assert planned.results[Port("color", "out")] == planned.outputs["image"]
    assert planned.surfaces[planned.results[Port("inputs", "image")]].key == next(
        planned.surfaces[upload.surface].key for upload in planned.uploads
    )


def test_what_is_fused_away_is_no_result(plan):
    two = graph(
        {"a": Exposure(stops=1.0), "b": Saturation(saturation=0.5)},
        {"a.image": "inputs.image", "b.image": "a.out", "outputs.image": "b.out"},
    )
    assert set(found(plan(two))) == {"inputs.image", "b.out"}
    assert set(found(plan(two, fusion=False))) == {"inputs.image", "a.out", "b.out"}


def test_a_node_that_does_nothing_shows_what_it_reads(plan):
    results = found(plan(chain(stops=0.0)))
    assert results["light.out"] == results["inputs.image"]


def test_groups_have_results_inside_and_out(plan):
    results = found(plan(grouped(), fusion=False))
    assert set(results) == {
        "inputs.image",
        "g/inputs.image",
        "g/light.out",
        "g/blur.out",
        "g/color.out",
        "g.image",
        "last.out",
    }
    assert results["g.image"] == results["g/color.out"] and results["g/inputs.image"] == results["inputs.image"]
    passed = found(plan(grouped(muted=True)))
    assert passed["g.image"] == passed["inputs.image"] and "g/blur.out" not in passed


@pytest.mark.parametrize(
    ("target", "same"),
    [
        ("g/blur.out", "g/blur.out"),
        ("g.image", "g/color.out"),
        ("g/outputs.image", "g/color.out"),
        ("g/inputs.image", "inputs.image"),
        ("inputs.image", "inputs.image"),
        ("outputs.image", "last.out"),
    ],
)
def test_every_port_can_be_asked_for(plan, target, same):
    planned = plan(grouped(), fusion=False, targets={"x": Port.parse(target)})
    assert planned.surfaces[planned.outputs["x"]].key == found(plan(grouped(), fusion=False))[same]


def test_the_input_of_a_group_that_nothing_feeds_shows_its_default(plan):
    body = graph(
        {"a": Exposure(stops=1.0)},
        {"a.image": "inputs.image", "outputs.image": "a.out"},
        inputs={"image": Input(Kind.IMAGE, default=(1.0, 0.5, 0.0, 1.0))},
    )
    made = graph({"g": Group(body)}, {"outputs.image": "g.image"}, settings=Settings((8, 6)))
    assert plan(made, targets={"x": Port("g/inputs", "image")}).surfaces[0].size == (8, 6)


@pytest.mark.parametrize(
    ("target", "fault"),
    [
        ("g/nope.out", "'g/nope.out' does not exist"),
        ("g/blur.image", "'g/blur.image' does not exist"),
        ("g.nope", "is not linked to anything"),
        ("g/outputs.nope", "is not linked to anything"),
        ("g/inputs.nope", "'g/inputs.nope' does not exist"),
    ],
)
def test_a_port_that_is_not_there_is_named(plan, target, fault):
    with pytest.raises(GraphError, match=fault):
        plan(grouped(), targets={"x": Port.parse(target)})


@pytest.mark.parametrize(
    ("made", "node"),
    [
        (graph({"a": Exposure()}, {"outputs.image": "a.out"}), "a"),
        (
            graph({"g": Group(graph({"a": Exposure()}, {"outputs.image": "a.out"}))}, {"outputs.image": "g.image"}),
            "g/a",
        ),
        (graph({}, {}), "outputs.image"),
        (graph({"u": Unknown("x", {})}, {"outputs.image": "u.out"}), "u"),
        (
            graph(
                {"a": Exposure(), "b": Exposure()}, {"a.image": "b.out", "b.image": "a.out", "outputs.image": "a.out"}
            ),
            "a",
        ),
        (
            graph(
                {"m": NODES["merge"]()},
                {"m.a": "inputs.image", "m.b": "inputs.image", "m.mask": "inputs.image", "outputs.image": "m.out"},
            ),
            "m",
        ),
        (graph({"g": Group(graph({}, {}))}, {"g.image": "inputs.image", "outputs.image": "g.image"}), "g"),
    ],
    ids=["unlinked", "in a group", "output", "unknown", "loop", "misfit", "group output"],
)
def test_an_error_says_which_node_is_at_fault(plan, made, node):
    with pytest.raises(GraphError) as caught:
        plan(made)
    assert caught.value.node == node


def test_a_picture_that_cannot_be_read_is_the_fault_of_its_input():
    from halation.compiler import Request, compile_graph

    class Nowhere(Headers):
        def probe_picture(self, picture):
            raise InputError(f"{picture.path}: it is not there")

    for nodes, links in (({}, {}), ({"c": NODES["checker"]()}, {"outputs.image": "c.out"})):
        made = graph(nodes, {"outputs.image": "inputs.image"} | links, inputs={"image": Input(file="a.exr")})
        with pytest.raises(InputError) as caught:
            compile_graph(made, Request(), Nowhere((8, 6)))
        assert caught.value.node == "inputs.image"


# --- hashes ----------------------------------------------------------------------------------------------------------


def changed(before: Graph, after: Graph) -> set[str]:
    first = UpstreamHashes(before)
    old, new = first.hashes, UpstreamHashes(after).hashes
    assert UpstreamHashes(after, before=first).hashes == new
    return {path for path in old.keys() | new.keys() if old.get(path) != new.get(path)}


def test_hashes_change_downstream_only():
    made = chain()
    assert changed(made, chain()) == set()
    assert changed(made, made.set(Port("light", "stops"), 2.0)) == {"light", "blur", "color"}
    assert changed(made, made.set(Port("color", "saturation"), 2.0)) == {"color"}
    assert changed(made, made.mute("blur")) == {"blur", "color"}
    assert changed(made, made.connect(Port("inputs", "image"), Port("color", "image"))) == {"color"}
    moved = Graph(**{name: getattr(made, name) for name in ("nodes", "links", "inputs", "outputs")}, ui={"nodes": {}})
    assert changed(made, moved) == set()


def test_hashes_look_into_groups():
    made = grouped()
    assert set(UpstreamHashes(made).hashes) == {
        "inputs.image",
        "g/inputs.image",
        "g/light",
        "g/blur",
        "g/color",
        "g",
        "last",
    }
    inside = made.override("g.blur.sigma", 7.0)
    assert changed(made, inside) == {"g/blur", "g/color", "g", "last"}


def test_a_fault_leaves_the_other_hashes():
    made = graph(
        {"a": Exposure(), "u": Unknown("x", {}), "b": Exposure()}, {"a.image": "inputs.image", "b.image": "u.out"}
    )
    assert set(UpstreamHashes(made).hashes) == {"inputs.image", "a"}
    loop = graph({"g": Group(PASSING), "h": Group(PASSING)}, {"g.image": "h.image", "h.image": "g.image"})
    assert UpstreamHashes(loop).hashes.keys() >= {"inputs.image"}
