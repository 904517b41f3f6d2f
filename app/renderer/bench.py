"""Measures how long a graph takes on this device, pass by pass.

Every pass is waited for. On a GPU a timer query measures it; on a software rasterizer, whose queries leave out most of
the work, the clock does. All passes run in turn and then all again, so that a moment in which the machine is busy with
something else affects all of them alike.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import median

from msgspec import Struct

from ..compiler import Pass, Plan
from ..graph import Graph
from .engine import Renderer, RenderRequest
from .execution.run import PassTimings
from .execution.texture_pool import TextureLease
from .frame_renderer import FrameRenderer

PassName = tuple[tuple[str, ...], tuple[str, ...], int]
"""Identifies a pass in all frames and runs: its nodes, its functions, and how many such passes come before it."""


class PassTiming(Struct, frozen=True):
    """The seconds of a pass in every run, and the bytes of the textures that it reads and writes."""

    nodes: tuple[str, ...]
    functions: tuple[str, ...]
    seconds: tuple[float, ...]
    bytes_read: int
    bytes_written: int

    @property
    def median(self) -> float:
        """The median time."""
        return median(self.seconds)

    @property
    def fastest(self) -> float:
        """The shortest time, which was disturbed the least."""
        return min(self.seconds)


class Benchmark(Struct, frozen=True):
    """Times of all passes in order, totals of all runs (sums of passes), and the times of what happens once.

    `planning` is from graph to plan, `compiling` is the driver's work on programs, `loading` is the first run with all
    files; `lead_frames` is how many frames were rendered before for the history.
    """

    passes: tuple[PassTiming, ...]
    totals: tuple[float, ...]
    size: tuple[int, int]
    planning: float
    compiling: float
    programs: int
    loading: float
    peak_bytes: int
    lead_frames: int

    @property
    def median(self) -> float:
        """Of the whole."""
        return median(self.totals)

    @property
    def fastest(self) -> float:
        """Of the whole."""
        return min(self.totals)


class NodeShare(Struct, frozen=True):
    """The times of all passes of the same nodes: fused nodes share passes and have one time together."""

    nodes: tuple[str, ...]
    count: int
    median: float
    fastest: float
    bytes_read: int
    bytes_written: int


def measure_graph(
    renderer: Renderer,
    graph: Graph,
    request: RenderRequest,
    frames: Sequence[int],
    repeats: int,
    warm_up: int,
    report_step: Callable[[str], None] = lambda name: None,
) -> Benchmark:
    """Measure frames of a graph: each is rendered `warm_up` times unmeasured, then `repeats` times.

    `renderer` must have a budget of 0, because results that are kept would take no time. Raises the errors of
    `app.errors`.
    """
    compiled, started = renderer.runner.programs.compiled, time.perf_counter()
    frame_renderers = {frame: FrameRenderer(renderer, graph, request) for frame in frames}
    plans = {frame: frame_renderer.plan_frame(frame) for frame, frame_renderer in frame_renderers.items()}
    planning, started = time.perf_counter() - started, time.perf_counter()
    _compile_plans(renderer, plans.values())
    compiling = time.perf_counter() - started
    timings: dict[int, list[PassTimings]] = {}
    loading = 0.0
    for frame, reel in frame_renderers.items():  # one after the other: what one remembers is what the next one makes
        started = time.perf_counter()
        report_step(f"frame {frame}")
        lease = load_frame_inputs(renderer, reel, frame)
        reel.close()
        loading += time.perf_counter() - started
        try:
            runs = [renderer.runner.measure(plans[frame]) for _ in range(warm_up + repeats)]
        finally:
            lease.close()
        timings[frame] = runs[warm_up:]
    first = plans[frames[0]]
    outputs = [first.surfaces[number].size for number in first.outputs.values()]
    lead = sum(
        frame - reel.find_history_start(frame) for frame, reel in frame_renderers.items() if plans[frame].memories
    )
    return Benchmark(
        _merge_frames(plans, timings),
        tuple(_sum_runs(timings)),
        outputs[0] if outputs else (0, 0),
        planning,
        compiling,
        renderer.runner.programs.compiled - compiled,
        loading,
        renderer.runner.textures.peak,
        lead,
    )


def _compile_plans(renderer: Renderer, plans: Iterable[Plan]) -> None:
    """Compile the programs of all passes, so that none is compiled while frames are measured."""
    with renderer.device.make_current():
        for plan in plans:
            for render_pass in plan.passes:
                renderer.runner.compile(render_pass)


def group_by_nodes(passes: Iterable[PassTiming]) -> tuple[NodeShare, ...]:
    """The passes grouped by their nodes, the slowest first."""
    timings_by_nodes: dict[tuple[str, ...], list[PassTiming]] = {}
    for timing in passes:
        timings_by_nodes.setdefault(timing.nodes, []).append(timing)
    shares = (
        NodeShare(
            nodes,
            len(timings),
            median(map(sum, zip(*(timing.seconds for timing in timings), strict=True))),
            min(map(sum, zip(*(timing.seconds for timing in timings), strict=True))),
            sum(timing.bytes_read for timing in timings),
            sum(timing.bytes_written for timing in timings),
        )
        for nodes, timings in timings_by_nodes.items()
    )
    return tuple(sorted(shares, key=lambda share: -share.median))


def identify_passes(passes: Iterable[Pass | PassTiming]) -> list[PassName]:
    """The names of passes, in order."""
    counts: dict[tuple[tuple[str, ...], tuple[str, ...]], int] = {}
    names: list[PassName] = []
    for render_pass in passes:
        key = (render_pass.nodes, render_pass.functions)
        counts[key] = counts.get(key, -1) + 1
        names.append((*key, counts[key]))
    return names


def load_frame_inputs(renderer: Renderer, frame_renderer: FrameRenderer, frame: int) -> TextureLease:
    """Load what a frame reads onto the device: pixels of files, and what the frame before stored."""
    plan, runner = frame_renderer.plan_frame(frame), renderer.runner
    lease, outputs_lease = runner.create_lease(), runner.create_lease()
    written = {number for render_pass in plan.passes for number in render_pass.targets}
    inputs = [number for render_pass in plan.passes for number in render_pass.textures if number not in written]
    uploads = {item.surface for item in plan.uploads}
    try:
        for run in frame_renderer.start_runs(frame, outputs_lease):
            with run:
                if run.plan is plan:
                    for number in set(inputs) - uploads:
                        lease.add(plan.surfaces[number].key)
                for _ in run:
                    pass
        with runner.start_run(plan, lease, uploads & set(inputs)) as run:
            for _ in run:
                pass
    finally:
        outputs_lease.close()
    return lease


def _merge_frames(plans: Mapping[int, Plan], timings: Mapping[int, Sequence[PassTimings]]) -> tuple[PassTiming, ...]:
    """The passes of all frames; a pass that several frames have is one, with the times of all."""
    merged: dict[PassName, PassTiming] = {}
    for frame, turns in timings.items():
        plan = plans[frame]
        for run_timings in turns:
            for name, (render_pass, seconds) in zip(
                identify_passes(timed_pass for timed_pass, _ in run_timings), run_timings, strict=True
            ):
                before = merged[name].seconds if name in merged else ()
                read = sum(plan.surfaces[number].nbytes for number in render_pass.textures)
                written = sum(plan.surfaces[number].nbytes for number in render_pass.targets)
                merged[name] = PassTiming(render_pass.nodes, render_pass.functions, (*before, seconds), read, written)
    return tuple(merged.values())


def _sum_runs(timings: Mapping[int, Sequence[PassTimings]]) -> list[float]:
    return [sum(seconds for _, seconds in run_timings) for turns in timings.values() for run_timings in turns]
