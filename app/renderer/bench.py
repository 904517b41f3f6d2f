"""How long a graph takes on this device, pass by pass.

Every pass is waited for: on a GPU a timer query says what it took there, on a software rasterizer, whose queries leave
most of the work out, the clock does. All passes are gone through in turn and then all again, so that a moment in which
the machine is busy with something else falls on all of them alike.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from ..compiler import Pass, Plan
from ..graph import Graph
from .engine import Renderer, RenderRequest
from .execution.run import Timings
from .execution.texture_pool import Lease
from .frame_renderer import FrameRenderer

Name = tuple[tuple[str, ...], tuple[str, ...], int]
"""What stands for a pass in every frame and every run: its nodes, its functions, and a count of such passes before."""


@dataclass(frozen=True)
class PassTiming:
    """What a pass took, in seconds, every time; and the bytes of the textures that it reads and writes."""

    nodes: tuple[str, ...]
    functions: tuple[str, ...]
    seconds: tuple[float, ...]
    read: int
    written: int

    @property
    def median(self) -> float:
        """Half of the times were shorter."""
        return median(self.seconds)

    @property
    def fastest(self) -> float:
        """The time with the least disturbance."""
        return min(self.seconds)


@dataclass(frozen=True)
class Benchmark:
    """Times of all passes in their order, of the whole (the sum of passes, for each time), and what came first.

    `planning` is graph to plan, `compiling` is programs by the driver, `loading` is the first run with all that is read
    from files; `lead` says how many frames were gone through before, for what nodes remember.
    """

    passes: tuple[PassTiming, ...]
    totals: tuple[float, ...]
    size: tuple[int, int]
    planning: float
    compiling: float
    programs: int
    loading: float
    peak_bytes: int
    lead: int

    @property
    def median(self) -> float:
        """Of the whole."""
        return median(self.totals)

    @property
    def fastest(self) -> float:
        """Of the whole."""
        return min(self.totals)


@dataclass(frozen=True)
class NodeShare:
    """Passes of the same nodes together: what is fused cannot be told apart, and has one time."""

    nodes: tuple[str, ...]
    count: int
    median: float
    fastest: float
    read: int
    written: int


def measure_graph(
    renderer: Renderer,
    graph: Graph,
    wanted: RenderRequest,
    frames: Sequence[int],
    repeats: int,
    warm_up: int,
    step: Callable[[str], None] = lambda name: None,
) -> Benchmark:
    """Measure frames of a graph: each is rendered `warm_up` times unmeasured, then `repeats` times.

    `renderer` has a budget of 0, since what is kept takes no time. Raises the errors of `app.errors`.
    """
    compiled = renderer.runner.programs.compiled
    started = time.perf_counter()
    reels = {frame: FrameRenderer(renderer, graph, wanted) for frame in frames}
    plans = {frame: reel.plan(frame) for frame, reel in reels.items()}
    planning, started = time.perf_counter() - started, time.perf_counter()
    with renderer.device.make_current():
        for plan in plans.values():
            for one in plan.passes:
                renderer.runner.compile(one)
    compiling = time.perf_counter() - started
    timings: dict[int, list[Timings]] = {}
    loading = 0.0
    for frame, reel in reels.items():  # one after the other: what one remembers is what the next one makes
        started = time.perf_counter()
        step(f"frame {frame}")
        given = load_frame_inputs(renderer, reel, frame)
        reel.close()
        loading += time.perf_counter() - started
        try:
            turns = [renderer.runner.measure(plans[frame]) for _ in range(warm_up + repeats)]
        finally:
            given.close()
        timings[frame] = turns[warm_up:]
    first = plans[frames[0]]
    outputs = [first.surfaces[number].size for number in first.outputs.values()]
    lead = sum(frame - reel.history_start(frame) for frame, reel in reels.items() if plans[frame].memories)
    return Benchmark(
        _merge_frames(plans, timings),
        tuple(_sum_turns(timings)),
        outputs[0] if outputs else (0, 0),
        planning,
        compiling,
        renderer.runner.programs.compiled - compiled,
        loading,
        renderer.runner.textures.peak,
        lead,
    )


def group_by_nodes(passes: Iterable[PassTiming]) -> tuple[NodeShare, ...]:
    """The passes by their nodes, what takes longest first."""
    found: dict[tuple[str, ...], list[PassTiming]] = {}
    for one in passes:
        found.setdefault(one.nodes, []).append(one)
    made = (
        NodeShare(
            nodes,
            len(several),
            median(map(sum, zip(*(one.seconds for one in several), strict=True))),
            min(map(sum, zip(*(one.seconds for one in several), strict=True))),
            sum(one.read for one in several),
            sum(one.written for one in several),
        )
        for nodes, several in found.items()
    )
    return tuple(sorted(made, key=lambda share: -share.median))


def identify_passes(passes: Iterable[Pass | PassTiming]) -> list[Name]:
    """What to know passes by, in their order."""
    seen: dict[tuple[tuple[str, ...], tuple[str, ...]], int] = {}
    found: list[Name] = []
    for one in passes:
        key = (one.nodes, one.functions)
        seen[key] = seen.get(key, -1) + 1
        found.append((*key, seen[key]))
    return found


def load_frame_inputs(renderer: Renderer, reel: FrameRenderer, frame: int) -> Lease:
    """What a frame is made of, on the device: pixels of files, and what was remembered before it."""
    plan, runner = reel.plan(frame), renderer.runner
    lease, kept = runner.lease(), runner.lease()
    made = {number for one in plan.passes for number in one.targets}
    given = [number for one in plan.passes for number in one.textures if number not in made]
    uploads = {item.surface for item in plan.uploads}
    try:
        for run in reel.steps(frame, kept):
            with run:
                if run.plan is plan:
                    for number in set(given) - uploads:
                        lease.take(plan.surfaces[number].key)
                for _ in run:
                    pass
        with runner.steps(plan, lease, uploads & set(given)) as run:
            for _ in run:
                pass
    finally:
        kept.close()
    return lease


def _merge_frames(plans: Mapping[int, Plan], timings: Mapping[int, Sequence[Timings]]) -> tuple[PassTiming, ...]:
    """The passes of all frames; the same pass of several is one, with the times of all."""
    found: dict[Name, PassTiming] = {}
    for frame, turns in timings.items():
        plan = plans[frame]
        for taken in turns:
            for name, (one, seconds) in zip(identify_passes(one for one, _ in taken), taken, strict=True):
                before = found[name].seconds if name in found else ()
                read = sum(plan.surfaces[number].nbytes for number in one.textures)
                written = sum(plan.surfaces[number].nbytes for number in one.targets)
                found[name] = PassTiming(one.nodes, one.functions, (*before, seconds), read, written)
    return tuple(found.values())


def _sum_turns(timings: Mapping[int, Sequence[Timings]]) -> list[float]:
    return [sum(seconds for _, seconds in taken) for turns in timings.values() for taken in turns]
