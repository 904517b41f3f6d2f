"""Rules about the text of a graph file."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, cast

from halation.nodes import Node

from .. import document
from ..document.syntax import member, parse
from ..errors import DocumentError, GraphError
from ..graph import Graph, Group, Problem
from ..graph.rules import Rule

UNREADABLE_GRAPH = Rule(
    "unreadable-graph",
    "error",
    "A graph file does not exist, is empty, far too large, or not text.",
    "Name another file.",
)
CONFLICT_MARKERS = Rule(
    "conflict-markers", "error", "A merge of git was left unfinished in the file.", "Resolve it, or merge again."
)
SYNTAX = Rule("syntax", "error", "The file is not valid JSON.", "Correct the line that is named.")
DOUBLE_KEY = Rule(
    "double-key",
    "error",
    "An object has the same key twice, as after a merge by lines: one of them would be lost.",
    "Remove one.",
)
SCHEMA = Rule(
    "schema",
    "error",
    "A value in the file has the wrong type.",
    "Correct it; with halation schema, a text editor shows it while you type.",
)
NEWER_VERSION = Rule(
    "newer-version", "error", "The file, or a node in it, was saved by a newer Halation.", "Update Halation."
)
MISSING_GROUP = Rule("missing-group", "error", "The file of a group does not exist.", "Correct its path.")
OLD_VERSION = Rule(
    "old-version",
    "warning",
    "A node was saved by an older version of its type. It is converted when it is read.",
    "halation fmt writes the current version.",
)
NOT_CANONICAL = Rule(
    "not-canonical",
    "warning",
    "The file does not have the canonical layout, or holds values that equal their default: the next save"
    " changes lines that nobody edited.",
    "halation fmt rewrites it.",
)
READING = (UNREADABLE_GRAPH, CONFLICT_MARKERS, SYNTAX, DOUBLE_KEY, SCHEMA, NEWER_VERSION, MISSING_GROUP)
RULES = (*READING, OLD_VERSION, NOT_CANONICAL)

_MARKER = r"(?m)^(<{7}|>{7}|\|{7})( |$)"


def explain_fault(fault: DocumentError, text: str) -> tuple[Problem, int]:
    """The problem of a text that is not a graph, and its line, or 0 if the line is unknown."""
    if fault.rule == SYNTAX.name and (marker := re.search(_MARKER, text)):
        words = "a git merge is unfinished here: keep one side, and remove the lines of <, = and >"
        return Problem("", "", words, CONFLICT_MARKERS), text.count("\n", 0, marker.start()) + 1
    rule = next((rule for rule in READING if rule.name == fault.rule), SCHEMA)
    words = ": ".join(part for part in (fault.path, fault.fault) if part)
    return Problem("", "", words, rule, fault.path), fault.line


def find_text_problems(graph: Graph, text: str, types: Mapping[str, type[Node]]) -> Iterator[tuple[Problem, int]]:
    """Problems of the text of a graph, with their lines; 0 if the JSON path gives the line."""
    try:
        # A checkout on Windows may have other line ends; git is responsible for these.
        line = document.find_first_difference(graph, text.replace("\r\n", "\n"))
    except GraphError:
        return
    if line is None:
        return
    if _has_versions(graph):
        yield from ((problem, 0) for problem in _list_outdated(parse(text, ""), types, ""))
    words = "the layout is not the canonical one from here on: halation fmt rewrites it"
    yield Problem("", "", words, NOT_CANONICAL), line


def _has_versions(graph: Graph) -> bool:
    """True if some nodes have a type with several versions."""
    kinds = set(map(type, graph.nodes.values()))
    if any(issubclass(kind, Node) and kind.version > 1 for kind in kinds):
        return True
    return Group in kinds and any(_has_versions(item.graph) for item in graph.nodes.values() if isinstance(item, Group))


def _list_outdated(raw: Mapping[str, Any], types: Mapping[str, type[Node]], at: str) -> Iterator[Problem]:
    """Nodes that were saved by an older version of their type, also in groups. `raw` is the text as read before."""
    nodes: Mapping[str, Mapping[str, Any]] = raw.get("nodes", {})
    for id, node in nodes.items():
        where = member(member(at, "nodes"), id)
        kind, version = types.get(node["type"]), node.get("version", 1)
        if kind and version < kind.version:
            words = f"'{id}' is of version {version} of '{kind.id}', which is at {kind.version}: run halation fmt"
            yield Problem(id, "", words, OLD_VERSION, where)
        body = node.get("graph") if node["type"] == "group" else None
        if isinstance(body, dict):
            yield from _list_outdated(cast("Mapping[str, Any]", body), types, member(where, "graph"))
