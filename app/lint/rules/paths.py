"""Rules about paths that work on one machine only."""

from __future__ import annotations

import ntpath
from collections.abc import Iterator

from halation.nodes import Node

from ...custom_nodes import CustomNode
from ...graph import INPUTS, Graph, Group, Problem, signature
from ...graph.color import BUILT_IN
from ...graph.rules import Rule
from ..sheet import Check, GraphFacts

ABSOLUTE_PATH = Rule(
    "absolute-path",
    "warning",
    "A path is absolute: on another machine the file is probably missing.",
    "Write the path relative to the folder of the graph file.",
)
BACKSLASH_PATH = Rule(
    "backslash-path",
    "warning",
    "A path has backslashes, which separate folders on Windows only.",
    "Write slashes, which work on Windows too.",
)


def list_paths(graph: Graph) -> Iterator[tuple[str, str, str, str]]:
    """Every file path in a graph, without groups: node, socket, JSON path, and the path itself."""
    config = graph.settings.color.config
    if config and not config.startswith(BUILT_IN):
        yield "", "", "settings.color.config", config
    for name, end in graph.inputs.items():
        if end.file:
            yield INPUTS, name, f"inputs.{name}.file", end.file
    names_by_kind = {kind: _list_path_names(kind) for kind in set(map(type, graph.nodes.values()))}
    for id, item in graph.nodes.items():
        names = names_by_kind[type(item)]
        if isinstance(item, Group):
            names = tuple(name for name, value in signature(item).values.items() if value.type == "path")
            if item.path:
                yield id, "", f"nodes.{id}.path", item.path
        elif isinstance(item, CustomNode) and item.code.file:
            yield id, "", f"nodes.{id}.file", item.code.file
        for name in names:
            path = item.values.get(name, "") if isinstance(item, Group) else getattr(item, name)
            if isinstance(path, str) and path:
                yield id, name, f"nodes.{id}.values.{name}", path


def _list_path_names(kind: type) -> tuple[str, ...]:
    """The values of a node type that are paths: most types have none, and a graph may have 100,000 nodes."""
    values = kind.values if issubclass(kind, Node) else {}
    return tuple(name for name, value in values.items() if value.type == "path")


def is_absolute(path: str) -> bool:
    """True for a path that begins at a root or a drive, on any system."""
    return path.startswith("/") or bool(ntpath.splitdrive(path)[0])


def absolute_path(sheet: GraphFacts) -> Iterator[Problem]:
    """Finds absolute paths."""
    for node, socket, at, path in list_paths(sheet.graph):
        if is_absolute(path):
            sentence = (
                f"{who(node, socket)}: '{path}' is absolute, so other machines miss it: write it relative to the graph"
            )
            yield Problem(node, socket, sentence, ABSOLUTE_PATH, at)


def backslash_path(sheet: GraphFacts) -> Iterator[Problem]:
    """Finds paths with backslashes."""
    for node, socket, at, path in list_paths(sheet.graph):
        if "\\" in path and not is_absolute(path):
            better = path.replace("\\", "/")
            sentence = f"{who(node, socket)}: only Windows reads '{path}' as a path: write '{better}'"
            yield Problem(node, socket, sentence, BACKSLASH_PATH, at)


def who(node: str, socket: str) -> str:
    """The owner of a path, for a sentence: `read.path`, or the settings."""
    return f"{node}.{socket}" if socket else node or "settings"


CHECKS = (Check(ABSOLUTE_PATH, absolute_path), Check(BACKSLASH_PATH, backslash_path))
