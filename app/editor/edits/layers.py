"""Layered drawing of a directed graph: layers by longest path, few crossings, straight lines.

After Sugiyama, Tagawa and Toda (1981): layers, barycenter sweeps, then coordinates. The coordinates of a layer are the
exact least-squares fit to what its neighbors want, by pooling adjacent violators (Ayer et al., 1955).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

_SWEEPS = 8

Link = tuple[str, str]


@dataclass
class Layered:
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
    order = _order(names, fed)
    rank = {name: place for place, name in enumerate(order)}
    number: dict[str, int] = {}
    for name in order:
        number[name] = max((number[one] + 1 for one in fed[name] if rank[one] < rank[name]), default=0)
    fixed, ends = set(first), set(last)
    for name in reversed(order):
        readers = [number[one] for one in feeds[name] if rank[one] > rank[name] and one not in ends]
        if name not in fixed and not fed[name] and readers:
            number[name] = max(min(readers) - 1, number[name])
    bottom = max((number[name] + (name not in ends) for name in names), default=0)
    return number | dict.fromkeys((name for name in names if name in ends), bottom)


def drawn(
    names: Sequence[str], links: Iterable[Link], sizes: Mapping[str, tuple[float, float]], first: Iterable[str] = (),
    last: Iterable[str] = (), gap: tuple[float, float] = (80.0, 40.0),
) -> dict[str, tuple[float, float]]:
    """Top left of every box of `sizes`, the whole drawing starting at 0,0. The same for equal arguments."""
    pairs = sorted({(start, end) for start, end in links if start != end})
    numbers = layer_numbers(names, pairs, first, last)
    made = _layered(names, pairs, numbers)
    _uncross(made)
    heights = {name: sizes[name][1] if name in sizes else 0.0 for layer in made.layers for name in layer}
    tops = _tops(made, heights, gap[1])
    places: dict[str, tuple[float, float]] = {}
    x = 0.0
    least = min(tops[name] for name in names)
    for layer in made.layers:
        real = [name for name in layer if name not in made.virtual]
        for name in real:
            places[name] = (x, float(round(tops[name] - least)))
        x += max((sizes[name][0] for name in real), default=-gap[0]) + gap[0]
    return places


def _order(names: Sequence[str], fed: Mapping[str, Sequence[str]]) -> list[str]:
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
                todo += [(one, False) for one in reversed(fed[name]) if one not in state]
    return order


def _layered(names: Sequence[str], links: Sequence[Link], numbers: Mapping[str, int]) -> Layered:
    made = Layered([[] for _ in range(max(numbers.values()) + 1)])
    for name in names:
        made.layers[numbers[name]].append(name)
        made.before[name], made.after[name] = [], []
    for start, end in links:
        if numbers[start] >= numbers[end]:
            continue
        came = start
        for number in range(numbers[start] + 1, numbers[end]):
            bend = f"\0{start}\0{end}\0{number}"
            made.virtual.add(bend)
            made.layers[number].append(bend)
            made.before[bend], made.after[bend] = [came], []
            made.after[came].append(bend)
            came = bend
        made.after[came].append(end)
        made.before[end].append(came)
    return made


def _uncross(made: Layered) -> None:
    """Order each layer by the mean place of its neighbors, to and fro; the order with fewest crossings stays."""
    best, fewest = [list(layer) for layer in made.layers], _crossings(made)
    for sweep in range(_SWEEPS):
        if not fewest:
            break
        down = sweep % 2 == 0
        indices = range(1, len(made.layers)) if down else range(len(made.layers) - 2, -1, -1)
        for index in indices:
            beside = made.layers[index - 1 if down else index + 1]
            place = {name: number for number, name in enumerate(beside)}
            neighbors = made.before if down else made.after
            own = {name: number for number, name in enumerate(made.layers[index])}
            wanted = {name: _mean([place[one] for one in neighbors[name]], own[name]) for name in own}
            made.layers[index].sort(key=lambda name: (wanted[name], own[name]))
        if (count := _crossings(made)) < fewest:
            best, fewest = [list(layer) for layer in made.layers], count
    made.layers = best


def _crossings(made: Layered) -> int:
    """How many pairs of links between neighboring layers cross."""
    total = 0
    for upper, lower in zip(made.layers, made.layers[1:], strict=False):
        place = {name: number for number, name in enumerate(lower)}
        ends = [number for name in upper for number in sorted(place[one] for one in made.after[name])]
        seen: list[int] = []
        for end in ends:
            low, high = 0, len(seen)
            while low < high:
                middle = (low + high) // 2
                low, high = (middle + 1, high) if seen[middle] <= end else (low, middle)
            total += len(seen) - low
            seen.insert(low, end)
    return total


def _tops(made: Layered, heights: Mapping[str, float], gap: float) -> dict[str, float]:
    """The upper edge of every box: as level with its neighbors as the boxes of its layer allow."""
    tops: dict[str, float] = {}
    for layer in made.layers:
        y = 0.0
        for name in layer:
            tops[name] = y
            y += heights[name] + gap
    for sweep in range(_SWEEPS):
        layers = made.layers if sweep % 2 == 0 else made.layers[::-1]
        for layer in layers:
            beside = made.before if sweep % 2 == 0 else made.after
            other = made.after if sweep % 2 == 0 else made.before
            wanted = [_median([tops[one] for one in beside[name] or other[name]], tops[name]) for name in layer]
            weights = [4.0 if name in made.virtual else 1.0 for name in layer]
            steps = [heights[name] + gap for name in layer]
            tops.update(zip(layer, _fitted(wanted, weights, steps), strict=True))
    return tops


def _fitted(wanted: Sequence[float], weights: Sequence[float], steps: Sequence[float]) -> list[float]:
    """Positions nearest to those `wanted` (weighted least squares), each `steps` after the one before or more."""
    offsets, total = list[float](), 0.0
    for step in steps:
        offsets.append(total)
        total += step
    blocks: list[tuple[float, float, int]] = []
    for want, weight, offset in zip(wanted, weights, offsets, strict=True):
        value, mass, count = want - offset, weight, 1
        while blocks and blocks[-1][0] > value:
            before, heavy, many = blocks.pop()
            value, mass, count = (value * mass + before * heavy) / (mass + heavy), mass + heavy, count + many
        blocks.append((value, mass, count))
    values = [value for value, _, count in blocks for _ in range(count)]
    return [value + offset for value, offset in zip(values, offsets, strict=True)]


def _mean(numbers: Sequence[float], default: float) -> float:
    return sum(numbers) / len(numbers) if numbers else default


def _median(numbers: Sequence[float], default: float) -> float:
    if not numbers:
        return default
    ordered, middle = sorted(numbers), len(numbers) // 2
    return ordered[middle] if len(numbers) % 2 else (ordered[middle - 1] + ordered[middle]) / 2.0
