"""What lies on the canvas, by key: nodes (`blur`), ends (`inputs.beauty`), `frames.f1`, `comments.c1`, `dots.d1`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, TypeGuard

from ...graph import INPUTS, OUTPUTS, Graph, Port

DECOR = ("frames", "comments", "dots")
"""The sections of `ui` whose entries are elements of their own."""

Place = tuple[float, float]
"""Canvas position of an element's top left."""

Sizes = Mapping[str, tuple[float, float]]
"""Width and height of elements by key."""


def list_elements(graph: Graph) -> tuple[str, ...]:
    """Every element of a graph: nodes, ends, then decor."""
    ends = (*(f"{INPUTS}.{name}" for name in graph.inputs), *(f"{OUTPUTS}.{name}" for name in graph.outputs))
    decor = (f"{section}.{id}" for section in DECOR for id in entries(graph, section))
    return (*graph.nodes, *ends, *decor)


def element_of(port: Port) -> str:
    """The key of the element that shows a port."""
    return str(port) if port.node in (INPUTS, OUTPUTS) else port.node


def end_port(key: str) -> Port | None:
    """The port that an end's key stands for; None for any other element."""
    side, dot, name = key.partition(".")
    return Port(side, name) if dot and side in (INPUTS, OUTPUTS) else None


def can_be_linked(key: str, graph: Graph) -> bool:
    """True for what links can meet: nodes and ends."""
    return key in graph.nodes or end_port(key) is not None


def is_note(key: str) -> bool:
    """True for what is only there to be read: frames and comments."""
    section, dot, _ = key.partition(".")
    return bool(dot) and section in ("frames", "comments")


def entries(graph: Graph, section: str) -> Mapping[str, Mapping[str, Any]]:
    """The well-formed entries of a section of `ui`."""
    return {id: entry for id, entry in _section(graph, section).items() if _is_object(entry)}


def entry(graph: Graph, key: str) -> Mapping[str, Any]:
    """What `ui` says of an element, empty if nothing."""
    section, id = _address(key)
    facts = _section(graph, section).get(id)
    return facts if _is_object(facts) else {}


def place(graph: Graph, key: str) -> Place | None:
    """Where an element was put, or None."""
    facts = entry(graph, key)
    x, y = facts.get("x"), facts.get("y")
    return (float(x), float(y)) if _is_number(x) and _is_number(y) else None


def with_entries(graph: Graph, changes: Mapping[str, Mapping[str, Any]]) -> Graph:
    """`ui` with facts about elements added by key; a fact of None goes."""
    sections: dict[str, dict[str, Any]] = {}
    for key, facts in changes.items():
        section, id = _address(key)
        entries_by_id = sections.setdefault(section, dict(_section(graph, section)))
        entries_by_id[id] = {name: fact for name, fact in {**entry(graph, key), **facts}.items() if fact is not None}
    return with_sections(graph, sections)


def without_entries(graph: Graph, elements: Iterable[str]) -> Graph:
    """`ui` without what it says of some elements."""
    sections: dict[str, dict[str, Any]] = {}
    for key in elements:
        section, id = _address(key)
        sections.setdefault(section, dict(_section(graph, section))).pop(id, None)
    return with_sections(graph, sections)


def with_places(graph: Graph, places: Mapping[str, Place]) -> Graph:
    """`ui` with elements somewhere else."""
    return with_entries(
        graph, {key: {"x": round_coordinate(x), "y": round_coordinate(y)} for key, (x, y) in places.items()}
    )


def with_sections(graph: Graph, sections: Mapping[str, Mapping[str, Any]]) -> Graph:
    """`ui` with whole sections replaced; empty ones go."""
    ui = {**graph.ui, **sections}
    for name, section in sections.items():
        if not section:
            del ui[name]
    return graph if ui == graph.ui else replace(graph, ui=ui)


def fresh_id(graph: Graph, section: str) -> str:
    """A free id for a frame, comment or dot: `f1`, `f2`, ..."""
    taken, number = entries(graph, section), 1
    while f"{section[0]}{number}" in taken:
        number += 1
    return f"{section[0]}{number}"


def round_coordinate(number: float) -> float:
    """A coordinate with as many digits as anyone can see; a whole one without a point, as people write it."""
    rounded = round(float(number), 2)
    return int(rounded) if rounded == int(rounded) else rounded


def clean_text(text: str) -> str:
    """Text as a file can hold it."""
    return text.encode("utf-8", "replace").decode()


def _section(graph: Graph, name: str) -> Mapping[str, Any]:
    section = graph.ui.get(name)
    return section if _is_object(section) else {}


def _is_object(item: object) -> TypeGuard[Mapping[str, Any]]:
    return isinstance(item, dict | MappingProxyType)


def _address(key: str) -> tuple[str, str]:
    section, _, id = key.partition(".")
    return (section, id) if section in DECOR and id else ("nodes", key)


def _is_number(item: object) -> TypeGuard[float]:
    return isinstance(item, int | float) and not isinstance(item, bool)
