"""Textures are not in memory longer than they are needed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from halation.graph import Graph, Input, Output, Port
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.merge.merge import Merge
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from resident import count_resident, needs_proc


@pytest.fixture
def engine() -> Iterator[Renderer]:
    made = Renderer(budget=0, sandbox=UNRESTRICTED)
    yield made
    made.close()


def blurred_over() -> Graph:
    """The blurred input `a` over the input `b`, which only the last pass reads."""
    graph = Graph().add_input("a", Input()).add_input("b", Input()).add_output("image", Output())
    graph = graph.add("soft", GaussianBlur(sigma=3.0)).add("over", Merge())
    graph = graph.connect(Port("inputs", "a"), Port("soft", "image")).connect(Port("inputs", "b"), Port("over", "b"))
    return graph.connect(Port("soft", "out"), Port("over", "a")).connect(Port("over", "out"), Port("outputs", "image"))


@needs_proc
def test_released_textures_leave_the_memory(engine: Renderer) -> None:
    """The driver keeps what the last program read, until it runs another one."""
    picture = np.ones((1024, 2048, 4), np.float32)
    plan = engine.compile(blurred_over(), RenderRequest({"a": picture, "b": picture}, precision="float"))
    lease = engine.runner.create_lease()
    with engine.runner.start_run(plan, lease) as run:
        for _ in run:
            pass
    before = count_resident()
    engine.runner.release_unused()
    assert before - count_resident() > 1.9 * picture.nbytes
    np.testing.assert_allclose(engine.runner.download(plan)["image"], 1.0, rtol=1e-5)
    lease.close()
