"""Deletes elements of the canvas."""

from __future__ import annotations

from collections.abc import Collection

from ...graph import INPUTS, Graph
from .element_id import ElementId
from .elements import without_entries
from .routes import remove_dots
from .wiring import remove_node


def delete_elements(graph: Graph, doomed: Collection[ElementId], heal: bool = True) -> Graph:
    """A graph without those elements; with `heal`, links of nodes are joined where they fit."""
    for id in [id for id in graph.nodes if id in doomed]:
        graph = remove_node(graph, id, heal)
    for element in sorted(doomed):
        if end := element.port:
            if end.node == INPUTS and end.socket in graph.inputs:
                graph = graph.remove_input(end.socket)
            elif end.node != INPUTS and end.socket in graph.outputs:
                graph = graph.remove_output(end.socket)
    graph = remove_dots(graph, [element for element in doomed if element.kind == "dot"])
    return without_entries(graph, [element for element in doomed if element.is_note])
