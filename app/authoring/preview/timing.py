"""The time and memory of nodes, from those of their passes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from msgspec import Struct

from ...compiler import Pass, Plan

MOST_SECONDS = 4096
"""The most passes whose times are remembered. A choice."""


class NodeTiming(Struct, frozen=True):
    """The seconds of a node's passes and the bytes that they wrote. A pass of several nodes counts for each."""

    seconds: float
    bytes: int
    shared: tuple[str, ...]


def pass_key(plan: Plan, pass_: Pass) -> str:
    """The key of a pass: equal keys mean equal work."""
    return plan.surfaces[pass_.targets[0]].key


class PassTimes:
    """The last measured times of passes."""

    def __init__(self) -> None:
        self._seconds: dict[str, float] = {}

    def note(self, plan: Plan, timings: Iterable[tuple[Pass, float]]) -> dict[str, NodeTiming]:
        """Add the times of a plan's passes; returns the timings of its nodes."""
        self._seconds |= {pass_key(plan, pass_): seconds for pass_, seconds in timings}
        while len(self._seconds) > MOST_SECONDS:
            self._seconds.pop(next(iter(self._seconds)))
        return sum_node_timings(plan, self._seconds)

    def clear(self) -> None:
        """Forget all times."""
        self._seconds.clear()


def sum_node_timings(plan: Plan, seconds: Mapping[str, float]) -> dict[str, NodeTiming]:
    """The timings of all nodes of a plan whose passes have been measured."""
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
