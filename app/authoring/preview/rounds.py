"""The work on one wish."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field

from ...errors import HalationError
from ...graph import Port
from ..services.renders import Pending
from .glimpses import Glimpse, Part
from .timing import Timing
from .wishes import Wish

REST = 0.2
"""Seconds that a graph must stay as it is before all of a picture is computed of which the seen part is there."""


@dataclass(eq=False)
class Round:
    """What is still to be compiled, and what went wrong so far."""

    wish: Wish
    queue: list[Mapping[str, Port]]
    began: float
    passes: int = 0
    skimmed: bool = False
    """True if its pictures were there, and nothing else was looked at."""
    faults: dict[str, HalationError] = field(default_factory=dict[str, HalationError])
    pending: Pending | None = None
    """The render that the first of the queue waits for."""
    broken: dict[str, str] = field(default_factory=dict[str, str])
    """Why panels cannot show what they want, by name."""
    timings: dict[str, Timing] = field(default_factory=dict[str, Timing])
    part: Part | None = None
    """What is shown of its pictures, while the rest is still to be computed."""
    tried: Glimpse | None = None
    """What was seen when a part was looked for last."""

    def may_peek(self, glimpse: Glimpse | None) -> bool:
        """True if a part of its pictures may be computed first."""
        if glimpse is None or glimpse == self.tried or self.faults or self.pending or not self.wish.ports:
            return False
        return glimpse.names <= self.wish.ports.keys() and not (self.part and self.part.shows(glimpse))

    @property
    def waits(self) -> bool:
        """True while the first of the queue must not be begun."""
        if self.part is not None and time.perf_counter() - self.began < REST:
            return True
        return self.pending is not None and not self.pending.ready()

    def failed(self, ports: Mapping[str, Port], error: HalationError) -> None:
        """One fault must not hide what else can be shown: every port is tried alone."""
        if len(ports) > 1:
            self.queue = [{name: port} for name, port in ports.items()] + self.queue
            return
        self.broken |= dict.fromkeys(ports, str(error))
        self.faults |= dict.fromkeys(error.node.split(", "), error)
