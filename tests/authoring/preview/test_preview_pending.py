"""A preview waits for renders that are still being looked at, and never stands still for them."""

from __future__ import annotations

import time

import numpy as np
import pytest
from exr_files import write_exr
from halation.authoring.background.render_overviews import OverviewPending
from halation.graph import Graph, Port
from halation.nodes.input.constant import Constant
from halation.nodes.input.read_render import ReadRender
from halation.render_layers.render import read_render
from halation.resources.sandbox import UNRESTRICTED


@pytest.fixture
def graph(tmp_path) -> Graph:
    layers = {"beauty": np.full((4, 6, 4), 0.5, np.float32), "depth": np.full((4, 6, 1), 3.0, np.float32)}
    path = write_exr(tmp_path / "shot.exr", layers, dict.fromkeys(layers, "float"))
    return Graph().add("render", ReadRender(path=str(path)))


def worked(preview) -> None:
    end = time.monotonic() + 120.0
    while (preview.work(0.1) or preview.busy) and time.monotonic() < end:
        time.sleep(0.002)
    assert not preview.busy, "this never came to an end"


def test_nothing_is_compiled_until_it_is_known(engine, preview, graph):
    ready, asked = [], []

    def look(path, named):
        asked.append(path)
        if not ready:
            raise OverviewPending(path, lambda: bool(ready))
        return read_render(path, named, sandbox=UNRESTRICTED)

    engine.pictures.describer = look
    preview.want(graph, {"A": Port("render", "depth")})
    for _ in range(20):
        preview.work(0.01)
    assert len(asked) == 1 and preview.busy and preview.find_whole_image("A") is None and not preview.faults
    ready.append(True)
    worked(preview)
    assert len(asked) == 2 and preview.find_whole_image("A") is not None and not preview.faults


def test_another_wish_does_not_wait(engine, preview, graph):
    def never(path, named):
        raise OverviewPending(path, lambda: False)

    engine.pictures.describer = never
    preview.want(graph, {"A": Port("render", "depth")})
    preview.work(0.01)
    preview.want(Graph().add("plain", Constant()), {"A": Port("plain", "out")})
    worked(preview)
    assert preview.find_whole_image("A").port == Port("plain", "out")
