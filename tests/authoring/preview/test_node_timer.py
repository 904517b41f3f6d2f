"""How long a node takes, measured in steps between the frames of a window."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any, cast

import pytest
from halation.authoring.preview import node_timer
from halation.authoring.preview.node_timer import NodeTimer
from halation.errors import DeviceError
from halation.nodes import Node
from halation.nodes.color.exposure import Exposure
from halation.nodes.glow.bloom import Bloom
from halation.reference.node_page import describe_time, make_example
from halation.reference.specimen import NODE
from halation.renderer import Device, Renderer, RenderRequest

SIZE = (96, 54)


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sizes that take milliseconds."""
    monkeypatch.setattr(node_timer, "_SIZES", (SIZE, SIZE))


class CountingDevice:
    """A device that says of each part of a pass that it took one second, and counts them."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self.parts = 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._device, name)

    def time(self, work: Callable[[], None]) -> float:
        work()
        self.parts += 1
        return 1.0


class CountingRenderer:
    """What a timer asks of the renderer of the window, with a device that counts."""

    def __init__(self, renderer: Renderer) -> None:
        self.device = CountingDevice(renderer.device)
        self.sandbox, self.library = renderer.sandbox, renderer.library


def run(timer: NodeTimer, node: type[Node]) -> None:
    timer.measure(node)
    assert timer.is_measuring and timer.node is node
    while timer.work():
        pass
    assert not timer.is_measuring


def count_passes(renderer: Renderer, node: type[Node]) -> tuple[int, int]:
    """The passes of the graph that shows a node, and those that the node takes part in."""
    plan = renderer.compile(make_example(node), RenderRequest(size=SIZE))
    return len(plan.passes), sum(NODE in render_pass.nodes for render_pass in plan.passes)


@pytest.mark.parametrize("node", [Exposure, Bloom])
def test_the_passes_of_the_node_count_once_each(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch, node: type[Node]
) -> None:
    monkeypatch.setattr(node_timer, "STEP_SECONDS", math.inf)
    counting = CountingRenderer(renderer)
    timer = NodeTimer(cast("Renderer", counting))
    run(timer, node)
    passes, of_node = count_passes(renderer, node)
    assert timer.seconds == {node: of_node} and counting.device.parts == 2 * passes and not timer.fault


def test_a_long_pass_is_divided(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(node_timer, "_SIZES", (SIZE, SIZE, SIZE))
    monkeypatch.setattr(node_timer, "STEP_SECONDS", 1e-9)
    counting = CountingRenderer(renderer)
    timer = NodeTimer(cast("Renderer", counting))
    run(timer, Exposure)
    passes, of_node = count_passes(renderer, Exposure)
    assert counting.device.parts > 3 * passes and timer.seconds[Exposure] > of_node


def test_the_time_is_a_part_of_the_time_that_passes(renderer: Renderer) -> None:
    timer, started = NodeTimer(renderer), time.perf_counter()
    run(timer, Exposure)
    assert 0.0 < timer.seconds[Exposure] < time.perf_counter() - started


def test_what_cannot_be_measured_says_why(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(node: type[Node]) -> None:
        raise DeviceError("no memory is left")

    timer = NodeTimer(renderer)
    with monkeypatch.context() as patch:
        patch.setattr(node_timer, "make_example", fail)
        run(timer, Exposure)
    assert timer.fault == "no memory is left" and not timer.seconds
    run(timer, Exposure)
    assert not timer.fault and timer.seconds


def test_a_page_that_is_closed_ends_it(renderer: Renderer) -> None:
    timer = NodeTimer(renderer)
    timer.measure(Bloom)
    for _ in range(8):
        assert timer.work()
    timer.stop()
    assert not timer.is_measuring and not timer.work() and not timer.seconds
    run(timer, Exposure)
    assert timer.seconds.keys() == {Exposure}


def test_times_are_written_with_what_repeats_of_them() -> None:
    assert describe_time(0.0834, "llvmpipe") == "It takes 83 ms with llvmpipe."
    assert describe_time(0.00123, "a GPU") == "It takes 1.2 ms with a GPU."
    assert describe_time(2.5e-5, "a GPU") == "It takes 0.025 ms with a GPU."
    assert describe_time(12.3456, "llvmpipe") == "It takes 12346 ms with llvmpipe."
