"""Moves single boxes, and whole lanes of long links, to where fewest links cross them.

A box, or the chain of virtual boxes of a long link, is taken out of its layers and put back at the best places of all,
which a dynamic program finds exactly, since nothing else moves. This is the block of Bachmaier, Brandenburg, Brunner
and Huebner (2010), "A global k-level crossing reduction algorithm", which sweeps over single layers cannot move.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .layering import BoxLayers, Side

_ROUNDS = 4
"""Rounds over all boxes and lanes: each only removes crossings, and few rounds find most."""

_MOST = 1500
"""Boxes and lanes of a drawing that is worth the time: 44 nodes wired at random have 231, in a tenth of a second."""

Counts = NDArray[np.int64]


def reinsert_all(layering: BoxLayers) -> None:
    """Move boxes and lanes until no single one has a better place, or for some rounds; nothing in large drawings."""
    layer_of = {name: number for number, layer in enumerate(layering.layers) for name in layer}
    runs = _list_runs(layering, layer_of) if len(layer_of) <= _MOST else []
    for _ in range(_ROUNDS):
        if not sum([_reinsert(layering, layer_of, run) for run in runs]):
            return


def _list_runs(layering: BoxLayers, layer_of: Mapping[str, int]) -> list[list[str]]:
    """The chains of virtual boxes, the longest first, and each other box alone."""
    runs: list[list[str]] = []
    for name in layer_of:
        if name in layering.virtual and not any(side.box in layering.virtual for side in layering.before[name]):
            run = [name]
            while onward := [side.box for side in layering.after[run[-1]] if side.box in layering.virtual]:
                run.append(onward[0])
            runs.append(run)
        elif name not in layering.virtual:
            runs.append([name])
    return sorted(runs, key=lambda run: (-len(run), layer_of[run[0]]))


def _reinsert(layering: BoxLayers, layer_of: Mapping[str, int], run: Sequence[str]) -> bool:
    """Move the boxes of a run, which are in neighboring layers, to their best places; True if crossings went away."""
    layers = layering.layers[layer_of[run[0]] :][: len(run)]
    old = [layer.index(name) for layer, name in zip(layers, run, strict=True)]
    for layer, name in zip(layers, run, strict=True):
        layer.remove(name)
    gaps = [_Gap(layering, layer_of[run[0]] - 1 + at, frozenset(run)) for at in range(len(run) + 1)]
    steps = [gap.count_steps() for gap in gaps[1:-1]]
    alone = [_count_outside(layering, name, run, *gaps[at : at + 2]) for at, name in enumerate(run)]
    best = _find_cheapest(alone, steps)
    better = _sum_costs(alone, steps, best) < _sum_costs(alone, steps, old)
    for layer, name, place in zip(layers, run, best if better else old, strict=True):
        layer.insert(place, name)
    return better


def _count_outside(layering: BoxLayers, name: str, run: Sequence[str], before: _Gap, after: _Gap) -> Counts:
    """How many pieces the links of a box to others than those of its run cross, for each place in its layer."""
    counts = [before.count_to_right(side) for side in layering.before[name] if side.box not in run]
    counts += [after.count_to_left(side) for side in layering.after[name] if side.box not in run]
    return np.sum(counts, axis=0, initial=0) if counts else np.zeros(before.rights + 1, np.int64)


def _find_cheapest(alone: Sequence[Counts], steps: Sequence[Counts]) -> list[int]:
    """A place for each box of a run: the least sum of what it costs alone and what the steps between places cost."""
    total, choices = alone[0], list[Counts]()
    for own, step in zip(alone[1:], steps, strict=True):
        ways = total[:, None] + step
        choices.append(ways.argmin(axis=0))
        total = own + ways.min(axis=0)
    places = [int(total.argmin())]
    for choice in reversed(choices):
        places.insert(0, int(choice[places[0]]))
    return places


def _sum_costs(alone: Sequence[Counts], steps: Sequence[Counts], places: Sequence[int]) -> int:
    own = sum(int(costs[place]) for costs, place in zip(alone, places, strict=True))
    return own + sum(int(step[pair]) for step, pair in zip(steps, pairwise(places), strict=True))


class _Gap:
    """The pieces of links between a layer and the next one, without those of some boxes."""

    def __init__(self, layering: BoxLayers, left: int, without: frozenset[str]) -> None:
        layers = layering.layers
        lefts = layers[left] if left >= 0 else []
        rights = layers[left + 1] if left + 1 < len(layers) else []
        self._left = {name: number for number, name in enumerate(lefts)}
        self._right = {name: number for number, name in enumerate(rights)}
        self.rights = len(rights)
        pieces = [
            (self._left[name], side.here, self._right[side.box], side.there)
            for name in lefts
            for side in layering.after[name]
            if side.box not in without
        ]
        table = np.array(pieces, float).reshape(-1, 4)
        self._starts, self._ends = table[:, :2], table[:, 2:]

    def count_to_right(self, side: Side) -> Counts:
        """How many pieces a link from a box of the left layer crosses, for each place among the right ones."""
        return self._count(self._starts, self._ends, (self._left[side.box], side.there), self.rights)

    def count_to_left(self, side: Side) -> Counts:
        """How many pieces a link to a box of the right layer crosses, for each place among the left ones."""
        return self._count(self._ends, self._starts, (self._right[side.box], side.there), len(self._left))

    def count_steps(self) -> Counts:
        """How many pieces a link crosses from each place among the left boxes to each among the right ones."""
        table = np.zeros((len(self._left) + 1, len(self._right) + 1), np.int64)
        np.add.at(table, (self._starts[:, 0].astype(int) + 1, self._ends[:, 0].astype(int) + 1), 1)
        both = table.cumsum(axis=0).cumsum(axis=1)
        return both[:, -1:] + both[-1:, :] - 2 * both

    @staticmethod
    def _count(fixed: NDArray[np.float64], moving: NDArray[np.float64], end: tuple[int, float], size: int) -> Counts:
        above = (fixed[:, 0] < end[0]) | ((fixed[:, 0] == end[0]) & (fixed[:, 1] < end[1]))
        below = (fixed[:, 0] > end[0]) | ((fixed[:, 0] == end[0]) & (fixed[:, 1] > end[1]))
        places = moving[:, 0].astype(int)
        lower = np.bincount(places[below], minlength=size)[:size]
        upper = np.bincount(places[above], minlength=size)[:size]
        passed = np.concatenate([[0], np.cumsum(lower)])
        ahead = np.concatenate([[0], np.cumsum(upper)])
        return passed + ahead[-1] - ahead
