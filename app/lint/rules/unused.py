"""Parts of a graph on which no picture depends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, cast

from ...graph import INPUTS, OUTPUTS, Expression, Problem
from ...graph.evaluate_at_frame import find_named_value
from ...graph.rules import Rule
from ...graph.walk import find_reachable
from ..sheet import Check, GraphFacts

UNUSED_BRANCH = Rule(
    "unused-branch",
    "warning",
    "Nodes lead to no output, so they have no effect.",
    "Link the last of them to an output, or remove them.",
)
UNUSED_INPUT = Rule(
    "unused-input",
    "warning",
    "An input of the graph is not linked, so a picture that is bound to it is ignored.",
    "Link it, or remove it.",
)
STALE_LAYOUT = Rule(
    "stale-layout",
    "warning",
    "The layout has places of nodes that do not exist, as after a node was deleted by hand or in a merge.",
    "Remove the entries, or save the graph in the editor.",
)

_MOST_COUNTED = 10_000
"""Nodes that are counted for all dead ends together, because many ends can share one long branch. Chosen by
judgement."""


def find_unused_branches(sheet: GraphFacts) -> Iterator[Problem]:
    """The last nodes of branches that no output uses."""
    graph = sheet.graph
    if not graph.outputs:
        return
    ends = [OUTPUTS, *_find_used_nodes(sheet)]
    needed = {*ends, *find_reachable(ends, graph.feeding)}
    unused = {id: graph.feeding[id] - needed for id in graph.nodes if id not in needed}
    count = 0
    for id in unused:
        if not graph.fed[id] - {id}:
            rest = len(find_reachable([id], unused).keys() - {id}) if count < _MOST_COUNTED else 0
            count += rest
            more = f", nor do the {rest} before it" if rest > 1 else ", nor does the one before it" if rest else ""
            sentence = f"'{id}' leads to no output{more}: link it to something, or remove it"
            yield Problem(id, "", sentence, UNUSED_BRANCH, f"nodes.{id}")


def find_unused_inputs(sheet: GraphFacts) -> Iterator[Problem]:
    """Inputs that are not linked to anything."""
    read = {source.socket for source in sheet.graph.links.values() if source.node == INPUTS}
    for name in sheet.graph.inputs:
        if name not in read:
            sentence = f"the input '{name}' feeds nothing: link it, or remove it"
            yield Problem(INPUTS, name, sentence, UNUSED_INPUT, f"inputs.{name}")


def find_stale_layout(sheet: GraphFacts) -> Iterator[Problem]:
    """Layout entries of nodes that no longer exist."""
    graph, places = sheet.graph, sheet.graph.ui.get("nodes")
    ends = {INPUTS: graph.inputs, OUTPUTS: graph.outputs}
    for name in cast("Mapping[str, Any]", places) if isinstance(places, Mapping) else ():
        node, dot, socket = name.partition(".")
        if socket not in ends.get(node, ()) if dot else name not in graph.nodes:
            sentence = f"the layout has a place for '{name}', which is not there: remove it"
            yield Problem("", "", sentence, STALE_LAYOUT, f"ui.nodes.{name}")


def _find_used_nodes(sheet: GraphFacts) -> set[str]:
    """Nodes whose values are read by expressions, and nodes that a viewer shows."""
    graph, viewers = sheet.graph, sheet.graph.ui.get("viewers")
    read_nodes = {
        find_named_value(graph, name)[0].node
        for item in graph.animation.values()
        if isinstance(item, Expression)
        for name in item.names
    }
    viewer_ports = cast("Mapping[str, Any]", viewers).values() if isinstance(viewers, Mapping) else ()
    return (read_nodes | {str(port).partition(".")[0] for port in viewer_ports}) & graph.nodes.keys()


CHECKS = (
    Check(UNUSED_BRANCH, find_unused_branches),
    Check(UNUSED_INPUT, find_unused_inputs),
    Check(STALE_LAYOUT, find_stale_layout),
)
