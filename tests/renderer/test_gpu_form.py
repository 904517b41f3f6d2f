"""Passes as a GPU gets them, reading through samplers and keeping color in half floats, run on what there is here."""

from __future__ import annotations

import numpy as np
import pytest
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace
from random_graphs import pictures, random_graph
from selection import list_seeds


@pytest.fixture(scope="module", params=["compute", "fragment"])
def engine(request):
    device = open_device(request.param, sandbox=UNRESTRICTED)
    target = replace(device.target, software=False, precision="half")
    made = Renderer(device.with_target(target), budget=0, sandbox=UNRESTRICTED)
    yield made
    made.close()


@pytest.mark.parametrize("seed", list_seeds(4, 8))
def test_pixels_are_those_of_the_software_form(engine, renderer, seed):
    graph, wanted = random_graph(seed), RenderRequest(pictures(seed), precision="float")
    here, there = renderer.render(graph, wanted), engine.render(graph, wanted)
    for name in here:
        np.testing.assert_allclose(there[name], here[name], rtol=1e-6, atol=1e-6, err_msg=name)


def test_nothing_is_read_through_image_units(engine):
    plan = engine.compile(random_graph(2), RenderRequest(pictures(2)))
    assert not any(one.shader.reads_images for one in plan.passes)
    assert any(surface.texel == "rgba16f" for surface in plan.surfaces)
    assert all(surface.texel.endswith("32f") for surface in plan.surfaces if surface.channels < 4)
