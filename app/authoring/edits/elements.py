"""Reads and writes `graph.ui`: the position, size and text of the elements of a graph."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, TypeGuard

from ...graph import Graph
from .element_id import DECOR, DecorKind, ElementId, decor_section

Place = tuple[float, float]
"""Canvas position of an element's top left."""

Places = Mapping[ElementId, Place]
"""Where elements lie."""

Sizes = Mapping[ElementId, tuple[float, float]]
"""Width and height of elements."""


def list_elements(graph: Graph) -> tuple[ElementId, ...]:
    """Every element of a graph: nodes, inputs and outputs, then decor."""
    return (
        *map(ElementId, graph.nodes),
        *(ElementId.of("input", name) for name in graph.inputs),
        *(ElementId.of("output", name) for name in graph.outputs),
        *(element for kind in DECOR for element in list_decor(graph, kind)),
    )


def can_be_linked(element: ElementId, graph: Graph) -> bool:
    """True for elements with sockets: nodes, inputs and outputs."""
    return element in graph.nodes or element.port is not None


def list_decor(graph: Graph, kind: DecorKind) -> Mapping[ElementId, Mapping[str, Any]]:
    """All frames, comments or dots of a graph with their facts; malformed ones are left out."""
    section = _section(graph, decor_section(kind))
    return {ElementId.of(kind, name): facts for name, facts in section.items() if name and _is_object(facts)}


def entry(graph: Graph, element: ElementId) -> Mapping[str, Any]:
    """The facts of an element in `ui`; empty if there are none."""
    section, key = element.ui_entry
    facts = _section(graph, section).get(key)
    return facts if _is_object(facts) else {}


def place(graph: Graph, element: ElementId) -> Place | None:
    """Where an element was put, or None."""
    facts = entry(graph, element)
    x, y = facts.get("x"), facts.get("y")
    return (float(x), float(y)) if _is_number(x) and _is_number(y) else None


def with_entries(graph: Graph, changes: Mapping[ElementId, Mapping[str, Any]]) -> Graph:
    """The graph with facts about elements added to `ui`; a fact of None removes it."""
    sections: dict[str, dict[str, Any]] = {}
    for element, facts in changes.items():
        section, key = element.ui_entry
        entries = sections.setdefault(section, dict(_section(graph, section)))
        entries[key] = {name: fact for name, fact in {**entry(graph, element), **facts}.items() if fact is not None}
    return with_sections(graph, sections)


def without_entries(graph: Graph, elements: Iterable[ElementId]) -> Graph:
    """The graph without the facts of some elements."""
    sections: dict[str, dict[str, Any]] = {}
    for element in elements:
        section, key = element.ui_entry
        sections.setdefault(section, dict(_section(graph, section))).pop(key, None)
    return with_sections(graph, sections)


def with_places(graph: Graph, places: Mapping[ElementId, Place]) -> Graph:
    """The graph with elements at other places."""
    return with_entries(
        graph, {element: {"x": round_coordinate(x), "y": round_coordinate(y)} for element, (x, y) in places.items()}
    )


def with_sections(graph: Graph, sections: Mapping[str, Mapping[str, Any]]) -> Graph:
    """The graph with whole sections of `ui` replaced; empty ones are removed."""
    ui = {**graph.ui, **sections}
    for name, section in sections.items():
        if not section:
            del ui[name]
    return graph if ui == graph.ui else replace(graph, ui=ui)


def fresh_decor(graph: Graph, kind: DecorKind) -> ElementId:
    """A free id for a frame, comment or dot: `f1`, `f2`, ..."""
    existing, number = list_decor(graph, kind), 1
    while (element := ElementId.of(kind, f"{kind[0]}{number}")) in existing:
        number += 1
    return element


def round_coordinate(number: float) -> float:
    """A coordinate rounded to what can be seen; a whole one is an int, for short files."""
    rounded = round(float(number), 2)
    return int(rounded) if rounded == int(rounded) else rounded


def clean_text(text: str) -> str:
    """Text without characters that JSON in UTF-8 cannot hold."""
    return text.encode("utf-8", "replace").decode()


def _section(graph: Graph, name: str) -> Mapping[str, Any]:
    section = graph.ui.get(name)
    return section if _is_object(section) else {}


def _is_object(item: object) -> TypeGuard[Mapping[str, Any]]:
    return isinstance(item, dict | MappingProxyType)


def _is_number(item: object) -> TypeGuard[float]:
    return isinstance(item, int | float) and not isinstance(item, bool)
