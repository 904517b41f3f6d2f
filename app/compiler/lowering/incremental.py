"""Lowers again only what changed of a graph that was lowered before.

Nodes are lowered one after the other, and what one adds depends on itself, on what it is fed, and on the operations
that it looks into: of all others it knows the shape at most. So where a node has other values, it alone is lowered
again. What it adds takes the places of what it added before, if these are as many and have the same shapes: then no
other node could tell the difference, but those that looked, which are lowered again too.

Equal operations share a place. Which do must not change: all that added to a place of which the operation is now
another one must have been lowered again to the same one, and no two places may hold equal ones. Else all is lowered
anew, as it is where anything about the graph but values changed.
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
from .lower import Lowering
from .moments import Moments, looks_around
from .steps import Lowered, Place, Shown, Step


class Other(Exception):
    """The program is another one in more than single operations."""


def relower(known: Lowered, graph: Graph, request: Request, outside: ResourceProvider) -> Lowered | None:
    """Lower `graph`, with the library of what is `known` of another one, for a request that differs from that of then
    in its frame, bindings and memories alone; None where that takes as long as from the start."""
    try:
        moments = known.moments.followed(graph, known.now, request.frame)
        return _Relowering(known, graph, request, outside, moments).run() if moments else None
    except (Other, HalationError):  # what is wrong is found again, and said, by lowering it all
        return None


class Again(Builder):
    """Puts what a step adds in the places of what it added before."""

    def __init__(self, known: Builder) -> None:
        super().__init__()
        self._before = known
        self.ops, self.known = [*known.ops], known.known
        self.changed: set[int] = set()
        """Operations that are not equal to what was in their places."""
        self._times: dict[int, int] = {}
        self._step = Step(0, [], [])

    def begin(self, step: Step) -> None:
        """Expect what a step added."""
        self._step = step

    def add(self, op: Op) -> Ref:
        if len(self.added) == len(self._step.added):
            raise Other
        at = self._step.added[len(self.added)]
        old = self.ops[at]
        if at >= self._step.first and at not in self._times:
            if op.shapes != old.shapes or op.owners != old.owners:
                raise Other
            self.ops[at] = op
            if op != self._before.ops[at]:
                self.changed.add(at)
        elif op != old:
            raise Other
        self._times[at] = self._times.get(at, 0) + 1
        self.added.append(at)
        return Ref(at)

    def settled(self, counts: Mapping[int, int]) -> Builder:
        """All operations, if the same ones are equal as before; `counts` says how often each was added."""
        if any(self._times[at] != counts[at] for at in self.changed):
            raise Other
        made = Builder()
        made.ops, made.known = self.ops, dict(self.known) if self.changed else self.known
        for at in self.changed:
            del made.known[self._before.ops[at]]
        for at in self.changed:
            if made.known.setdefault(self.ops[at], at) != at:
                raise Other
        return made


class _Relowering:
    """The work in progress."""

    def __init__(
        self, known: Lowered, graph: Graph, request: Request, outside: ResourceProvider, moments: Moments
    ) -> None:
        self.known, self.moments, self.now = known, moments, request.frame
        self.builder = Again(known.builder)
        self.lowering = Lowering(graph, request, known.library, outside, moments, self.builder)
        self.lowering.results = dict(known.results)
        self.other: set[Shown] = set()
        """What stands for another constant than before."""

    def run(self) -> Lowered:
        known, lowering = self.known, self.lowering
        if known.canvas is not None and lowering.pictures.canvas != known.canvas:
            raise Other
        steps: dict[Place, Step] = dict(known.steps)
        moved = self.now != known.now
        changed = {away: self.moments.changed(self.now + away) for away in {place[1] for place in steps if place}}
        for place, step in known.steps.items():
            if (
                step.asked
                or (step.timed and moved)
                or (place is not None and place[0] in changed[place[1]])
                or not self.builder.changed.isdisjoint(step.looked)
                or (self.other and not self.other.isdisjoint(self._sources(place)))
            ):
                steps[place] = self._again(place, step)
        builder = self.builder.settled(known.counts)
        program = replace(
            known.program,
            ops=tuple(builder.ops),
            frame=self.now,
            cameras=MappingProxyType({**known.program.cameras, **lowering.cameras}),
        )
        canvas = lowering.pictures.canvas if lowering.pictures.measured else None
        return replace(
            known,
            program=program,
            moments=self.moments,
            now=self.now,
            builder=builder,
            steps=steps,
            results=lowering.results,
            canvas=canvas,
        )

    def _check_times(self, path: str, away: int) -> None:
        frame = self.now + away
        node = self.moments.node(path, frame)
        if looks_around(node) and node.times(frame) != self.known.moments.node(path, frame).times(frame):
            raise Other

    def _sources(self, place: Place) -> set[Shown]:
        """What a step is fed."""
        if place is None:
            return {(port, 0) for port in self.lowering.sources().values()}
        fed = self.moments.feeding((place[0], self.now + place[1])).values()
        return {(source, frame - self.now) for source, frames in fed for frame in frames}

    def _again(self, place: Place, step: Step) -> Step:
        lowering = self.lowering
        if place is not None:
            self._check_times(*place)
        for shown in step.shown:
            del lowering.results[shown]
        self.builder.begin(step)
        made = lowering.step(place)
        made.first = step.first
        if len(made.added) != len(step.added) or made.memories != step.memories:
            raise Other
        if made.shown.keys() != step.shown.keys() or made.cameras.keys() != step.cameras.keys():
            raise Other
        if place is None and lowering.outputs != self.known.program.outputs:
            raise Other
        for shown, operand in made.shown.items():
            old = step.shown[shown]
            if isinstance(operand, Ref) or isinstance(old, Ref):
                if operand != old:
                    raise Other
            elif operand != old:
                self.other.add(shown)
        return made
