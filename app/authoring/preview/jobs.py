"""One picture, or several of one frame, on their way: compiled and run in small steps, history first."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from ...compiler import Plan
from ...errors import DeviceError, HalationError
from ...graph import Port
from ...renderer import FrameRenderer, Renderer, Run
from .glimpses import Glimpse, Part, part_of
from .wishes import Wish

if TYPE_CHECKING:
    from ...compiler import Pass


class Job:
    """A frame of a wish, for some of its ports. Raises the errors of `app.errors`, from the first line on.

    `ahead` is for a frame that nobody wants to see yet. With a `part`, no more is computed of the pictures.
    """

    def __init__(
        self,
        renderer: Renderer,
        wish: Wish,
        ports: Mapping[str, Port],
        frame: int,
        timed: bool,
        ahead: bool = False,
        part: Part | None = None,
    ) -> None:
        self.wish, self.ports, self.frame, self.ahead, self.part = wish, ports, frame, ahead, part
        self.timings: list[tuple[Pass, float]] | None = [] if timed else None
        self.plan: Plan | None = None
        self.run: Run | None = None
        self.began = time.perf_counter()
        self.passes = 0
        """Passes of runs that have ended."""
        self.lead = (0, 0)
        """Frames of the history that have been run, and all that must be."""
        self.planned = (0, 0)
        """The same for plans."""
        self.kept = renderer.runner.lease()
        self._runs: Iterator[Run] | None = None
        self._reel: FrameRenderer | None = None
        try:
            self._reel = wish.take.reel(ports)
            if self._reel is None:
                region = part.region if part else None
                plan = _fitting(renderer.compile(wish.graph, wish.wanted(ports, frame, region)))
                if plan.memories:
                    self._reel = wish.take.begin(ports, FrameRenderer(renderer, wish.graph, wish.wanted(ports, frame)))
                else:
                    self.plan, self.run = plan, renderer.runner.steps(plan, self.kept, timings=self.timings)
        except BaseException:
            self.kept.close()
            raise

    @property
    def ready(self) -> bool:
        """False while the next step would wait for a file."""
        return self.run is None or self.run.ready

    def step(self) -> bool:
        """Do a little; True when all is done."""
        if self.run is None:
            self._plan()
            return False
        if next(self.run, None) is not None:
            return False
        self.passes += self.run.total
        return self._runs is None or not self._next()

    def close(self) -> None:
        """Drop it."""
        if self.run is not None:
            self.run.close()
        self.kept.close()

    def _plan(self) -> None:
        """Compile one plan; with the last one, begin to run."""
        assert self._reel is not None
        if planned := self._reel.plan_next(self.frame):
            self.planned = planned
            return
        self.plan = _fitting(self._reel.plan(self.frame))
        self.lead = (-1, len(self._reel.lead(self.frame)))
        self._runs = self._reel.steps(self.frame, self.kept, self.timings)
        self._next()

    def _next(self) -> bool:
        assert self._runs is not None
        run = next(self._runs, None)
        if run is None:
            return False
        self.run, self.lead = run, (self.lead[0] + 1, self.lead[1])
        return True


def peek(renderer: Renderer, wish: Wish, glimpse: Glimpse) -> Job | None:
    """What makes the part of a wish that can be seen; None where nothing is gained by that."""
    ports = {name: wish.ports[name] for name in sorted(glimpse.names)}
    try:
        part = part_of(renderer, wish, ports, glimpse)
        return Job(renderer, wish, ports, wish.frame, False, part=part) if part else None
    except HalationError:  # is found again, and said, where all is made
        return None


def _fitting(plan: Plan) -> Plan:
    """A plan whose pictures can be shown. Raises DeviceError for one that can only be rendered to files."""
    if plan.tiling is not None:
        raise DeviceError(f"{plan.tiling.why}: look at a smaller proxy, or render it to a file")
    return plan
