"""Selections: sets of elements that grow along links, or change by what the user picks."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Literal

from ...graph import Graph
from ...graph.walk import find_reachable
from .element_id import NO_ELEMENT, ElementId
from .elements import list_elements
from .layout import element_links

SelectMode = Literal["replace", "extend", "add", "remove", "toggle"]
"""What picked elements do to a selection. `extend` replaces it too, but the active element stays the active one."""

Steps = Callable[[ElementId, ElementId], tuple[tuple[ElementId, ElementId], ...]]
"""The ways to follow along a link, given its source and target."""


def combine_selection(
    selection: Collection[ElementId], active: ElementId, picked: Sequence[ElementId], mode: SelectMode
) -> tuple[list[ElementId], ElementId]:
    """The elements that are selected after some were picked, and which of them is active, empty for the last."""
    old = set(selection)
    match mode:
        case "replace":
            return [*picked], NO_ELEMENT
        case "extend":
            return [*picked], active
        case "add":
            return [*(old - set(picked)), *picked], NO_ELEMENT
        case "remove":
            return sorted(old - set(picked)), active
        case "toggle":
            added = [key for key in picked if key not in old]
            return [*sorted(old - set(picked)), *added], added[-1] if added else active


def order_selection(selection: Collection[ElementId], active: ElementId) -> list[ElementId]:
    """The selected elements by name, the active one last."""
    return [*sorted(set(selection) - {active}), *([active] if active else [])]


def invert_selection(elements: Iterable[ElementId], selection: Collection[ElementId]) -> tuple[ElementId, ...]:
    """The elements that are not selected."""
    return tuple(key for key in elements if key not in selection)


def find_upstream(graph: Graph, selection: Collection[ElementId]) -> tuple[ElementId, ...]:
    """The selection and everything that it depends on."""
    return _spread(graph, selection, lambda start, end: ((end, start),))


def find_downstream(graph: Graph, selection: Collection[ElementId]) -> tuple[ElementId, ...]:
    """The selection and everything that depends on it."""
    return _spread(graph, selection, lambda start, end: ((start, end),))


def find_linked(graph: Graph, selection: Collection[ElementId]) -> tuple[ElementId, ...]:
    """The selection and everything that links hold together with it."""
    return _spread(graph, selection, lambda start, end: ((start, end), (end, start)))


def _spread(graph: Graph, selection: Collection[ElementId], steps: Steps) -> tuple[ElementId, ...]:
    ways: dict[ElementId, list[ElementId]] = {}
    for link in element_links(graph):
        for start, end in steps(*link):
            ways.setdefault(start, []).append(end)
    reached = {*selection, *find_reachable(selection, ways)}
    return tuple(key for key in list_elements(graph) if key in reached)
