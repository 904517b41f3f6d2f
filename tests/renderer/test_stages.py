"""Where a job with a memory is cut into stages, against what depends on what, searched from each surface."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from halation import document
from halation.compiler import NULL, Plan
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import catalogue
from halation.presets import paths
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.renderer.jobs.shared_results import find_ahead_surfaces, has_stages
from halation.resources.sandbox import UNRESTRICTED
from null_device import NullDevice

PRESETS = {path.stem: path for path in paths()}
MOVING = ("feedback_tunnel", "light_painting", "long_exposure", "turntable")
STILL = ("heartbeat", "soft_bloom", "comic_ink")
NODES = catalogue()


@pytest.fixture(scope="module")
def renderer() -> Iterator[Renderer]:
    engine = Renderer(NullDevice(NULL), budget=0, sandbox=UNRESTRICTED)
    yield engine
    engine.close()


def plan_second_frame(renderer: Renderer, graph: Graph, request: RenderRequest) -> Plan:
    """The plan of the second frame, which reads what the first one has stored."""
    frames = FrameRenderer(renderer, graph, request)
    plan = frames.plan_frame(frames.frames[0] + 1)
    frames.close()
    return plan


class Search:
    """What surfaces of a plan depend on, found anew for each of them."""

    def __init__(self, plan: Plan) -> None:
        self.makers = {number: each for each in plan.passes for number in each.targets}
        self.uploaded = {item.surface for item in plan.uploads}

    def is_of_earlier_frames(self, surface: int) -> bool:
        if surface in self.uploaded:
            return False
        if surface not in self.makers:
            return True
        return any(map(self.is_of_earlier_frames, self.makers[surface].textures))

    def find_makers(self, surface: int) -> Iterator[Any]:
        if surface in self.makers:
            yield self.makers[surface]
            for number in self.makers[surface].textures:
                yield from self.find_makers(number)


def check(plan: Plan) -> tuple[set[int], bool]:
    """Compare both answers with the search, and return them."""
    search = Search(plan)
    history = [each for number in plan.remembered for each in search.find_makers(number)]
    wanted = [each for number in plan.outputs.values() for each in search.find_makers(number)]
    following = [each for each in history if any(map(search.is_of_earlier_frames, each.textures))]
    expected = {
        number
        for each in following
        for number in each.textures
        if number in search.makers and not search.is_of_earlier_frames(number)
    }
    found = find_ahead_surfaces(plan)
    assert {*found} == expected and len(found) == len(expected)
    stages = bool(expected) or any(each not in history for each in wanted)
    assert has_stages(plan) is stages
    return expected, stages


@pytest.mark.parametrize("name", [*MOVING, *STILL])
def test_presets_are_cut_where_memory_begins(renderer: Renderer, name: str) -> None:
    graph = document.load(PRESETS[name], sandbox=UNRESTRICTED)
    plan = plan_second_frame(renderer, graph, RenderRequest(scale=0.25))
    assert bool(plan.remembered) == (name in MOVING)
    check(plan)


@pytest.mark.parametrize(
    ("nodes", "ahead", "stages"),
    [
        (("feedback",), 0, False),  # all of it is history, and it reads what any process can
        (("gaussian_blur", "feedback"), 1, True),  # the blur of each frame
        (("feedback", "gaussian_blur"), 0, True),  # the blur of what is stored
        (("gaussian_blur", "feedback", "gaussian_blur"), 1, True),
        (("gaussian_blur",), 0, True),
    ],
    ids=str,
)
def test_a_row_of_nodes(renderer: Renderer, nodes: tuple[str, ...], ahead: int, stages: bool) -> None:
    graph, port = Graph(settings=Settings(frames=(1, 3))).add_input("image", Input()), Port("inputs", "image")
    for number, id in enumerate(nodes):
        node = NODES[id](**({"sigma": 9.0} if id == "gaussian_blur" else {}))
        graph = graph.add(f"n{number}", node).connect(port, Port(f"n{number}", "image"))
        port = Port(f"n{number}", "out")
    graph = graph.add_output("image", Output()).connect(port, Port("outputs", "image"))
    request = RenderRequest({"image": np.zeros((64, 96, 4), np.float32)})
    expected, are_stages = check(plan_second_frame(renderer, graph, request))
    assert (len(expected), are_stages) == (ahead, stages)
