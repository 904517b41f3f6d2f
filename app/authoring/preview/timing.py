"""What nodes take, from what passes took."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from ...compiler import Pass, Plan

MOST_SECONDS = 4096
"""Passes whose times are remembered."""


@dataclass(frozen=True)
class NodeTiming:
    """What the passes of a node took, and the bytes that they wrote. Passes shared with other nodes count for all."""

    seconds: float
    bytes: int
    shared: tuple[str, ...]


def pass_key(plan: Plan, pass_: Pass) -> str:
    """What stands for a pass: equal keys took equal work."""
    return plan.surfaces[pass_.targets[0]].key


class PassTimes:
    """What passes took when they were timed last."""

    def __init__(self) -> None:
        self._seconds: dict[str, float] = {}

    def note(self, plan: Plan, timings: Iterable[tuple[Pass, float]]) -> dict[str, NodeTiming]:
        """Passes of a plan have been timed: what is known of all its nodes."""
        self._seconds |= {pass_key(plan, pass_): seconds for pass_, seconds in timings}
        while len(self._seconds) > MOST_SECONDS:
            self._seconds.pop(next(iter(self._seconds)))
        return sum_node_timings(plan, self._seconds)

    def clear(self) -> None:
        """Forget it all."""
        self._seconds.clear()


def sum_node_timings(plan: Plan, seconds: Mapping[str, float]) -> dict[str, NodeTiming]:
    """Times of all nodes of a plan whose passes have been timed."""
    timings: dict[str, NodeTiming] = {}
    for pass_ in plan.passes:
        if pass_key(plan, pass_) not in seconds:
            continue
        wrote = sum(plan.surfaces[number].nbytes for number in pass_.targets)
        for node in pass_.nodes:
            before = timings.get(node, NodeTiming(0.0, 0, ()))
            shared_nodes = dict.fromkeys(
                (*before.shared, *(shared_node for shared_node in pass_.nodes if shared_node != node))
            )
            timings[node] = NodeTiming(
                before.seconds + seconds[pass_key(plan, pass_)], before.bytes + wrote, tuple(shared_nodes)
            )
    return timings
