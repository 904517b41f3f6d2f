"""However a graph is run, the pixels are the same: fused or not, as fragment or compute passes, cached or not."""

from __future__ import annotations

from contextlib import closing

import numpy as np
import pytest
from halation.compiler import Form
from halation.compiler.codegen import bodies
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from random_graphs import pictures, random_graph
from selection import list_seeds


@pytest.fixture(scope="module")
def engines():
    """A renderer by form and fusion; none keeps results."""
    made: dict[tuple[Form, bool], Renderer] = {}
    for form in ("compute", "fragment"):
        for fusion in (True, False):
            made[form, fusion] = Renderer(
                open_device(form, sandbox=UNRESTRICTED), budget=0, fusion=fusion, sandbox=UNRESTRICTED
            )
    yield made
    for engine in made.values():
        engine.close()


def same_bits(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> None:
    assert one.keys() == other.keys()
    for name in one:
        np.testing.assert_array_equal(one[name].view(np.uint8), other[name].view(np.uint8), name)


@pytest.mark.parametrize("seed", list_seeds(24, 150))
def test_fused_equals_unfused_to_the_bit(engines, seed):
    graph, wanted = random_graph(seed), RenderRequest(pictures(seed), precision="float")
    same_bits(engines["compute", True].render(graph, wanted), engines["compute", False].render(graph, wanted))


@pytest.mark.parametrize("seed", list_seeds(8, 80))
def test_several_pixels_at_once_are_the_same_to_the_bit(engines, monkeypatch, seed):
    graph, wanted = random_graph(seed), RenderRequest(pictures(seed), precision="float")
    small = engines["compute", True].render(graph, wanted)
    monkeypatch.setattr(bodies, "SMALL_PIXELS", 0)  # now as large pictures
    device = open_device("compute", sandbox=UNRESTRICTED)
    with closing(Renderer(device, budget=0, sandbox=UNRESTRICTED)) as engine:
        same_bits(small, engine.render(graph, wanted))


@pytest.mark.parametrize("seed", list_seeds(16, 80))
def test_both_forms_agree(engines, seed):
    graph, wanted = random_graph(seed), RenderRequest(pictures(seed), precision="float")
    compute = engines["compute", True].render(graph, wanted)
    fragment = engines["fragment", True].render(graph, wanted)
    for name in compute:
        np.testing.assert_allclose(compute[name], fragment[name], rtol=1e-6, atol=1e-6, err_msg=name)


@pytest.mark.parametrize("seed", list_seeds(12, 24))
def test_cached_equals_uncached(engines, renderer, seed):
    graph, wanted = random_graph(seed), RenderRequest(pictures(seed), precision="float")
    first, again = renderer.render(graph, wanted), renderer.render(graph, wanted)
    same_bits(first, again)
    same_bits(first, engines["compute", True].render(graph, wanted))


@pytest.mark.parametrize("seed", list_seeds(12, 24))
def test_measured_peak_is_the_planned_one(seed):
    engine = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    wanted = RenderRequest(pictures(seed), precision="float")
    plan = engine.compile(random_graph(seed), wanted)
    engine.runner.run(plan)
    peak = engine.runner.textures.peak
    assert len({surface.key for surface in plan.surfaces}) == len(plan.surfaces)
    # One frame alone keeps nothing for the next.
    assert peak <= plan.peak_bytes if plan.memories else peak == plan.peak_bytes
    engine.close()


@pytest.mark.parametrize("seed", list_seeds(6, 24))
@pytest.mark.parametrize("pixels", [100, 300])
def test_bands_equal_one_dispatch(renderer, monkeypatch, seed, pixels):
    """Large passes are dispatched in bands, between which an interrupt is heard."""
    from halation.renderer.execution import executor

    graph, wanted = random_graph(seed), RenderRequest(pictures(seed), precision="float")
    whole = renderer.render(graph, wanted)
    monkeypatch.setattr(executor, "BAND_PIXELS", pixels)
    engine = Renderer(open_device("compute", sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED)
    same_bits(engine.render(graph, wanted), whole)
    engine.close()
