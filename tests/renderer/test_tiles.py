"""Pictures made tile by tile have the same bits as those that fit: any nodes and sizes, both forms of passes."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
import pytest
from conftest import graph_of
from halation.app import document
from halation.app.compiler import Region, explain, tiling
from halation.app.errors import DeviceError
from halation.app.graph import Graph, Input, Output, Port
from halation.app.renderer import Renderer, Wanted, open_device
from halation.nodes import Kind, Temporal, catalogue
from halation.presets import paths
from random_graphs import pictures, random_graph

FORM = os.environ.get("HALATION_TEST_FORM")
NODES = catalogue()


def limited(side: int = 16384, memory: int = 0) -> Renderer:
    """A renderer on a device that holds no more."""
    device = open_device(FORM).within(memory)
    return Renderer(replace(device, target=replace(device.target, max_size=side)), budget=0)


@pytest.fixture(scope="module")
def fitting():
    made = limited()
    yield made
    made.close()


@pytest.fixture
def in_pieces(monkeypatch):
    """Everything is made in the smallest tiles that there are."""
    monkeypatch.setattr(tiling, "LEAST", 16)
    monkeypatch.setattr(tiling, "_too_much", lambda *_: "a test")
    monkeypatch.setattr(tiling._Work, "_fits", lambda *_: False)


def same_bits(one, other) -> None:
    assert one.keys() == other.keys()
    for name in one:
        assert one[name].dtype == other[name].dtype
        np.testing.assert_array_equal(one[name].view(np.uint8), other[name].view(np.uint8), name)


def remembers(graph) -> bool:
    return any(isinstance(node, Temporal) for node in graph.nodes.values())


def chain(*nodes) -> Graph:
    """Nodes in a row, from `inputs.image` to `outputs.image`."""
    graph, port = Graph().add_input("image", Input(Kind.IMAGE)), Port("inputs", "image")
    for number, node in enumerate(nodes):
        graph = graph.add(f"n{number}", node).connect(port, Port(f"n{number}", "image"))
        port = Port(f"n{number}", "out")
    return graph.add_output("image", Output()).connect(port, Port("outputs", "image"))


def noise(width: int, height: int) -> np.ndarray:
    return np.random.default_rng(width).gamma(0.6, 1.0, (height, width, 4)).astype(np.float32)


# --- the same bits ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [seed for seed in range(12) if not remembers(random_graph(seed))])
def test_random_graphs_have_the_same_bits(fitting, in_pieces, seed):
    plan = fitting.compile(random_graph(seed), Wanted(pictures(seed), precision="float"))
    assert plan.tiling is not None
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


@pytest.mark.parametrize("name", ["auto_exposed", "city_lights", "comic_ink", "lens_character", "neon_edges"])
def test_presets_have_the_same_bits(fitting, in_pieces, name):
    graph = next(document.load(path) for path in paths() if path.stem == name)
    plan = fitting.compile(graph, Wanted(scale=0.04))
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


@pytest.mark.parametrize("edge", ["clamp", "wrap", "reflect", "mirror", "black"])
def test_every_edge_has_the_same_bits(fitting, in_pieces, edge):
    blurs = (NODES["gaussian_blur"](sigma=sigma, edge=edge) for sigma in (2.0, 9.0))
    graph = chain(*blurs, NODES["convolve3x3"](edge=edge))
    plan = fitting.compile(graph, Wanted({"image": noise(83, 47)}, scale=0.9, precision="half"))
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


def test_a_region_has_the_bits_that_it_has_in_the_whole(fitting):
    for seed in range(6):
        graph, wanted = random_graph(seed), Wanted(pictures(seed), precision="float")
        whole = fitting.render(graph, wanted)
        plan = fitting.compile(graph, replace(wanted, region=Region(9, 5, 11, 7)))
        for name, pixels in fitting.runner.run(plan).items():
            part = plan.surfaces[plan.outputs[name]].window
            cut = whole[name][part.y : part.y + part.height, part.x : part.x + part.width] if part else whole[name]
            same_bits({name: pixels}, {name: np.ascontiguousarray(cut)})


# --- what fits -------------------------------------------------------------------------------------------------------


def test_a_device_holds_tiles_of_what_is_too_large_for_it(fitting):
    small, graph = limited(side=64), chain(NODES["bloom"](radius=0.05), NODES["exposure"](stops=1.0))
    wanted = Wanted({"image": noise(150, 90)})
    plan = small.compile(graph, wanted)
    assert plan.tiling is not None and "150x90 pixels is more than the 64" in explain(plan)
    same_bits(small.render(graph, wanted), fitting.render(graph, wanted))
    small.close()


def test_tiles_share_their_programs():
    graph, picture = chain(NODES["gaussian_blur"](sigma=2.0), NODES["convolve3x3"]()), noise(200, 150)
    compiled: list[int] = []
    for side in (100, 40):
        small = limited(side=side)
        small.render(graph, Wanted({"image": picture}))
        compiled.append(small.runner.programs.compiled)
        small.close()
    assert compiled[0] == compiled[1]


def test_no_more_is_held_than_may_be():
    graph = chain(*(NODES["gaussian_blur"](sigma=sigma) for sigma in (2.0, 3.0, 9.0)))
    wanted = Wanted({"image": noise(900, 700)})
    free = limited()
    whole, plan = free.render(graph, wanted), free.compile(graph, wanted)
    free.close()
    memory = 2 * 900 * 700 * 16 + plan.peak_bytes // 4  # both pictures, and a quarter of the textures
    tight = limited(memory=memory)
    tiled = tight.compile(graph, wanted)
    assert tiled.tiling is not None and tiled.tiling.nbytes <= memory
    same_bits(tight.runner.run(tiled), whole)
    assert tight.runner.textures.peak <= plan.peak_bytes // 4
    tight.close()


# --- what cannot be --------------------------------------------------------------------------------------------------


def test_what_is_read_anywhere_must_fit_as_a_whole():
    small = limited(side=64)
    graph = graph_of(NODES["displace"](), {"image": noise(100, 50), "vector": noise(100, 50)[..., :2]})
    with pytest.raises(DeviceError, match=r"node 'node': it may need all 100x50 pixels .* render smaller with --scale"):
        small.compile(graph, Wanted({"image": noise(100, 50), "vector": noise(100, 50)[..., :2]}))
    small.close()


def test_tiles_are_as_large_as_the_device_can_hold(fitting):
    """However much memory the whole picture takes: that is not on the device."""
    wanted = Wanted({"image": noise(100, 50)}, size=(40_000, 20_000))
    made = fitting.compile(chain(NODES["exposure"](stops=1.0)), wanted).tiling
    assert made is not None and len(made.stages[-1].tiles) <= 16


def test_memory_that_no_tile_fits_into_is_refused():
    tight = limited(memory=2**16)
    with pytest.raises(DeviceError, match=r"only 64.0 KiB may be used; give more with --memory"):
        tight.compile(chain(NODES["convolve3x3"]()), Wanted({"image": noise(100, 50)}))
    tight.close()


def test_what_remembers_frames_is_refused():
    tight = limited(memory=2**17)
    with pytest.raises(DeviceError, match="node 'n0': what it remembers of a frame"):
        tight.compile(chain(NODES["light_trails"]()), Wanted({"image": noise(100, 50)}))
    tight.close()
