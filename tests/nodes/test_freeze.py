"""Freeze: which frame is seen when, counted by hand."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.time.freeze import Freeze
from halation.renderer import RenderRequest
from sequences import node_at, noise_at, noise_graph


@pytest.mark.parametrize(
    ("values", "seen"),
    [
        ({}, [1, 1, 1, 1, 1, 1]),
        ({"frame": 4}, [4, 4, 4, 4, 4, 4]),
        ({"every": 1}, [1, 2, 3, 4, 5, 6]),
        ({"every": 2}, [1, 1, 3, 3, 5, 5]),
        ({"every": 2, "frame": 2}, [0, 2, 2, 4, 4, 6]),
        ({"every": 3, "frame": 5}, [-1, 2, 2, 2, 5, 5]),
    ],
)
def test_which_frame_is_held(renderer, values, seen):
    graph = noise_graph(Freeze(**values))
    for frame, source in enumerate(seen, 1):
        assert np.array_equal(node_at(renderer, graph, frame), noise_at(renderer, graph, source))


def test_it_costs_no_pass(renderer):
    graph = noise_graph(Freeze()).remove_output("noise")
    assert len(renderer.compile(graph, RenderRequest(frame=5)).passes) == 1


def test_what_is_held_is_computed_once(renderer):
    graph = noise_graph(Freeze(every=2)).remove_output("noise")
    keys = [renderer.compile(graph, RenderRequest(frame=frame)).surfaces[0].key for frame in range(1, 7)]
    assert keys[0::2] == keys[1::2] and len(set(keys)) == 3
