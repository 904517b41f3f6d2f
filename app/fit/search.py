"""Renders at points of the search space, within a budget, and keeps the best point."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from msgspec import Struct, field

from ..media.comparison.metrics import Array
from .likeness import Likeness
from .search_space import SearchSpace
from .shown_output import ShownOutput

_STEP = 2e-3
"""How far, in ranges, a number is moved for the slope of the picture. Chosen by measurement on the presets: a long step
finds its way down where sizes of blurs change in small steps."""

_EXACT_STEP = 1e-4
"""The same for slopes that must be exact. With a tenth of it, the rounding of 32-bit
passes shows in them."""


class BudgetSpent(Exception):
    """Ends a search from within: its time or its renders are used up, or the user has stopped it."""


class FitMeter(Struct):
    """Counts renders and seconds. `should_stop` is asked before each render; `report` is told after it."""

    seconds: float
    renders: int
    should_stop: Callable[[], bool] = lambda: False
    report: Callable[[FitMeter], None] = lambda meter: None
    started: float = field(default_factory=time.monotonic)
    count: int = 0
    error: float = float("inf")
    """The error of the best point of the search that runs."""
    best: Array | None = None
    """The best point of that search; None before anything was rendered."""
    ended_by: str = ""
    """What ended the search early, or ""."""

    @property
    def elapsed(self) -> float:
        """Seconds since the start."""
        return time.monotonic() - self.started

    @property
    def is_spent(self) -> bool:
        """True if nothing more may be rendered."""
        return bool(self.ended_by)

    def spend(self, share: float) -> None:
        """Take one render. Raises BudgetSpent where this share of the budget is used up."""
        self.note_end()
        if self.is_spent or self.elapsed >= share * self.seconds or self.count >= share * self.renders:
            raise BudgetSpent
        self.count += 1

    def note_end(self) -> None:
        """Note what ends the search, if anything does."""
        if self.should_stop():
            self.ended_by = "interrupted"
        elif self.count >= self.renders:
            self.ended_by = f"after {self.renders} renders"
        elif self.elapsed >= self.seconds:
            self.ended_by = f"after {self.seconds:g} s"


class FitSearch:
    """A search at one size of the picture: errors and slopes at points, and the best point so far.

    `start_differences` are those of the graph as it is; `share` is the part of the budget that may be used up.
    """

    def __init__(
        self,
        space: SearchSpace,
        output: ShownOutput,
        likeness: Likeness,
        scale: float,
        meter: FitMeter,
        share: float,
        start_differences: Array,
    ) -> None:
        self.space, self.scale, self.share = space, scale, share
        self._output, self._likeness, self._meter = output, likeness, meter
        self._known: dict[bytes, Array] = {space.start.tobytes(): start_differences}
        self.best_point, self.best_error = space.start, float(np.linalg.norm(start_differences))
        self.slopes: Array | None = None
        """The last slopes that were measured, [differences, numbers]."""

    def measure(self, point: Array, is_last: bool = False) -> Array:
        """The differences of the picture at a point from the reference; those of the last points are remembered.

        Raises BudgetSpent unless it `is_last`, and the errors of rendering.
        """
        key = point.tobytes()
        if key in self._known:
            return self._known[key]
        if is_last:
            self._meter.count += 1
        else:
            self._meter.spend(self.share)
        differences = self._likeness.measure(self._output.render(self.space.graph_at(point), self.scale))
        self._known = {**dict(list(self._known.items())[-1:]), key: differences}
        error = float(np.linalg.norm(differences))
        if error < self.best_error:
            self.best_error, self.best_point = error, np.array(point)
        self._meter.error, self._meter.best = self.best_error, self.best_point
        self._meter.report(self._meter)
        return differences

    def rate(self, light: Array) -> float:
        """The error of a picture that is rendered already."""
        return float(np.linalg.norm(self._likeness.measure(light)))

    def measure_slopes(self, point: Array, free: Array) -> Array:
        """How fast the differences change with each of the `free` numbers, by finite differences inside the ranges."""
        here = self.measure(point)
        slopes = np.zeros((here.size, len(self.space.numbers)))
        for place in np.flatnonzero(free):
            moved = np.array(point)
            moved[place] += _STEP if point[place] <= 0.5 else -_STEP
            slopes[:, place] = (self.measure(moved) - here) / (moved[place] - point[place])
        self.slopes = slopes
        return slopes[:, free]

    def measure_central_slopes(self, point: Array) -> Array:
        """The same for all numbers by central differences, which are exact enough to tell two similar slopes apart."""
        columns: list[Array] = []
        for place, item in enumerate(self.space.numbers):
            step = 1.0 / (item.high - item.low) if item.is_whole else _EXACT_STEP
            ends = [np.array(point), np.array(point)]
            ends[0][place], ends[1][place] = max(point[place] - step, 0.0), min(point[place] + step, 1.0)
            below, above = (self.measure(end) for end in ends)
            columns.append((above - below) / (ends[1][place] - ends[0][place]))
        return np.stack(columns, axis=1)
