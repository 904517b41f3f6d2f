"""Estimated sizes of elements that were not drawn yet."""

from __future__ import annotations

from ...graph import Graph, signature
from .element_id import ElementId
from .elements import Sizes, entry

WIDTH, HEADER, ROW = 180.0, 34.0, 22.0
COMMENT = (200.0, 60.0)
"""About what the editor draws, in canvas units: the first frame replaces it by what it has measured."""


def element_size(graph: Graph, element: ElementId, measured: Sizes | None = None) -> tuple[float, float]:
    """Width and height of an element: as measured, as saved, or a guess from its sockets."""
    if measured and element in measured:
        return measured[element]
    facts = entry(graph, element)
    if element.kind == "dot":
        return 0.0, 0.0
    if element.is_note:
        width, height = facts.get("w"), facts.get("h")
        return _number(width, COMMENT[0]), _number(height, COMMENT[1])
    if element not in graph.nodes or facts.get("collapsed") is True:
        return WIDTH, HEADER
    interface = signature(graph.nodes[element])
    return WIDTH, HEADER + ROW * max(len(interface.unfolded_inputs) + len(interface.outputs), 1)


def _number(item: object, default: float) -> float:
    return float(item) if isinstance(item, int | float) and not isinstance(item, bool) else default
