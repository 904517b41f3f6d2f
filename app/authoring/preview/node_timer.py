"""Measures how long a node takes in full HD on the device of a window, as the manual does, without holding it up.

Passes run band by band, each of which the device times, so that the window draws frames in between. How long a pass
takes is not known before it has run, so it first runs on a smaller picture.
"""

from __future__ import annotations

import time
from collections.abc import Generator

from halation.nodes import Node, Size

from ...compiler import Pass
from ...errors import DeviceError, HalationError
from ...reference.node_page import make_example
from ...reference.specimen import FULL_HD, NODE, name_specimen
from ...renderer import Renderer, RenderRequest, Run
from .picture_job import STEP_SECONDS
from .stepwise import StepwiseWork

_TRIAL = (640, 360)
"""A ninth of the pixels of full HD. The sample is fitted into both by the same program."""

_SIZES = (_TRIAL, _TRIAL, FULL_HD, FULL_HD)
"""The sizes at which a node runs. Drivers finish programs in the first run of each size; the last one counts."""


class NodeTimer(StepwiseWork):
    """Measures one node at a time, on a renderer of its own, which keeps no results and is closed afterwards."""

    def __init__(self, renderer: Renderer) -> None:
        super().__init__()
        self._main = renderer
        self.node: type[Node] | None = None
        """The node that is being measured, or was measured last."""
        self.seconds: dict[type[Node], float] = {}
        """What was measured."""
        self.fault = ""
        """Why `node` could not be measured."""

    @property
    def is_measuring(self) -> bool:
        """True until `node` is measured."""
        return self._steps is not None

    def measure(self, node: type[Node]) -> None:
        """Begin to measure a node."""
        self.stop()
        self.node, self.fault = node, ""
        self.seconds.pop(node, None)
        self._steps = self._measure(node)

    def _note_failure(self, error: HalationError) -> None:
        self.fault = str(error)

    def _measure(self, node: type[Node]) -> Generator[None]:
        renderer = Renderer(self._main.device, budget=0, sandbox=self._main.sandbox)
        renderer.library = self._main.library
        seconds = 0.0
        try:
            with name_specimen(node):
                for size in _SIZES:
                    seconds = yield from _time_passes(renderer, node, size)
        finally:
            renderer.close()
        self.seconds[node] = seconds


def _time_passes(renderer: Renderer, node: type[Node], size: Size) -> Generator[None, None, float]:
    """Run the graph that shows a node; the seconds of the passes that it takes part in."""
    plan = renderer.compile(make_example(node), RenderRequest(size=size))
    if plan.tiling is not None:
        raise DeviceError(plan.tiling.why)
    runner = renderer.runner
    inputs, outputs = runner.create_lease(), runner.create_lease()
    seconds = 0.0
    try:
        read = {number for render_pass in plan.passes for number in render_pass.textures}
        uploads = read & {upload.surface for upload in plan.uploads}
        yield from _finish(runner.start_run(plan, inputs, uploads))
        requested = (*plan.outputs.values(), *plan.remembered)
        with runner.start_run(plan, outputs, requested) as run:
            while run.passes_done < len(plan.passes):
                render_pass = plan.passes[run.passes_done]
                spent = yield from _time_pass(renderer, run, render_pass)
                seconds += spent if NODE in render_pass.nodes else 0.0
        return seconds
    finally:
        inputs.close()
        outputs.close()


def _finish(run: Run) -> Generator[None]:
    with run:
        while not run.is_ready or run.step(STEP_SECONDS):
            yield


def _time_pass(renderer: Renderer, run: Run, render_pass: Pass) -> Generator[None, None, float]:
    """Run the next pass of a run; its seconds on the device, or those that pass by while the processor works on it."""

    def step() -> None:
        run.step(STEP_SECONDS)

    started, passes_done = time.perf_counter(), run.passes_done
    while not run.is_ready:
        yield
    seconds = 0.0 if render_pass.host is None else time.perf_counter() - started
    while run.passes_done == passes_done:
        with renderer.device.make_current():
            seconds += renderer.device.time(step)
        yield
    return seconds
