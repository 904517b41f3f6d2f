"""What nodes take, from what passes took."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ...compiler import Pass, Plan


@dataclass(frozen=True)
class Timing:
    """What the passes of a node took, and the bytes that they wrote. Passes shared with other nodes count for all."""

    seconds: float
    bytes: int
    shared: tuple[str, ...]


def key_of(plan: Plan, one: Pass) -> str:
    """What stands for a pass: equal keys took equal work."""
    return plan.surfaces[one.targets[0]].key


def timings_of(plan: Plan, seconds: Mapping[str, float]) -> dict[str, Timing]:
    """Times of all nodes of a plan whose passes have been timed."""
    found: dict[str, Timing] = {}
    for one in plan.passes:
        if key_of(plan, one) not in seconds:
            continue
        wrote = sum(plan.surfaces[number].nbytes for number in one.targets)
        for node in one.nodes:
            before = found.get(node, Timing(0.0, 0, ()))
            others = dict.fromkeys((*before.shared, *(other for other in one.nodes if other != node)))
            found[node] = Timing(before.seconds + seconds[key_of(plan, one)], before.bytes + wrote, tuple(others))
    return found
