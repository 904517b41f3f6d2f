"""Pictures that are made tile by tile have the same bits as those that fit: any nodes, any sizes, both forms of passes."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
import pytest
from halation.app import document
from halation.app.compiler import tiling
from halation.app.errors import DeviceError
from halation.app.renderer import Renderer, Wanted, open_device
from halation.nodes import Temporal
from halation.presets import paths
from random_graphs import pictures, random_graph

FORM = os.environ.get("HALATION_TEST_FORM")


def limited(side: int = 16384, memory: int = 0, fusion: bool = True) -> Renderer:
    """A renderer on a device that holds no more."""
    device = open_device(FORM)
    device = replace(device, target=replace(device.target, max_size=side, memory=memory))
    return Renderer(device, budget=0, fusion=fusion)


@pytest.fixture(scope="module")
def small():
    made = limited(side=24)
    yield made
    made.close()


@pytest.fixture(scope="module")
def fitting():
    made = limited()
    yield made
    made.close()


def same_bits(one, other) -> None:
    assert one.keys() == other.keys()
    for name in one:
        assert one[name].dtype == other[name].dtype
        np.testing.assert_array_equal(one[name].view(np.uint8), other[name].view(np.uint8), name)


@pytest.fixture
def in_pieces(monkeypatch):
    """Everything is made in the smallest tiles that there are."""
    monkeypatch.setattr(tiling, "LEAST", 16)
    monkeypatch.setattr(tiling, "_too_much", lambda *_: "a test")
    monkeypatch.setattr(tiling._Work, "_fits", lambda *_: False)


def remembers(graph) -> bool:
    return any(isinstance(node, Temporal) for node in graph.nodes.values())


GRAPHS = [seed for seed in range(36) if not remembers(random_graph(seed))]


@pytest.mark.parametrize("seed", GRAPHS)
def test_random_graphs_have_the_same_bits(fitting, in_pieces, seed):
    graph, wanted = random_graph(seed), Wanted(pictures(seed), precision="float")
    whole = fitting.runner.run(replace(fitting.compile(graph, wanted), tiling=None))
    tiled = fitting.compile(graph, wanted)
    assert tiled.tiling is not None
    same_bits(fitting.runner.run(tiled), whole)


PRESETS = {path.stem: path for path in paths() if not remembers(document.load(path))}


@pytest.mark.parametrize("name", PRESETS)
def test_presets_have_the_same_bits(fitting, in_pieces, name):
    graph, wanted = document.load(PRESETS[name]), Wanted(scale=0.04, precision="float")
    plan = fitting.compile(graph, wanted)
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))
