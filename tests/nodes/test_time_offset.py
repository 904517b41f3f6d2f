"""Time offset: which frame is seen when; and neighbors in a row add up."""

from __future__ import annotations

import numpy as np
import pytest
from halation.graph import Port
from halation.nodes.time.freeze import Freeze
from halation.nodes.time.time_offset import TimeOffset
from halation.nodes.time.time_speed import TimeSpeed
from halation.renderer import RenderRequest
from sequences import node_at, noise_at, noise_graph


@pytest.mark.parametrize("frames", [-7, 0, 3])
def test_another_frame_is_seen(renderer, frames):
    graph = noise_graph(TimeOffset(frames=frames))
    assert np.array_equal(node_at(renderer, graph, 4), noise_at(renderer, graph, 4 + frames))


def test_offsets_add_up(renderer):
    graph = noise_graph(TimeOffset(frames=3)).add("back", TimeOffset(frames=-5)).disconnect(Port("outputs", "out"))
    graph = graph.connect(Port("node", "out"), Port("back", "image")).connect(
        Port("back", "out"), Port("outputs", "out")
    )
    assert np.array_equal(node_at(renderer, graph, 4), noise_at(renderer, graph, 2))


def test_it_costs_no_pass(renderer):
    graph = noise_graph(TimeOffset(frames=2)).remove_output("noise")
    assert len(renderer.compile(graph, RenderRequest(frame=5)).passes) == 1


@pytest.mark.parametrize(
    "node", [TimeOffset(frames=3), Freeze(frame=7), TimeSpeed(speed=2.0)], ids=lambda node: node.id
)
def test_a_muted_node_changes_no_time(renderer, node):
    graph = noise_graph(node).mute("node")
    assert np.array_equal(node_at(renderer, graph, 4), noise_at(renderer, graph, 4))
