"""Which operations share a pass. That pixels stay is in tests/renderer/test_equivalence.py."""

from __future__ import annotations

from typing import Any

from halation.compiler import Plan
from halation.custom_nodes import Code, node_type
from halation.graph import Graph, Input, Output, Port
from halation.nodes import catalogue

NODES = catalogue()


def graph(nodes: dict[str, Any], links: dict[str, str]) -> Graph:
    made = Graph().add_input("image", Input()).add_output("out", Output(width=4))
    for id, node in nodes.items():
        made = made.add(id, node)
    for target, source in links.items():
        made = made.connect(Port.parse(source), Port.parse(target))
    return made


def passes(plan: Plan) -> list[set[str]]:
    return [set(one.functions) for one in plan.passes]


def test_what_looks_around_joins_a_pointwise_reader_if_it_is_light(plan) -> None:
    edges, bright = NODES["edge_detect"](), NODES["exposure"](stops=1.0)
    links = {"edges.image": "inputs.image", "light.image": "edges.out", "outputs.out": "light.out"}
    assert passes(plan(graph({"edges": edges, "light": bright}, links))) == [{"edge_detect", "exposure"}]
    heavy = NODES["bilateral_blur"]()
    made = passes(plan(graph({"edges": heavy, "light": bright}, links)))
    assert made[-1] == {"exposure"}  # it has loops


def test_what_it_reads_is_a_texture(plan) -> None:
    """It wants neighbors, so what makes them cannot be part of its pass, whoever else reads it."""
    nodes = {
        "before": NODES["exposure"](stops=1.0),
        "edges": NODES["edge_detect"](),
        "sum": NODES["merge"](mode="plus"),
    }
    links = {
        "before.image": "inputs.image",
        "edges.image": "before.out",
        "sum.a": "edges.out",
        "sum.b": "before.out",
        "outputs.out": "sum.out",
    }
    assert passes(plan(graph(nodes, links))) == [{"exposure"}, {"edge_detect", "merge"}]


def test_the_last_step_of_a_blur_is_made_where_it_is_read(plan) -> None:
    nodes = {"blur": NODES["gaussian_blur"](sigma=12.0), "mix": NODES["mix_images"](factor=0.25)}
    links = {"blur.image": "inputs.image", "mix.a": "inputs.image", "mix.b": "blur.out", "outputs.out": "mix.out"}
    assert passes(plan(graph(nodes, links)))[-1] == {"enlarge", "mix_images"}


def test_several_of_one_kind_keep_their_names_apart(plan, run) -> None:
    """Two pictures, one function: each reads its own."""
    import numpy as np

    shift = node_type(Code("glsl", "vec4 f(vec4 image, int x /* = 0 */) { return image_at(pixel + ivec2(x, 0)); }"))
    nodes = {"left": shift(x=1), "right": shift(x=-2), "sum": NODES["merge"](mode="plus")}
    links = {
        "left.image": "inputs.image",
        "right.image": "inputs.image",
        "sum.a": "left.out",
        "sum.b": "right.out",
        "outputs.out": "sum.out",
    }
    made = graph(nodes, links)
    assert len(plan(made).passes) == 1
    picture = np.random.default_rng(1).random((5, 9, 4)).astype(np.float32) * [1.0, 1.0, 1.0, 0.0]
    at = np.arange(9)
    wanted = picture[:, np.clip(at + 1, 0, 8)] + picture[:, np.clip(at - 2, 0, 8)]
    assert np.abs(run(made, {"image": picture}) - wanted).max() < 1e-6


def test_what_is_looked_at_is_written_by_the_pass_that_goes_on(plan) -> None:
    nodes = {"edges": NODES["edge_detect"](), "light": NODES["exposure"](stops=1.0)}
    links = {"edges.image": "inputs.image", "light.image": "edges.out", "outputs.out": "light.out"}
    targets = {"out": Port("outputs", "out"), "edges": Port("edges", "out")}
    made = plan(graph(nodes, links), targets=targets)
    assert passes(made) == [{"edge_detect", "exposure"}] and len(made.passes[0].targets) == 2
