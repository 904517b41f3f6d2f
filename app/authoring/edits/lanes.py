"""Leads links around elements, with as few dots as that needs."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from .elements import Place
from .link_curves import make_curve

CLEARANCE = 6.0
"""The least space between a link and an element that it passes, in canvas units: a link with its rim is 5 wide."""

_PIECES = 24
"""Straight pieces that stand for a curve: on a link of 5,000 units they are less than 2 units away from it."""

_SHARED = 0.01
"""The cost of a dot that another link from the same socket has already, where a new one costs 1."""

Box = tuple[float, float, float, float]
"""Left, top, right, bottom."""


def choose_dots(
    start: Place, end: Place, bends: Sequence[Place], boxes: Iterable[Box], shared: Collection[Place] = ()
) -> tuple[Place, ...]:
    """The fewest of `bends` through which a link from `start` to `end` keeps clear of all boxes.

    Of equally many, those with the shortest way up and down. All of them where even these do not keep it clear.
    """
    stops = (start, *bends, end)
    obstacles = np.array(list(boxes), float).reshape(-1, 4)
    if not _find_blocked([(start, end)], obstacles)[0]:
        return ()
    pairs = list(combinations(range(len(stops)), 2))
    blocked = _find_blocked([(stops[first], stops[last]) for first, last in pairs], obstacles)
    costs: list[tuple[float, float]] = [(0.0, 0.0)]
    came = [0]
    free = {pair for pair, is_blocked in zip(pairs, blocked, strict=True) if not is_blocked}
    for last in range(1, len(stops)):
        dot = _SHARED if stops[last] in shared else 1.0
        choices = [
            (costs[first][0] + dot, costs[first][1] + abs(stops[last][1] - stops[first][1]), first)
            for first in range(last)
            if (first, last) in free or first == last - 1
        ]
        *cost, first = min(choices)
        costs.append((cost[0], cost[1]))
        came.append(first)
    chosen: list[Place] = []
    at = came[-1]
    while at:
        chosen.append(stops[at])
        at = came[at]
    return tuple(reversed(chosen))


def _find_blocked(pairs: Sequence[tuple[Place, Place]], boxes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which of n curves comes too near to one of m boxes: [n]."""
    blocked = np.zeros(len(pairs), np.bool_)
    if not len(boxes):
        return blocked
    grown = boxes + np.array([-CLEARANCE, -CLEARANCE, CLEARANCE, CLEARANCE])
    curves = np.array([make_curve(*start, *end) for start, end in pairs]).reshape(-1, 4, 2)
    t = np.linspace(0.0, 1.0, _PIECES + 1)
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    lines = np.einsum("sk,nkd->nsd", weights, curves)
    low, high = lines.min(axis=1), lines.max(axis=1)
    near = (
        (low[:, None] < grown[None, :, 2:]).all(axis=2) & (high[:, None] > grown[None, :, :2]).all(axis=2)
    ).nonzero()
    hit = _cross_boxes(lines[near[0]], grown[near[1]])
    blocked[near[0][hit]] = True
    return blocked


def _cross_boxes(lines: NDArray[np.float64], boxes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which of n polylines [n, m, 2] enters its box [n, 4]: pieces are clipped at its sides (Liang and Barsky 1984)."""
    start, along = lines[:, :-1], np.diff(lines, axis=1)
    along = np.where(np.abs(along) < 1e-9, 1e-9, along)
    first = (boxes[:, None, :2] - start) / along
    last = (boxes[:, None, 2:] - start) / along
    enters, leaves = np.minimum(first, last).max(axis=2), np.maximum(first, last).min(axis=2)
    return np.asarray((np.maximum(enters, 0.0) < np.minimum(leaves, 1.0)).any(axis=1))
