"""The layout in `ui` names nodes, ends and links: it follows them wherever they go."""

from __future__ import annotations

from dataclasses import replace

import pytest
from halation.graph import Graph, Port
from toy_nodes import Soften, small

UI = {
    "nodes": {"gain": {"x": 1}, "soften": {"x": 2}, "inputs.beauty": {"x": 0}, "outputs.image": {"x": 3}},
    "routes": {"gain.image": ["d1"], "soften.image": ["d2"], "outputs.image": ["d1", "d2"]},
    "viewers": {"1": "gain.out", "2": "inputs.beauty", "3": "outputs.image"},
    "zoom": 1.5,
}


@pytest.fixture
def graph() -> Graph:
    return replace(small(), ui=UI)


def test_a_renamed_node(graph):
    ui = graph.rename("gain", "lift").ui
    assert set(ui["nodes"]) == {"lift", "soften", "inputs.beauty", "outputs.image"}
    assert set(ui["routes"]) == {"lift.image", "soften.image", "outputs.image"}
    assert ui["viewers"] == {"1": "lift.out", "2": "inputs.beauty", "3": "outputs.image"}
    assert ui["zoom"] == 1.5


def test_a_removed_node(graph):
    ui = graph.remove("gain").ui
    assert set(ui["nodes"]) == {"soften", "inputs.beauty", "outputs.image"}
    assert set(ui["routes"]) == {"soften.image", "outputs.image"}, "the healed link keeps its dots"
    assert set(ui["viewers"]) == {"2", "3"}
    assert set(graph.remove("gain", heal=False).ui["routes"]) == {"outputs.image"}


def test_renamed_and_removed_ends(graph):
    ui = graph.rename_input("beauty", "plate").rename_output("image", "final").ui
    assert set(ui["nodes"]) == {"gain", "soften", "inputs.plate", "outputs.final"}
    assert set(ui["routes"]) == {"gain.image", "soften.image", "outputs.final"}
    assert ui["viewers"] == {"1": "gain.out", "2": "inputs.plate", "3": "outputs.final"}
    ui = graph.remove_input("beauty").remove_output("image").ui
    assert set(ui["nodes"]) == {"gain", "soften"}
    assert set(ui["routes"]) == {"soften.image"}
    assert set(ui["viewers"]) == {"1"}


def test_a_link_drawn_anew_is_straight(graph):
    assert graph.connect(Port("gain", "out"), Port("soften", "image")).ui == graph.ui, "the same link"
    ui = graph.connect(Port("inputs", "beauty"), Port("soften", "image")).ui
    assert set(ui["routes"]) == {"gain.image", "outputs.image"}
    assert set(graph.disconnect(Port("soften", "image")).ui["routes"]) == {"gain.image", "outputs.image"}


def test_a_replaced_node_keeps_the_routes_of_links_that_stay(graph):
    assert graph.replace("gain", Soften()).ui == graph.ui


@pytest.mark.parametrize(
    "ui",
    [{"nodes": [1, 2], "routes": 3, "viewers": None}, {"nodes": {"gain": [1, 2]}, "viewers": {"1": 7}}, {}],
    ids=["other shapes", "odd entries", "empty"],
)
def test_what_has_another_shape_is_left_alone(ui):
    graph = replace(small(), ui=ui)
    assert graph.rename("gain", "lift").rename("lift", "gain") == graph
    assert graph.rename_input("beauty", "b").rename_input("b", "beauty") == graph
    assert graph.disconnect(Port("soften", "image")).ui == graph.ui
