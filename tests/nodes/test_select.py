"""Select lets one picture through: the others are not in the plan."""

from __future__ import annotations

import numpy as np
import pytest
from halation.compiler import Request, compile_graph
from halation.graph import Graph, Input, Output, Port, Settings
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
