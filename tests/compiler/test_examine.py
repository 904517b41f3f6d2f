"""`examine` refuses what `compile_graph` refuses, in the same words."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import pytest
from halation.compiler import Request, compile_graph, examine
from halation.compiler.ir import LoweredProgram
from halation.compiler.lowering.lower import lower
from halation.compiler.lowering.samples import lower_samples
from halation.compiler.planner import graph_library
from halation.errors import HalationError, InputError
from halation.graph import OUTPUTS, Graph, Output, Port
from halation.inputs.provider import MediaProvider
from halation.nodes import Node
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.distort.resize import Resize
from halation.nodes.input.noise import Noise
from halation.resources.picture import Picture
from halation.resources.provider import PictureProbe
from halation.resources.sandbox import Sandbox
from hypothesis import given, settings
from hypothesis import strategies as st
from random_graphs import SIZE, random_graph


class Outside(MediaProvider):
    """Pictures of one size, or none."""

    def __init__(self, lost: bool) -> None:
        super().__init__(sandbox=Sandbox(""))
        self.lost = lost

    def probe_picture(self, picture: Picture) -> PictureProbe:
        if self.lost:
            raise InputError(f"{picture.path}: there is no such file")
        return PictureProbe(SIZE, False, picture.path)


def said(work, graph: Graph, request: Request, lost: bool) -> tuple[str, str]:
    try:
        work(graph, request, Outside(lost))
    except HalationError as fault:
        return type(fault).__name__, str(fault)
    return "", ""


def repeat(graph: Graph, count: int) -> Graph:
    """Copies of all nodes, each of which reads copies, so that most nodes are like an earlier one."""
    nodes, links, outputs = dict(graph.nodes), dict(graph.links), dict(graph.outputs)
    for copy in range(count):
        names = {id: f"{id}_{copy}" for id in graph.nodes}
        nodes |= {names[id]: item for id, item in graph.nodes.items()}
        outputs |= {f"{name}_{copy}": end for name, end in graph.outputs.items()}
        for target, source in graph.links.items():
            end = Port(OUTPUTS, f"{target.socket}_{copy}") if target.node == OUTPUTS else target
            links[Port(names.get(end.node, end.node), end.socket)] = Port(
                names.get(source.node, source.node), source.socket
            )
    return replace(graph, nodes=nodes, links=links, outputs=outputs)


@settings(max_examples=60)
@given(st.integers(0, 2**32), st.randoms(use_true_random=False), st.booleans(), st.integers(0, 2))
def test_both_refuse_the_same(seed, rng, lost, copies) -> None:
    graph = repeat(random_graph(seed, 5), copies)
    if graph.links and rng.random() < 0.6:
        graph = graph.disconnect(rng.choice(sorted(graph.links)))
    bound = {
        name: Picture(name, "", end.kind, end.socket().channels, in_memory=True)
        for name, end in graph.inputs.items()
        if end.default is None and rng.random() < 0.9
    }
    size = rng.choice((None, (64, 48), (40000, 9)))
    request = Request(bindings=bound, size=size)
    assert said(examine, graph, request, lost) == said(compile_graph, graph, request, lost)


def chain(nodes: Iterable[Node]) -> Graph:
    graph = Graph(outputs={"image": Output()}).add("start", Noise())
    end = Port("start", "out")
    for number, node in enumerate(nodes):
        graph = graph.add(f"n{number}", node).connect(end, Port(f"n{number}", "image"))
        end = Port(f"n{number}", "out")
    return graph.connect(end, Port(OUTPUTS, "image"))


def lower_both(graph: Graph) -> tuple[LoweredProgram, LoweredProgram]:
    request, outside = Request(size=(64, 48)), Outside(False)
    library = graph_library(graph, outside)
    samples = lower_samples(graph, request, library, outside)
    return samples, lower(graph, request, library, outside).program


@pytest.mark.parametrize(
    ("nodes", "most"),
    [
        ([Exposure(stops=0.5)] * 200, 4),
        ([Exposure(stops=number / 100) for number in range(200)], 4),
        ([GaussianBlur(sigma=3.0)] * 200, 12),
        ([Exposure(stops=0.5), Resize(scale=(0.5, 2.0)), Resize(scale=(2.0, 0.5))] * 50, 160),
    ],
    ids=["equal", "other numbers", "filters", "sizes"],
)
def test_nodes_that_are_alike_are_lowered_once(nodes, most) -> None:
    samples, whole = lower_both(chain(nodes))
    assert len(samples.ops) <= most < len(whole.ops)
    assert samples.shape(samples.outputs["image"]) == whole.shape(whole.outputs["image"])


@settings(max_examples=40)
@given(st.integers(0, 2**32), st.integers(0, 2))
def test_samples_have_the_shapes_of_what_they_stand_for(seed, copies) -> None:
    graph = repeat(random_graph(seed, 6), copies)
    bound = {
        name: Picture(name, "", end.kind, end.socket().channels, in_memory=True)
        for name, end in graph.inputs.items()
        if end.default is None
    }
    request, outside = Request(bindings=bound, size=(64, 48)), Outside(False)
    library = graph_library(graph, outside)
    try:
        whole = lower(graph, request, library, outside).program
    except HalationError:
        return
    samples = lower_samples(graph, request, library, outside)
    assert {name: samples.shape(ref) for name, ref in samples.outputs.items()} == {
        name: whole.shape(ref) for name, ref in whole.outputs.items()
    }
    assert {op.files for op in samples.ops} == {op.files for op in whole.ops}


def test_there_is_something_to_refuse() -> None:
    graph = random_graph(1, 5)
    with pytest.raises(HalationError):
        examine(graph, Request(), Outside(False))
