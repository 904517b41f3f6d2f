"""Selections: sets of elements that grow along links, or change by what the user picks."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Literal

from ...graph import Graph
from ...graph.walk import find_reachable
from .elements import list_elements
from .layout import element_links

SelectMode = Literal["replace", "extend", "add", "remove", "toggle"]
"""What picked elements do to a selection. `extend` replaces it too, but the active element stays the active one."""

Steps = Callable[[str, str], tuple[tuple[str, str], ...]]
"""The ways to follow along a link, given its source and target."""


def combine_selection(
    selection: Collection[str], active: str, picked: Sequence[str], mode: SelectMode
) -> tuple[list[str], str]:
    """The elements that are selected after some were picked, and which of them is active ("": the last)."""
    old = set(selection)
    match mode:
        case "replace":
            return [*picked], ""
        case "extend":
            return [*picked], active
        case "add":
            return [*(old - set(picked)), *picked], ""
        case "remove":
            return sorted(old - set(picked)), active
        case "toggle":
            added = [key for key in picked if key not in old]
            return [*sorted(old - set(picked)), *added], added[-1] if added else active


def invert_selection(elements: Iterable[str], selection: Collection[str]) -> tuple[str, ...]:
    """The elements that are not selected."""
    return tuple(key for key in elements if key not in selection)


def find_upstream(graph: Graph, selection: Collection[str]) -> tuple[str, ...]:
    """The selection and everything that it depends on."""
    return _spread(graph, selection, lambda start, end: ((end, start),))


def find_downstream(graph: Graph, selection: Collection[str]) -> tuple[str, ...]:
    """The selection and everything that depends on it."""
    return _spread(graph, selection, lambda start, end: ((start, end),))


def find_linked(graph: Graph, selection: Collection[str]) -> tuple[str, ...]:
    """The selection and everything that links hold together with it."""
    return _spread(graph, selection, lambda start, end: ((start, end), (end, start)))


def _spread(graph: Graph, selection: Collection[str], steps: Steps) -> tuple[str, ...]:
    ways: dict[str, list[str]] = {}
    for link in element_links(graph):
        for start, end in steps(*link):
            ways.setdefault(start, []).append(end)
    reached = {*selection, *find_reachable(selection, ways)}
    return tuple(key for key in list_elements(graph) if key in reached)
