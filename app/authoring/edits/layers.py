"""Layered drawing of a directed graph: layers by longest path, few crossings, straight lines.

After Sugiyama, Tagawa and Toda (1981): layers, barycenter sweeps, then coordinates. Which boxes share a straight line
is decided as by Brandes and Koepf (2002), "Fast and simple horizontal coordinate assignment".
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from ...graph.walk import sort_topologically

GAP = 80.0, 40.0
"""The space between columns and rows of boxes, in canvas units: chosen by eye, so that links can be told apart."""

_SWEEPS = 8
"""Sweeps over the layers that reduce crossings. A choice: the best order so far is kept, and few sweeps improve it."""

Link = tuple[str, str]


@dataclass
class BoxLayers:
    """Boxes in layers. A link over several layers passes a virtual box of no height in each between."""

    layers: list[list[str]]
    before: dict[str, list[str]] = field(default_factory=dict[str, list[str]])
    after: dict[str, list[str]] = field(default_factory=dict[str, list[str]])
    virtual: set[str] = field(default_factory=set[str])


def layer_numbers(
    names: Sequence[str], links: Iterable[Link], first: Iterable[str], last: Iterable[str]
) -> dict[str, int]:
    """The layer of every name: after all that feed it, and next to its first reader if nothing feeds it.

    Those in `first` stay in layer 0, those in `last` share the last one. Links that close a loop are ignored.
    """
    feeds: dict[str, list[str]] = {name: [] for name in names}
    fed: dict[str, list[str]] = {name: [] for name in names}
    for start, end in links:
        feeds[start].append(end)
        fed[end].append(start)
    order = _order_by_links(names, fed)
    rank = {name: place for place, name in enumerate(order)}
    number: dict[str, int] = {}
    for name in order:
        number[name] = max((number[source] + 1 for source in fed[name] if rank[source] < rank[name]), default=0)
    fixed, ends = set(first), set(last)
    for name in reversed(order):
        readers = [number[reader] for reader in feeds[name] if rank[reader] > rank[name] and reader not in ends]
        if name not in fixed and not fed[name] and readers:
            number[name] = max(min(readers) - 1, number[name])
    bottom = max((number[name] + (name not in ends) for name in names), default=0)
    return number | dict.fromkeys((name for name in names if name in ends), bottom)


def place_boxes(
    names: Sequence[str],
    links: Iterable[Link],
    sizes: Mapping[str, tuple[float, float]],
    first: Iterable[str] = (),
    last: Iterable[str] = (),
    gap: tuple[float, float] = GAP,
) -> dict[str, tuple[float, float]]:
    """Top left of every box of `sizes`, the whole drawing starting at 0,0. The same for equal arguments."""
    pairs = sorted({(start, end) for start, end in links if start != end})
    numbers = layer_numbers(names, pairs, first, last)
    layering = _make_layers(names, pairs, numbers)
    _uncross(layering)
    heights = {name: sizes[name][1] if name in sizes else 0.0 for layer in layering.layers for name in layer}
    tops = _find_tops(layering, heights, gap[1])
    places: dict[str, tuple[float, float]] = {}
    x = 0.0
    least = min(tops[name] for name in names)
    for layer in layering.layers:
        real = [name for name in layer if name not in layering.virtual]
        for name in real:
            places[name] = (x, float(round(tops[name] - least)))
        x += max((sizes[name][0] for name in real), default=-gap[0]) + gap[0]
    return places


def _order_by_links(names: Sequence[str], fed: Mapping[str, Sequence[str]]) -> list[str]:
    """Every name after what feeds it, as far as there are no loops."""
    order: list[str] = []
    state: dict[str, bool] = {}
    for start in names:
        todo = [(start, False)]
        while todo:
            name, leaving = todo.pop()
            if leaving:
                order.append(name)
            elif name not in state:
                state[name] = True
                todo.append((name, True))
                todo += [(source, False) for source in reversed(fed[name]) if source not in state]
    return order


def _make_layers(names: Sequence[str], links: Sequence[Link], numbers: Mapping[str, int]) -> BoxLayers:
    layering = BoxLayers([[] for _ in range(max(numbers.values()) + 1)])
    for name in names:
        layering.layers[numbers[name]].append(name)
        layering.before[name], layering.after[name] = [], []
    for start, end in links:
        if numbers[start] >= numbers[end]:
            continue
        came = start
        for number in range(numbers[start] + 1, numbers[end]):
            bend = f"\0{start}\0{end}\0{number}"
            layering.virtual.add(bend)
            layering.layers[number].append(bend)
            layering.before[bend], layering.after[bend] = [came], []
            layering.after[came].append(bend)
            came = bend
        layering.after[came].append(end)
        layering.before[end].append(came)
    return layering


def _uncross(layering: BoxLayers) -> None:
    """Order each layer by the mean place of its neighbors, sweeping right and left; the fewest crossings win."""
    best, fewest = [list(layer) for layer in layering.layers], _count_crossings(layering)
    for sweep in range(_SWEEPS):
        if not fewest:
            break
        down = sweep % 2 == 0
        indices = range(1, len(layering.layers)) if down else range(len(layering.layers) - 2, -1, -1)
        for index in indices:
            beside = layering.layers[index - 1 if down else index + 1]
            place = {name: number for number, name in enumerate(beside)}
            neighbors = layering.before if down else layering.after
            own = {name: number for number, name in enumerate(layering.layers[index])}
            mean_places = {name: _mean([place[neighbor] for neighbor in neighbors[name]], own[name]) for name in own}
            layering.layers[index].sort(key=lambda name: (mean_places[name], own[name]))
        if (count := _count_crossings(layering)) < fewest:
            best, fewest = [list(layer) for layer in layering.layers], count
    layering.layers = best


def _count_crossings(layering: BoxLayers) -> int:
    """How many pairs of links between neighboring layers cross."""
    total = 0
    for upper, lower in pairwise(layering.layers):
        place = {name: number for number, name in enumerate(lower)}
        ends = [number for name in upper for number in sorted(place[neighbor] for neighbor in layering.after[name])]
        passed: list[int] = []
        for end in ends:
            low, high = 0, len(passed)
            while low < high:
                middle = (low + high) // 2
                low, high = (middle + 1, high) if passed[middle] <= end else (low, middle)
            total += len(passed) - low
            passed.insert(low, end)
    return total


def _find_tops(layering: BoxLayers, heights: Mapping[str, float], gap: float) -> dict[str, float]:
    """The upper edge of every box. Those of one line move together, as near to what they are linked to as they can.

    First all lines lie as high as the gaps above them allow. Then sweeps, upward and downward in turn, move each line
    to the median of its neighbors, within the gaps that it must keep to the lines above and below.
    """
    line = _find_straight_lines(layering)
    above: dict[str, dict[str, float]] = {root: {} for root in line.values()}
    below: dict[str, dict[str, float]] = {root: {} for root in line.values()}
    for layer in layering.layers:
        for upper, lower in pairwise(layer):
            upper_line, lower_line, need = line[upper], line[lower], heights[upper] + gap
            below[upper_line][lower_line] = above[lower_line][upper_line] = max(
                need, below[upper_line].get(lower_line, 0.0)
            )
    order = sort_topologically({root: sorted(above[root]) for root in sorted(above)})
    tops: dict[str, float] = {}
    for root in order:
        tops[root] = max((tops[upper_line] + need for upper_line, need in above[root].items()), default=0.0)
    beside: dict[str, list[str]] = {root: [] for root in above}
    for name, root in line.items():
        beside[root] += [
            line[neighbor] for neighbor in (*layering.before[name], *layering.after[name]) if line[neighbor] != root
        ]
    for sweep in range(_SWEEPS):
        for root in order[::-1] if sweep % 2 == 0 else order:
            low = max((tops[upper_line] + need for upper_line, need in above[root].items()), default=-math.inf)
            high = min((tops[lower_line] - need for lower_line, need in below[root].items()), default=math.inf)
            target_top = _median([tops[neighbor] for neighbor in beside[root]], tops[root])
            tops[root] = max(low, min(target_top, high))
    return {name: tops[root] for name, root in line.items()}


def _find_straight_lines(layering: BoxLayers) -> dict[str, str]:
    """Boxes that lie on one straight line, by the first of them: each box joins its median source if it can.

    Lines never cross; long links come first. This is the alignment of Brandes and Koepf (2002); a
    link across several layers is a chain of virtual boxes, and stays straight even if a short link gives way.
    """
    line = {name: name for layer in layering.layers for name in layer}
    for upper, lower in pairwise(layering.layers):
        place = {name: number for number, name in enumerate(upper)}
        long = [
            (place[feeder], number)
            for number, name in enumerate(lower)
            if name in layering.virtual
            for feeder in layering.before[name]
            if feeder in layering.virtual
        ]
        reached = -1
        for number, name in enumerate(lower):
            sources = sorted(place[feeder] for feeder in layering.before[name])
            middle = len(sources) // 2
            for source in sources[(len(sources) - 1) // 2 : middle + 1]:
                crosses = any(
                    (start < source) != (end < number) and start != source for start, end in long if end != number
                )
                if source > reached and not crosses:
                    line[name] = line[upper[source]]
                    reached = source
                    break
    return line


def _mean(numbers: Sequence[float], default: float) -> float:
    return sum(numbers) / len(numbers) if numbers else default


def _median(numbers: Sequence[float], default: float) -> float:
    if not numbers:
        return default
    ordered, middle = sorted(numbers), len(numbers) // 2
    return ordered[middle] if len(numbers) % 2 else (ordered[middle - 1] + ordered[middle]) / 2.0
