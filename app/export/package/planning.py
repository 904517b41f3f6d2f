"""Plans a graph at points of its knobs, for frames with and without a memory of the frame before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from halation.nodes import Value
from msgspec import Struct

from ...compiler import Memory, Plan, Planner, Request, Target
from ...compiler.knobs import FRAME, GraphSampler, Knob, Point, find_knob_controls
from ...errors import GraphError, describe_owner
from ...graph import Graph, Port
from ...inputs.provider import MediaProvider
from ..order import ExportOrder
from .curves import PairSamples
from .sampling import BESIDE, KnobSampler, Sample, take_apart
from .variants import Span

_MARGIN = 0.1
"""Checks stay so far from both ends of a slider, as a part of it: curves have samples there. Chosen by judgement."""

TARGET = Target("a package", 410, software=False, form="fragment", precision="float", max_samplers=16, max_targets=8)
"""What plans are made for: fragment passes with buffers of 32 bits, as WebGL 2 and OpenGL 3.3 can run them."""

OUTPUT = "image"
USUAL_FRAMES = 120
"""Frames of a graph that changes with time and names no range: five seconds at 24 frames per second."""

MAX_FRAMES = 240
"""Frames whose numbers a package holds. Chosen by judgement: ten seconds."""

GRID = 9
"""Values of each of two knobs that change the same numbers. With 9 the picture of the preset soft_bloom, whose size and
spread do, differs by less than a step of 8 bits."""

CHECKS = 4
"""Points at which all knobs are elsewhere, to see how the curves of several knobs are joined."""


class Phase(Struct, eq=False):
    """The first frame, or all frames after it: what nodes remember, and samples of the graph with these memories."""

    memories: Mapping[Port, Memory]
    sampler: GraphSampler[Sample]

    def take(self, point: Point) -> Sample:
        """The sample at a point. Raises the errors of planning the graph."""
        return self.sampler.take(point)


class PointPlanner:
    """Plans one output of a graph at points, and remembers the samples."""

    def __init__(self, order: ExportOrder, game: str = "") -> None:
        """`game` is what draws over pictures alone, for which meshes are refused."""
        self.order, self.graph, self.game = order, order.graph, game
        self.provider = MediaProvider(sandbox=order.sandbox)
        self.controls, self.remarks = find_knob_controls(self.graph, _has_input)
        self._bindings = self.provider.bind(self.graph, order.inputs)
        self.first, self.last = self._find_frames()
        self.remembers = False
        """Whether nodes remember earlier frames."""

    def begin_phase(self, memories: Mapping[Port, Memory]) -> Phase:
        """A phase with these memories. It has a planner of its own, which is fast where plans follow each other."""
        planner = Planner()

        def plan(graph: Graph, point: Point) -> Sample:
            plan = self._plan(planner, graph, memories, frame=round(point.get(FRAME, self.first)))
            self.remembers = self.remembers or bool(plan.memories)
            return take_apart(plan, self.provider.load_pixels)

        return Phase(memories, GraphSampler(self.graph, self.controls, plan))

    def plan_draft(self, scale: float) -> Sample:
        """The first frame of the graph as it is, smaller. Raises the errors of planning the graph."""
        return take_apart(self._plan(Planner(), self.graph, {}, self.first, scale), self.provider.load_pixels)

    def take_along(
        self, rest: Sample, point: Point, knob: Knob, places: Sequence[float], phase: Phase
    ) -> dict[float, Sample]:
        """Samples along a knob with the passes of `rest`: at places, or beside them where a node is left out."""
        samples: dict[float, Sample] = {}
        for x in places:
            sample = phase.take({**point, knob.name: x})
            if sample.structure != rest.structure and not knob.is_whole:
                sample = phase.take({**point, knob.name: _step_aside(x, knob)})
            if sample.structure == rest.structure:
                samples[x] = sample
        return samples

    def find_base(self, knobs: list[Knob], phase: Phase) -> dict[str, float]:
        """A point near the settings of the graph at which no node is left out."""
        base = {knob.name: knob.rest for knob in knobs}
        for knob in knobs:
            if knob.is_whole or knob.high == knob.low:
                continue
            beside = {**base, knob.name: _step_aside(knob.rest, knob)}
            if phase.take(base).structure != phase.take(beside).structure:
                base = beside
        return base

    def sample_knob(self, knob: Knob, base: Point, phase: Phase) -> dict[float, Sample]:
        """Samples over the range of a knob, while all others rest."""
        is_dense = knob.name == FRAME and bool(self.graph.animation)
        return KnobSampler(phase.sampler.try_take, base, knob, is_dense).sample_range()

    def sample_checks(
        self, middle: Point, knobs: list[Knob], spans: Mapping[str, Span], rest: Sample, phase: Phase
    ) -> list[tuple[Point, Sample]]:
        """Samples at points where all knobs are elsewhere."""
        random = np.random.default_rng(7)
        checks: list[tuple[Point, Sample]] = []
        for _ in range(CHECKS):
            point = dict(middle)
            for knob in knobs:
                span = spans.get(knob.name)
                low, high = (span.low, span.high) if span else (knob.low, knob.high)
                point[knob.name] = knob.snap(low + (high - low) * (_MARGIN + (1.0 - 2.0 * _MARGIN) * random.random()))
            sample = phase.take(point)
            if sample.structure == rest.structure:
                checks.append((point, sample))
        return checks

    def sample_pairs(
        self, first: tuple[str, list[float]], second: tuple[str, list[float]], middle: Point, rest: Sample, phase: Phase
    ) -> PairSamples:
        """Samples at combinations of two knobs, given with the values that each may have."""
        (first_name, xs), (second_name, ys) = (
            (name, _thin([*places, middle[name]])) for name, places in (first, second)
        )
        rows = [[phase.take({**middle, first_name: x, second_name: y}) for y in ys] for x in xs]
        return xs, ys, [[sample if sample.structure == rest.structure else None for sample in row] for row in rows]

    def _plan(
        self, planner: Planner, graph: Graph, memories: Mapping[Port, Memory], frame: int, scale: float = 1.0
    ) -> Plan:
        target, size = {OUTPUT: self.order.target}, self.order.size
        request = Request(target, self._bindings, size, scale, frame=frame, memories=memories)
        plan = planner.plan(graph, request, self.provider, target=TARGET)
        _refuse_unsuitable(plan, self.game)
        return plan

    def _find_frames(self) -> tuple[int, int]:
        """The frames that the package shows."""
        if self.order.frame is not None:
            return self.order.frame, self.order.frame
        settings = self.graph.settings.frames
        first, last = settings or self.provider.find_frames(self.graph, self._bindings)
        if last == first and settings is None:
            last = first + USUAL_FRAMES - 1
        return first, min(last, first + MAX_FRAMES - 1)


def _has_input(value: Value) -> bool:
    return value.type in ("float", "int", "bool", "color", "vector", "choice")


def _step_aside(x: float, knob: Knob) -> float:
    step = (knob.high - knob.low) * BESIDE
    return x + step if x + step <= knob.high else x - step


def _thin(places: list[float]) -> list[float]:
    """At most `GRID` of the places, with the first, the last, and the one at rest, which comes last in the list."""
    ordered = sorted(set(places))
    chosen = {ordered[round(at * (len(ordered) - 1) / (GRID - 1))] for at in range(GRID)}
    return sorted(chosen | {places[-1]})


def _refuse_unsuitable(plan: Plan, game: str) -> None:
    """Raise GraphError for a plan that other programs cannot run."""
    if plan.tiling is not None:
        raise GraphError(f"{plan.tiling.why}, and a package has no tiles: export it smaller with --size")
    for render_pass in plan.passes:
        if render_pass.shader.foreign:
            owner = render_pass.nodes[-1]
            raise GraphError(
                f"{describe_owner(owner)} is a shader of another format, which a package does not translate: use its "
                "file, or mute the node",
                node=owner,
            )
        if render_pass.host is not None:
            owner = render_pass.nodes[-1]
            raise GraphError(
                f"{describe_owner(owner)} runs on the processor, which an exported effect cannot: "
                "render it to a file first, or mute the node",
                node=owner,
            )
        if render_pass.mesh and game:
            owner = render_pass.nodes[-1]
            raise GraphError(
                f"{describe_owner(owner)} draws meshes, and {game} draws over pictures alone: "
                "render it to a file first",
                node=owner,
            )
