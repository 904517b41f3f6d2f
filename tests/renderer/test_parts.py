"""A region of a picture is the same to the bit as in the whole, whatever of the graph is on the device already."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from typing import Any

import numpy as np
import pytest
from halation import document
from halation.compiler import Region
from halation.graph import Graph, Port, signature
from halation.presets import paths
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from random_graphs import pictures, random_graph, random_node
from selection import list_seeds


@pytest.fixture
def warm(renderer: Renderer) -> Iterator[Renderer]:
    """A renderer that remembers."""
    made = Renderer(renderer.device, sandbox=UNRESTRICTED)
    yield made
    made.close()


def same_part(warm: Renderer, cold: Renderer, graph: Graph, wanted: dict[str, Any], region: Region) -> None:
    plan = warm.compile(graph, RenderRequest(**wanted, region=region))
    got, whole = warm.runner.run(plan), cold.render(graph, RenderRequest(**wanted))
    for name, pixels in whole.items():
        window = plan.surfaces[plan.outputs[name]].window or Region.whole(pixels.shape[1::-1])
        expected = pixels[slice(*window.down), slice(*window.across)]
        np.testing.assert_array_equal(got[name].view(np.uint8), expected.copy().view(np.uint8), name)


@pytest.mark.parametrize("seed", list_seeds(7, 14))
def test_random_graphs(warm, renderer, seed):
    rng, graph = Random(seed), random_graph(seed)
    wanted = {"inputs": pictures(seed), "precision": "float"}
    if renderer.compile(graph, RenderRequest(**wanted)).memories:
        pytest.skip("frames that need others are made whole")
    warm.render(graph, RenderRequest(**wanted))
    for region in (Region(4, 3, 12, 9), Region(20, 8, 17, 6)):
        id = rng.choice([*graph.nodes])
        graph = graph.replace(id, random_node(rng, type(graph.nodes[id])))
        same_part(warm, renderer, graph, wanted, region)
        same_part(warm, renderer, graph, wanted, region)


@pytest.mark.parametrize("name", ["post_stack", "auto_exposed", "neon_edges", "lens_character"])
def test_presets(warm, renderer, name):
    graph = next(document.load(path, sandbox=UNRESTRICTED) for path in paths() if path.stem == name)
    wanted, region = {"scale": 0.1}, Region(20, 10, 16, 16)
    warm.render(graph, RenderRequest(**wanted))
    for id in list(graph.nodes)[-3:]:
        for value in signature(graph.nodes[id]).values.values():
            port = Port(id, value.name)
            if value.type == "float" and port not in graph.links and value.unit is not None:
                graph = graph.put(port, min(max(float(value.default) * 0.9 + 0.01, value.minimum), value.maximum))
                break
        same_part(warm, renderer, graph, wanted, region)
