"""Renders frames of one graph in any order, each with the history that its temporal nodes need.

Temporal nodes, such as motion trails, read what they stored in the frame before. A frame in the middle of a sequence
therefore depends on all frames before it. A `FrameRenderer` finds out how far back it must go: what a frame stored is
known by key, and if the texture of that key is still on the device, the history up to there is not rendered again. So
frames in order cost one frame each, and a jump costs only the frames in between.

Other processes may render the history instead: a `ResultStore` has the results of their passes, which are then uploaded
and not computed.

The plan of a frame needs only the keys of what the frame before stored, not its pixels. So plans are made frame by
frame without rendering; `plan_next` makes one at a time, for callers that must not wait.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Protocol

from msgspec.structs import replace

from ..compiler import Memory, Plan
from ..errors import UsageError
from ..graph import Graph, Port
from .engine import Renderer, RenderRequest
from .execution.decoding import Array
from .execution.run import PassTimings, Run, find_shared_surfaces
from .execution.texture_pool import TextureLease

MAX_PLANS = 16
"""Plans that are kept: those of the last frames, for playing back and forth. Chosen by judgement: a plan of a large
graph takes about a megabyte, and one that was dropped is compiled again in milliseconds."""

MAX_LEAD_FRAMES = 100_000
"""Frames that are computed for the history of one frame: more than an hour of film at 24 frames per second."""

MAX_CARRIED_BYTES = 2**29
"""Bytes of results that may stay on the device from one frame to the next, beyond what temporal nodes store. Chosen by
judgement, as large as `DEFAULT_BUDGET`: nodes that read neighboring frames share most of their pictures with the next
frame. With less, more of them are computed again."""

Memories = Mapping[Port, Memory]


class ResultStore(Protocol):
    """Has results of passes that other processes have run."""

    def load_pixels(self, plan: Plan, number: int) -> Array | None:
        """The pixels of a surface of a plan as its texture holds them; None where nobody has computed them."""
        ...


class FrameRenderer:
    """Renders frames of a graph in any order; the pixels of a frame are always the same.

    History begins at the first frame of the graph's range, or `preroll` frames before the rendered one if the graph
    says so; a frame before the range has no history. The frame of `request` does not matter. What `store` has is not
    computed again.
    """

    def __init__(
        self, renderer: Renderer, graph: Graph, request: RenderRequest, store: ResultStore | None = None
    ) -> None:
        self.renderer, self.graph, self.request, self._store = renderer, graph, request, store
        self.frames = renderer.find_frames(graph, request)
        """The first and last frame of the range."""
        self._memories: dict[tuple[int, int], Memories] = {}
        """What each frame stores, by the frame where history begins and the frame itself."""
        self._plans: dict[tuple[int, int], Plan] = {}
        self._carried: TextureLease = renderer.runner.create_lease()

    def find_history_start(self, frame: int) -> int:
        """The frame at which the history of another one begins."""
        first, preroll = self.frames[0], self.graph.settings.preroll
        if frame <= first:
            return frame
        return first if preroll is None else max(first, frame - preroll)

    def plan_frame(self, frame: int) -> Plan:
        """The plan of a frame, which reads what the frame before stored. Raises the errors of `app.errors`."""
        return self._plan_from(self.find_history_start(frame), frame)

    def find_lead_frames(self, frame: int) -> range:
        """The frames that must be rendered before a frame, for what they store.

        None if what the frame needs is on the device, or the frame itself is.
        """
        begin, textures = self.find_history_start(frame), self.renderer.runner.textures
        if self._is_on_device(self._plan_from(begin, frame)):
            return range(frame, frame)
        start = frame
        while start > begin and any(item.key not in textures for item in self._find_memories(begin, start).values()):
            start -= 1
        return range(start, frame)

    def plan_next(self, frame: int) -> tuple[int, int] | None:
        """Compile one more of the plans that lead to a frame: how many of how many exist then; None if all do.

        `plan_frame` compiles all of them at once, which takes long far from where the history begins.
        """
        begin = self.find_history_start(frame)
        at = self._find_last_planned(begin, frame)
        if frame > begin and at + 1 < frame and self._memories.get((begin, at), True):
            self._plan_from(begin, at + 1)
        elif (begin, frame) not in self._plans:
            self._plan_from(begin, frame)
        else:
            return None
        return at + 2 - begin, frame + 1 - begin

    def start_runs(
        self, frame: int, outputs_lease: TextureLease, timings: PassTimings | None = None, following: Plan | None = None
    ) -> Iterator[Run]:
        """The runs that make a frame, one after the other; the last one is the frame itself.

        At the end `outputs_lease` holds its outputs. Results that the plan `following` has too stay on the device until
        another frame is rendered here or this renderer is closed.
        """
        runner = self.renderer.runner
        plan, lease = self.plan_frame(frame), runner.create_lease()
        self._load_results(plan, (*plan.outputs.values(), *plan.remembered))
        yield from self._start_lead_runs(frame)
        # If the outputs are on the device, what the frame stored may not be: a later frame renders it again if needed.
        remembered = () if self._is_on_device(plan) else plan.remembered
        carried = () if following is None else _find_carried_surfaces(plan, following)
        yield runner.start_run(plan, outputs_lease, (*plan.outputs.values(), *remembered, *carried), timings=timings)
        for number in (*plan.remembered, *carried):
            if plan.surfaces[number].key in runner.textures:
                lease.add(plan.surfaces[number].key)
        self._carry(lease)

    def take_carried(self) -> TextureLease:
        """What stays on the device for the next frame, for somebody else to keep."""
        carried, self._carried = self._carried, self.renderer.runner.create_lease()
        return carried

    def note_history(self, frame: int, memories: Memories) -> None:
        """Take in what a frame stored that another process has rendered."""
        self._memories[self.find_history_start(frame + 1), frame] = memories

    def start_history_runs(self, frame: int, timings: PassTimings | None = None) -> Iterator[Run]:
        """The runs that make only what a frame stores for the next one; it stays on the device until another frame is
        rendered here.
        """
        plan, lease = self.plan_frame(frame), self.renderer.runner.create_lease()
        self._load_results(plan, plan.remembered)
        yield from self._start_lead_runs(frame)
        yield self.renderer.runner.start_run(plan, lease, plan.remembered, timings=timings)
        self._carry(lease)

    def render_frame(self, frame: int) -> dict[str, Array]:
        """Every output by name as [height, width, channels]. Raises the errors of `app.errors`."""
        lease = self.renderer.runner.create_lease()
        try:
            for run in self.start_runs(frame, lease):
                with run:
                    for _ in run:
                        pass
            return self.renderer.runner.download(self.plan_frame(frame))
        finally:
            lease.close()

    def close(self) -> None:
        """Release the history."""
        self._carried.close()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _start_lead_runs(self, frame: int) -> Iterator[Run]:
        """The runs of the frames before a frame, for what they store."""
        begin = self.find_history_start(frame)
        for at in self.find_lead_frames(frame):
            plan, lease = self._plan_from(begin, at), self.renderer.runner.create_lease()
            carried = _find_carried_surfaces(plan, self._plan_from(begin, at + 1))
            yield self.renderer.runner.start_run(plan, lease, (*plan.remembered, *carried))
            self._carry(lease)

    def _load_results(self, plan: Plan, requested: Iterable[int]) -> None:
        """Upload what the store has of the `requested` surfaces, or of what they are made from."""
        if self._store is None or plan.tiling is not None:
            return
        makers = {number: render_pass for render_pass in plan.passes for number in render_pass.targets}
        todo, seen = list(requested), set[int]()
        while todo:
            number = todo.pop()
            if number in seen or plan.surfaces[number].key in self.renderer.runner.textures:
                continue
            seen.add(number)
            if (pixels := self._store.load_pixels(plan, number)) is not None:
                self.renderer.runner.upload(plan, number, pixels, self._carried)
            elif number in makers:
                todo.extend(makers[number].textures)

    def _is_on_device(self, plan: Plan) -> bool:
        """True if the outputs are on the device."""
        textures = self.renderer.runner.textures
        return all(plan.surfaces[number].key in textures for number in plan.outputs.values())

    def _carry(self, lease: TextureLease) -> None:
        """Keep what a frame stored, and what it has in common with the next one, until that one is rendered."""
        before, self._carried = self._carried, lease
        before.close()

    def _plan_from(self, begin: int, frame: int) -> Plan:
        key = (begin, frame)
        if key not in self._plans:
            before = self._find_memories(begin, frame)
            plan = self.renderer.compile(self.graph, replace(self.request, frame=frame, memories=before))
            self._memories[key] = plan.memories
            self._plans[key] = plan
            while len(self._plans) > MAX_PLANS:
                self._plans.pop(next(iter(self._plans)))
        return self._plans[key]

    def _find_memories(self, begin: int, frame: int) -> Memories:
        """The memories that the frame before stores."""
        if frame <= begin:
            return {}
        if (begin, frame - 1) in self._memories:
            return self._memories[begin, frame - 1]
        if (begin, begin) not in self._memories:
            self._plan_from(begin, begin)
        for at in range(self._find_last_planned(begin, frame), frame):
            if (begin, at) not in self._memories:
                self._plan_from(begin, at)
            if not self._memories[begin, at]:
                return {}
        return self._memories[begin, frame - 1]

    def _find_last_planned(self, begin: int, frame: int) -> int:
        """The last frame from `begin` on and before `frame` whose memories are known; without one, `begin - 1`.

        `begin` if it remembers nothing, as no frame after it does then.

        Raises UsageError for a frame too far from where its history begins.
        """
        if not self._memories.get((begin, begin)):
            return begin if (begin, begin) in self._memories else begin - 1
        if frame - begin > MAX_LEAD_FRAMES:
            node = min(port.node for port in self._memories[begin, begin])
            raise UsageError(
                f"frame {frame}: node '{node}' remembers earlier frames, so {frame - begin:,} frames come before it, "
                f"and at most {MAX_LEAD_FRAMES:,} can: set the pre-roll of the graph, or name a nearer frame"
            )
        return next((at for at in range(frame - 1, begin - 1, -1) if (begin, at) in self._memories), begin - 1)


def _find_carried_surfaces(plan: Plan, following: Plan) -> tuple[int, ...]:
    """The surfaces of a plan that stay on the device for the next one, as far as there is room."""
    carried: list[int] = []
    nbytes, most, memory = 0, MAX_CARRIED_BYTES, plan.target.memory
    if memory:  # the frame before may have left as much, so each of both gets half
        most = min(most, (memory - max(plan.held_bytes, following.held_bytes)) // 2)
    for number in find_shared_surfaces(plan, following):
        nbytes += plan.surfaces[number].nbytes
        if nbytes > most:
            break
        carried.append(number)
    return tuple(carried)
