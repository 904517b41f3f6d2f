"""Boxes in layers: which layer each box is in, and what a link passes on its way over several layers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from msgspec import Struct, field


class Tie(NamedTuple):
    """A link between two boxes. `leaves` and `enters` say how far below their tops, in canvas units."""

    start: str
    end: str
    leaves: float = 0.0
    enters: float = 0.0


class Side(NamedTuple):
    """A piece of a link, seen from a box: the box in the next layer, and where it meets that one and the own one."""

    box: str
    there: float
    here: float


class BoxLayers(Struct):
    """Boxes in layers. A link over several layers passes a virtual box of no height in each between.

    Links that start at the same place share these boxes, so that they are drawn as one line until they part.
    """

    layers: list[list[str]]
    before: dict[str, list[Side]] = field(default_factory=dict[str, list[Side]])
    after: dict[str, list[Side]] = field(default_factory=dict[str, list[Side]])
    virtual: set[str] = field(default_factory=set[str])
    passed: dict[Tie, list[str]] = field(default_factory=dict[Tie, list[str]])
    """The virtual boxes of each link that leads to the right, from left to right."""


def layer_numbers(
    names: Sequence[str], links: Iterable[tuple[str, str]], first: Iterable[str], last: Iterable[str]
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


def make_layers(names: Sequence[str], ties: Iterable[Tie], numbers: Mapping[str, int]) -> BoxLayers:
    """The boxes in their layers, with virtual boxes for links over several layers."""
    layering = BoxLayers([[] for _ in range(max(numbers.values()) + 1)])
    for name in names:
        layering.layers[numbers[name]].append(name)
        layering.before[name], layering.after[name] = [], []
    for tie in ties:
        if numbers[tie.start] >= numbers[tie.end]:
            continue
        came, leaves = tie.start, tie.leaves
        passed = layering.passed[tie] = list[str]()
        for number in range(numbers[tie.start] + 1, numbers[tie.end]):
            bend = f"\0{tie.start}\0{tie.leaves}\0{number}"
            if bend not in layering.virtual:
                layering.virtual.add(bend)
                layering.layers[number].append(bend)
                layering.before[bend], layering.after[bend] = [], []
                _join(layering, came, leaves, bend, 0.0)
            passed.append(bend)
            came, leaves = bend, 0.0
        _join(layering, came, leaves, tie.end, tie.enters)
    return layering


def _join(layering: BoxLayers, start: str, leaves: float, end: str, enters: float) -> None:
    layering.after[start].append(Side(end, enters, leaves))
    layering.before[end].append(Side(start, leaves, enters))


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
