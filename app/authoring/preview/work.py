"""The work on one preview request."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct, field

from ...errors import HalationError
from ...graph import Port
from ..background.render_overviews import OverviewPending
from .picture_job import PictureJob
from .request import PreviewRequest
from .timing import NodeTiming
from .visible_region import PictureRegion, VisibleRegion

REST = 0.2
"""Seconds without a change before the rest of a picture follows its visible part: a choice."""


class PreviewWork(Struct, eq=False):
    """The queue of pictures that are still to be compiled, and the errors so far."""

    request: PreviewRequest
    queue: list[Mapping[str, Port]]
    started_at: float
    passes: int = 0
    from_cache_only: bool = False
    """True if all pictures came from the cache."""
    faults: dict[str, HalationError] = field(default_factory=dict[str, HalationError])
    pending: OverviewPending | None = None
    """The render that the first of the queue waits for."""
    broken: dict[str, str] = field(default_factory=dict[str, str])
    """Why panels cannot show their picture, by name."""
    timings: dict[str, NodeTiming] = field(default_factory=dict[str, NodeTiming])
    part: PictureRegion | None = None
    """The region that is ready, while the rest is still to be computed."""
    tried_region: VisibleRegion | None = None
    """The visible region for which a part was tried last."""

    @property
    def is_finished(self) -> bool:
        """True if all its pictures are computed, and none is broken."""
        return bool(self.request.ports) and not self.queue and not self.broken

    def may_show_part_first(self, glimpse: VisibleRegion | None) -> bool:
        """True if a part of its pictures may be computed first."""
        if glimpse is None or glimpse == self.tried_region or self.faults or self.pending or not self.request.ports:
            return False
        return glimpse.names <= self.request.ports.keys() and not (self.part and self.part.shows(glimpse))

    def count_passes(self, job: PictureJob | None) -> tuple[int, int]:
        """Passes done, and passes to do in all, as far as they are known while `job` runs."""
        if job is None or job.run is None or job.ahead:
            return self.passes, self.passes
        finished = self.passes + job.finished_passes
        return finished + job.run.passes_done, finished + job.run.total

    def is_replaced(self, request: PreviewRequest, job: PictureJob) -> bool:
        """True if another request would not show the pictures of `job`."""
        differs = self.request.ports != request.ports or self.request.scale != request.scale
        return differs or job.ahead or bool(self.part and not job.part)

    def must_wait(self, clock_time: float) -> bool:
        """True while the first of the queue must wait; `clock_time` is on the same clock as `started_at`."""
        if self.part is not None and clock_time - self.started_at < REST:
            return True
        return self.pending is not None and not self.pending.ready()

    def note_failure(self, ports: Mapping[str, Port], error: HalationError) -> None:
        """Try every port alone: one error must not hide the other pictures."""
        if len(ports) > 1:
            self.queue = [{name: port} for name, port in ports.items()] + self.queue
            return
        self.broken |= dict.fromkeys(ports, str(error))
        self.faults |= dict.fromkeys(error.node.split(", "), error)
