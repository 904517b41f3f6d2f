"""Renders the stages of a job that shares its results among workers (see `renderer.jobs.shared_results`)."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from ..cluster.chunk import ChunkStage, StageReport
from ..errors import HalationError
from ..renderer.execution.run import PassTimings, find_needed_passes
from ..renderer.jobs.item_session import ItemSession
from ..renderer.jobs.shared_results import SharedResults, find_ahead_surfaces
from .outcome import describe_fault

if TYPE_CHECKING:
    from ..compiler import Plan
    from ..renderer import Renderer

_LEAST_GAIN = 2.0
"""How many times longer it takes to compute what lies ahead of the history than to write and read it, at least, for a
stage of its own: a choice, since the other workers render frames meanwhile."""


class StageRenderer:
    """Renders the frames of one stage; `report` and `faults` say what came of them."""

    def __init__(self, renderer: Renderer, session: ItemSession, results: SharedResults, stage: ChunkStage) -> None:
        self._renderer, self._session, self._results, self._stage = renderer, session, results, stage
        self._seconds = dict[int, float]()
        self._names = dict[int, tuple[str, ...]]()
        self._memories = dict[int, Any]()
        self._frame_bytes = 0
        self._ahead_pays = False
        self.faults: Mapping[int, Mapping[str, Any]] = {}

    @property
    def report(self) -> StageReport:
        """What came of the frames so far."""
        return StageReport(self._seconds, self._names, self._memories, self._frame_bytes, self._ahead_pays)

    def render(self) -> None:
        """Render the frames in order, up to the first one that fails."""
        render_frame = {"check": self._check, "ahead": self._render_ahead, "history": self._render_history}
        for frame in self._stage.frames:
            started = time.perf_counter()
            try:
                is_counted = render_frame[self._stage.kind](frame)
            except HalationError as fault:
                self.faults = {frame: describe_fault(fault)}
                return
            if is_counted:
                self._seconds[frame] = round(time.perf_counter() - started, 4)

    def _check(self, frame: int) -> bool:
        """Whether the files of a frame are up to date."""
        if not self._session.has_files(frame):
            return False
        return self._session.find_kept_frame(self._session.plan_task(frame)) is not None

    def _render_history(self, frame: int) -> bool:
        """Store what a frame leaves for the next one."""
        frame_renderer, runner = self._session.frame_renderer, self._renderer.runner
        timings: PassTimings | None = PassTimings() if self._stage.is_survey else None
        for run in frame_renderer.start_history_runs(frame, timings):
            with run:
                for _ in run:
                    pass
        plan = frame_renderer.plan_frame(frame)
        self._names[frame] = self._results.store_surfaces(runner, plan, plan.remembered)
        self._memories[frame] = self._results.describe_memories(plan)
        self._frame_bytes = sum(plan.surfaces[number].nbytes for number in plan.remembered)
        if timings is not None:
            self._ahead_pays = self._survey(plan, timings)
        return True

    def _render_ahead(self, frame: int) -> bool:
        """Store what the history of a frame reads and no earlier frame decides."""
        runner = self._renderer.runner
        # What the frame before stores is not known yet. Here only its shape counts, which all frames share.
        memories = {item.port: item.memory for item in self._stage.memories}
        request = replace(self._session.frame_renderer.request, frame=frame, memories=memories)
        plan = self._renderer.compile(self._session.item.graph, request)
        surfaces, lease = find_ahead_surfaces(plan), runner.create_lease()
        try:
            with runner.start_run(plan, lease, surfaces) as run:
                for _ in run:
                    pass
            self._names[frame] = self._results.store_surfaces(runner, plan, surfaces)
        finally:
            lease.close()
        self._frame_bytes = sum(plan.surfaces[number].nbytes for number in surfaces)
        return True

    def _survey(self, plan: Plan, timings: PassTimings) -> bool:
        """Whether what lies ahead of the history takes so long that other workers should compute it.

        Its files are not written yet; what the frame has stored has just been, and takes as long for each byte.
        """
        surfaces = find_ahead_surfaces(plan)
        passes = {id(plan.passes[index]) for index in find_needed_passes(plan, surfaces, ())}
        seconds = sum(cost for render_pass, cost in timings if id(render_pass) in passes)
        started = time.perf_counter()
        for number in plan.remembered:
            self._results.load_pixels(plan, number)
        read_seconds = time.perf_counter() - started
        share = sum(plan.surfaces[number].nbytes for number in surfaces) / max(1, self._frame_bytes)
        return bool(surfaces) and seconds > _LEAST_GAIN * 2.0 * read_seconds * share
