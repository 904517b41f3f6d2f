"""The order of boxes in their layers: few links between neighboring layers cross.

Sweeps sort each layer by the mean or the median of its neighbors (Sugiyama, Tagawa and Toda 1981; Eades and Wormald
1994). Then single boxes and lanes move to where fewer links cross.
"""

from __future__ import annotations

from bisect import bisect_right, insort
from itertools import pairwise
from statistics import median

from .layering import BoxLayers
from .reinsertion import reinsert_all

_SWEEPS = 8
"""Sweeps over the layers. A choice: the best order so far is kept, and few sweeps improve it."""

_HEIGHT = 1e6
"""More than the height of a box, in canvas units: to tell sockets of one box apart, places are divided by it."""


def uncross(layering: BoxLayers) -> None:
    """Order the boxes of each layer, so that few links cross: the better order of two that are begun differently."""
    orders: list[tuple[int, list[list[str]]]] = []
    begun = [layering.layers, [layer[::-1] for layer in layering.layers]]
    for layers in begun:
        layering.layers = [list(layer) for layer in layers]
        _sweep(layering)
        reinsert_all(layering)
        orders.append((count_crossings(layering), layering.layers))
        if not orders[-1][0]:
            break
    layering.layers = min(orders, key=lambda order: order[0])[1]


def _sweep(layering: BoxLayers) -> None:
    """Sort each layer by its neighbors, rightward and leftward in turn; the fewest crossings win."""
    best, fewest = [list(layer) for layer in layering.layers], count_crossings(layering)
    for sweep in range(_SWEEPS):
        if not fewest:
            break
        rightward = sweep % 2 == 0
        indices = range(1, len(layering.layers)) if rightward else range(len(layering.layers) - 2, -1, -1)
        for index in indices:
            _sort_layer(layering, index, rightward, by_median=sweep % 4 >= 2)
        if (count := count_crossings(layering)) < fewest:
            best, fewest = [list(layer) for layer in layering.layers], count
    layering.layers = best


def count_crossings(layering: BoxLayers) -> int:
    """How many pairs of links between neighboring layers cross; links that share an end do not."""
    total = 0
    for left, right in pairwise(layering.layers):
        place = {name: number for number, name in enumerate(right)}
        passed: list[tuple[int, float]] = []
        for name in left:
            groups: dict[float, list[tuple[int, float]]] = {}
            for side in layering.after[name]:
                groups.setdefault(side.here, []).append((place[side.box], side.there))
            for leaves in sorted(groups):
                total += sum(len(passed) - bisect_right(passed, end) for end in groups[leaves])
                for end in groups[leaves]:
                    insort(passed, end)
    return total


def _sort_layer(layering: BoxLayers, index: int, rightward: bool, by_median: bool) -> None:
    beside = layering.layers[index - 1 if rightward else index + 1]
    place = {name: number for number, name in enumerate(beside)}
    neighbors = layering.before if rightward else layering.after
    own = {name: number for number, name in enumerate(layering.layers[index])}
    keys: dict[str, float] = {}
    for name, number in own.items():
        spots = [place[side.box] + side.there / _HEIGHT - side.here / _HEIGHT for side in neighbors[name]]
        keys[name] = (median(spots) if by_median else sum(spots) / len(spots)) if spots else float(number)
    layering.layers[index].sort(key=lambda name: (keys[name], own[name]))
