"""How high the boxes of a layered drawing lie: links are straight where they can be.

Which boxes share a straight line is decided as by Brandes and Koepf (2002), "Fast and simple horizontal coordinate
assignment"; a line passes the sockets of its boxes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from statistics import median

from ...graph.walk import sort_topologically
from .layering import BoxLayers

_SWEEPS = 16
"""Sweeps that move lines to the median of their neighbors. A choice: after these, presets no longer change."""

Gap = Callable[[str, str], float]
"""The least space between a box and the one below it."""


def find_tops(layering: BoxLayers, heights: Mapping[str, float], gap: Gap) -> dict[str, float]:
    """The upper edge of every box. Those of one line move together, as near to what they are linked to as they can.

    First all lines lie as high as the gaps above them allow. Then sweeps, upward and downward in turn, move each line
    to the median of its neighbors, within the gaps that it must keep to the lines above and below.
    """
    line, offset = _find_straight_lines(layering)
    above: dict[str, dict[str, float]] = {root: {} for root in line.values()}
    below: dict[str, dict[str, float]] = {root: {} for root in line.values()}
    for layer in layering.layers:
        for upper, lower in pairwise(layer):
            first, second = line[upper], line[lower]
            need = offset[upper] + heights[upper] + gap(upper, lower) - offset[lower]
            below[first][second] = above[second][first] = max(need, below[first].get(second, -math.inf))
    order = sort_topologically({root: sorted(above[root]) for root in sorted(above)})
    tops: dict[str, float] = {}
    for root in order:
        tops[root] = max((tops[other] + need for other, need in above[root].items()), default=0.0)
    beside: dict[str, list[tuple[str, float]]] = {root: [] for root in above}
    for name, root in line.items():
        beside[root] += [
            (line[side.box], offset[side.box] + side.there - offset[name] - side.here)
            for side in (*layering.before[name], *layering.after[name])
            if line[side.box] != root
        ]
    for sweep in range(_SWEEPS):
        for root in order[::-1] if sweep % 2 == 0 else order:
            low = max((tops[other] + need for other, need in above[root].items()), default=-math.inf)
            high = min((tops[other] - need for other, need in below[root].items()), default=math.inf)
            wanted = median(tops[other] + shift for other, shift in beside[root]) if beside[root] else tops[root]
            tops[root] = max(low, min(wanted, high))
    return {name: tops[root] + offset[name] for name, root in line.items()}


def _find_straight_lines(layering: BoxLayers) -> tuple[dict[str, str], dict[str, float]]:
    """Boxes whose links lie on one straight line, by the first of them, and how far each is below that one.

    Each box joins its median source if it can. Lines never cross; long links come first: a link across several layers
    is a chain of virtual boxes, and stays straight even if a short link gives way.
    """
    line = {name: name for layer in layering.layers for name in layer}
    offset = dict.fromkeys(line, 0.0)
    for left, right in pairwise(layering.layers):
        place = {name: number for number, name in enumerate(left)}
        long = [
            (place[side.box], number)
            for number, name in enumerate(right)
            if name in layering.virtual
            for side in layering.before[name]
            if side.box in layering.virtual
        ]
        reached = -1
        for number, name in enumerate(right):
            sides = sorted(layering.before[name], key=lambda side: (place[side.box], side.there))
            for side in sides[(len(sides) - 1) // 2 : len(sides) // 2 + 1]:
                source = place[side.box]
                crosses = any(
                    (start < source) != (end < number) and start != source for start, end in long if end != number
                )
                if source > reached and not crosses:
                    line[name] = line[side.box]
                    offset[name] = offset[side.box] + side.there - side.here
                    reached = source
                    break
    return line, offset
