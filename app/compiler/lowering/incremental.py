"""Lowers again only what changed of a graph that was lowered before.

While a slider is dragged, or a sequence rendered, the same graph is planned again and again with other numbers.
Lowering is the slowest part of that, and nearly all of it would come out as before.

Nodes are lowered one after the other. What a node adds to the program depends on three things: on itself, on the
operands that it is fed, and on those operations of other nodes that it inspects (a transform that is merged with the
one before it, say); of all other operations it knows at most the shape. Each `LoweringStep` records what a node added,
which operations it inspected, and whether the frame or something outside of the graph decided. So the nodes that must
be lowered again are known: those with other values, those that read the frame or a file, those that inspected an
operation that changed, and those that are fed another constant.

`ReplayBuilder` puts what such a node adds in the places of what it added before. If these are as many operations, of
the same shapes, then no node that only reads them can tell the difference, and it need not be lowered again. If not,
the structure changed: `StructureChanged` is raised, and the whole graph is lowered anew. This is always correct, so the
fast way may give up whenever it is not sure.

Equal operations share a place, which makes one thing subtle. Say two equal nodes added the same operation, and one of
them changes: its operation must become another one, while the other node keeps the old one. So two things are checked
at the end. First, all steps that added to a place whose operation changed must have been replayed, to the same result.
Second, no two places may hold equal operations, since lowering anew would give them one place. Otherwise the structure
changed.

The result is the same as from the start, to the last bit: `tests/compiler/test_planner.py` compares the two for random
edits of random graphs.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from msgspec.structs import replace

from ...errors import HalationError
from ...graph import Graph
from ...resources.provider import ResourceProvider
from ..ir import Builder, Op, Ref
from ..request import Request
from .graph_at_frames import GraphAtFrames, sees_other_frames
from .lower import Lowering
from .steps import LoweringRecord, LoweringStep, PortAtOffset, StepKey


class StructureChanged(Exception):
    """The program differs in more than single operations."""


def lower_again(
    before: LoweringRecord, graph: Graph, request: Request, provider: ResourceProvider
) -> LoweringRecord | None:
    """Lower `graph`, much like the one that was lowered `before`, with the same library.

    The request may differ from that of before in its frame, bindings and memories alone. Returns None where the whole
    graph must be lowered.
    """
    try:
        frames = before.frames.follow(graph, before.frame, request.frame)
        return _IncrementalLowering(before, graph, request, provider, frames).run() if frames else None
    except (StructureChanged, HalationError):  # an error is found again, and reported, when all is lowered
        return None


class ReplayBuilder(Builder):
    """Puts what a step adds in the places of what it added before."""

    def __init__(self, before: Builder) -> None:
        super().__init__()
        self._before = before
        self.ops, self.numbers = [*before.ops], before.numbers
        self.changed: set[int] = set()
        """Operations that are not equal to what was in their places."""
        self._counts: dict[int, int] = {}
        """How often each operation was added again."""
        self._step = LoweringStep(0, [], [])

    def begin(self, step: LoweringStep) -> None:
        """Expect what a step added."""
        self._step = step

    def add(self, op: Op) -> Ref:
        """Replace an operation that this step was the first one to add; all others must be as they are."""
        if len(self.added) == len(self._step.added):
            raise StructureChanged
        number = self._step.added[len(self.added)]
        old = self.ops[number]
        if number >= self._step.first and number not in self._counts:
            if op.shapes != old.shapes or op.owners != old.owners:
                raise StructureChanged
            self.ops[number] = op
            if op != self._before.ops[number]:
                self.changed.add(number)
        elif op != old:
            raise StructureChanged
        self._counts[number] = self._counts.get(number, 0) + 1
        self.added.append(number)
        return Ref(number)

    def finish(self, counts: Mapping[int, int]) -> Builder:
        """A builder of all operations, if those are equal that were before; `counts` is how often each was added."""
        if any(self._counts[number] != counts[number] for number in self.changed):
            raise StructureChanged
        finished = Builder()
        finished.ops, finished.numbers = self.ops, dict(self.numbers) if self.changed else self.numbers
        for number in self.changed:
            del finished.numbers[self._before.ops[number]]
        for number in self.changed:
            if finished.numbers.setdefault(self.ops[number], number) != number:
                raise StructureChanged
        return finished


class _IncrementalLowering:
    """The work in progress."""

    def __init__(
        self, before: LoweringRecord, graph: Graph, request: Request, provider: ResourceProvider, frames: GraphAtFrames
    ) -> None:
        self.before, self.frames, self.frame = before, frames, request.frame
        self.builder = ReplayBuilder(before.builder)
        self.lowering = Lowering(graph, request, before.library, provider, frames, self.builder)
        self.lowering.results = dict(before.results)
        self.lowering.whole_heights |= {
            key: step.whole_height for key, step in before.steps.items() if step.whole_height
        }
        self.changed_constants: set[PortAtOffset] = set()
        """Ports that stand for another constant than before."""

    def run(self) -> LoweringRecord:
        """Replay the steps that may come out differently, in order: each one may affect those after it.

        A step is replayed if it reads files or its values at other times, reads a frame that changed, has a changed
        node, or looked at an operation or a constant that changed. All other steps keep their operations.
        """
        before, lowering = self.before, self.lowering
        if before.canvas is not None and lowering.pictures.canvas != before.canvas:
            raise StructureChanged
        steps: dict[StepKey, LoweringStep] = dict(before.steps)
        frame_changed = self.frame != before.frame
        offsets = {key[1] for key in steps if key}
        changed_nodes = {offset: self.frames.nodes_changed_at(self.frame + offset) for offset in offsets}
        for key, step in before.steps.items():
            if (
                step.reads_resources
                or step.reads_other_times
                or (step.reads_frame and frame_changed)
                or (key is not None and key[0] in changed_nodes[key[1]])
                or not self.builder.changed.isdisjoint(step.inspected)
                or (self.changed_constants and not self.changed_constants.isdisjoint(self._find_sources(key)))
            ):
                steps[key] = self._replay(key, step)
        builder = self.builder.finish(before.counts)
        program = replace(
            before.program,
            ops=tuple(builder.ops),
            frame=self.frame,
            cameras=MappingProxyType({**before.program.cameras, **lowering.cameras}),
        )
        return replace(
            before,
            program=program,
            frames=self.frames,
            frame=self.frame,
            builder=builder,
            steps=steps,
            results=lowering.results,
            canvas=lowering.pictures.canvas if lowering.pictures.canvas_is_read else None,
        )

    def _check_times(self, path: str, offset: int) -> None:
        """Raise StructureChanged for a node that looks at other frames than before."""
        frame = self.frame + offset
        node = self.frames.node_at(path, frame)
        if sees_other_frames(node) and node.times(frame) != self.before.frames.node_at(path, frame).times(frame):
            raise StructureChanged

    def _find_sources(self, key: StepKey) -> set[PortAtOffset]:
        """The ports that a step reads."""
        if key is None:
            return {(port, 0) for port in self.lowering.find_sources().values()}
        feeds = self.frames.find_feeds((key[0], self.frame + key[1])).values()
        return {(source, frame - self.frame) for source, frames in feeds for frame in frames}

    def _replay(self, key: StepKey, before: LoweringStep) -> LoweringStep:
        """Lower a node again. All that other steps may know of it must be as before, except constants."""
        lowering = self.lowering
        if key is not None:
            self._check_times(*key)
        for port in before.results:
            del lowering.results[port]
        self.builder.begin(before)
        step = lowering.run_step(key)
        step.first = before.first
        if len(step.added) != len(before.added) or step.memories != before.memories:
            raise StructureChanged
        if step.whole_height != before.whole_height:
            raise StructureChanged
        if step.results.keys() != before.results.keys() or step.cameras.keys() != before.cameras.keys():
            raise StructureChanged
        if key is None and lowering.outputs != self.before.program.outputs:
            raise StructureChanged
        for port, operand in step.results.items():
            old = before.results[port]
            if operand == old:
                continue
            if isinstance(operand, Ref) or isinstance(old, Ref):
                raise StructureChanged
            self.changed_constants.add(port)
        return step
