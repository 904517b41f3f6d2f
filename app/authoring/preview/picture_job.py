"""The job that compiles and runs the pictures of one frame in small steps, history first."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from ...compiler import Plan
from ...errors import DeviceError, HalationError
from ...graph import Port
from ...language.translation import translate
from ...renderer import FrameRenderer, Renderer, Run
from .request import PreviewRequest
from .visible_region import PictureRegion, VisibleRegion, find_visible_part

if TYPE_CHECKING:
    from ...compiler import Pass


STEP_SECONDS = 0.04
"""Seconds that a part of a pass should take: with what a frame of the window costs itself, well below the 0.1 s after
which a reply no longer seems immediate (Nielsen 1993)."""


class PictureJob:
    """A frame of a request, for some of its ports. Raises the errors of `app.errors`, from the first line on.

    `ahead` is for a frame that nobody wants to see yet. With a `part`, no more is computed of the pictures.
    """

    def __init__(
        self,
        renderer: Renderer,
        request: PreviewRequest,
        ports: Mapping[str, Port],
        frame: int,
        timed: bool,
        ahead: bool = False,
        part: PictureRegion | None = None,
    ) -> None:
        self.request, self.ports, self.frame, self.ahead, self.part = request, ports, frame, ahead, part
        self.timings: list[tuple[Pass, float]] | None = [] if timed else None
        self.plan: Plan | None = None
        self.run: Run | None = None
        self.started_at = time.perf_counter()
        self.finished_passes = 0
        """Passes of the runs that have ended."""
        self.preroll = (0, 0)
        """History frames that have been run, and how many must be run in all."""
        self.planned_frames = (0, 0)
        """History frames that have been planned, and how many must be planned in all."""
        self.lease = renderer.runner.create_lease()
        self._runs: Iterator[Run] | None = None
        self._frame_renderer: FrameRenderer | None = None
        try:
            self._frame_renderer = request.frame_cache.find_frame_renderer(ports)
            if self._frame_renderer is None:
                region = part.region if part else None
                plan = _check_displayable(renderer.compile(request.graph, request.render_request(ports, frame, region)))
                if plan.memories:
                    self._frame_renderer = request.frame_cache.add_frame_renderer(
                        ports, FrameRenderer(renderer, request.graph, request.render_request(ports, frame))
                    )
                else:
                    self.plan, self.run = plan, renderer.runner.start_run(plan, self.lease, timings=self.timings)
        except BaseException:
            self.lease.close()
            raise

    @property
    def is_ready(self) -> bool:
        """False while the next step would wait for a file."""
        return self.run is None or self.run.is_ready

    @property
    def preroll_progress(self) -> tuple[str, int, int] | None:
        """What of the history is under way: "plan" or "pre-roll", how many frames are done, and how many there are."""
        if self.run is None and self.planned_frames[0] < self.planned_frames[1]:
            planned, total = self.planned_frames
            return "plan", planned, total
        finished, total = self.preroll
        return ("pre-roll", finished, total) if total and finished < total else None

    def is_ahead_of(self, request: PreviewRequest) -> bool:
        """True if it began to compute the frame of a request before the request came."""
        return self.ahead and self.frame == request.frame and self.request.frame_cache is request.frame_cache

    def step(self) -> bool:
        """Do one step; True when the job is done."""
        if self.run is None:
            self._plan_next()
            return False
        if self.run.step(STEP_SECONDS):
            return False
        self.finished_passes += self.run.total
        return self._runs is None or not self._start_next_run()

    def close(self) -> None:
        """Drop the job."""
        if self.run is not None:
            self.run.close()
        self.lease.close()

    def _plan_next(self) -> None:
        """Compile one plan; after the last one, start to run."""
        assert self._frame_renderer is not None
        if planned := self._frame_renderer.plan_next(self.frame):
            self.planned_frames = planned
            return
        self.plan = _check_displayable(self._frame_renderer.plan_frame(self.frame))
        self.preroll = (-1, len(self._frame_renderer.find_lead_frames(self.frame)))
        self._runs = self._frame_renderer.start_runs(self.frame, self.lease, self.timings)
        self._start_next_run()

    def _start_next_run(self) -> bool:
        assert self._runs is not None
        run = next(self._runs, None)
        if run is None:
            return False
        self.run, self.preroll = run, (self.preroll[0] + 1, self.preroll[1])
        return True


def begin_visible_part(renderer: Renderer, request: PreviewRequest, glimpse: VisibleRegion) -> PictureJob | None:
    """A job for the visible part of a request; None if it would not be faster than the whole."""
    ports = {name: request.ports[name] for name in sorted(glimpse.names)}
    try:
        part = find_visible_part(renderer, request, ports, glimpse)
        return PictureJob(renderer, request, ports, request.frame, False, part=part) if part else None
    except HalationError:  # the job for the whole picture finds and reports it
        return None


def _check_displayable(plan: Plan) -> Plan:
    """A plan whose pictures can be shown. Raises DeviceError for one that can only be rendered to files."""
    if plan.tiling is not None:
        raise DeviceError(translate("{why}: look at a smaller proxy, or render it to a file", why=plan.tiling.why))
    return plan
