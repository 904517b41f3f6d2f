"""The files that code of nodes is in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from ..custom_nodes import CustomNode, Language
from ..graph import Graph, Group, Item, Unknown
from ..graph.paths import resolve_path


def code_files(graph: Graph) -> tuple[Path, ...]:
    """The files that code of the graph and of its groups is in, with the vertex shaders that may lie beside them."""
    files: dict[Path, None] = {}
    for body, item in code_items(graph):
        if file := code_file(item, body.folder):
            files[file] = None
            if getattr(item, "id", getattr(item, "type", "")) == "isf":
                files[file.with_suffix(".vs")] = None
    return tuple(files)


def code_items(graph: Graph, borrowed: bool = True) -> Iterator[tuple[Graph, Item]]:
    """Every node of a graph and of its groups with the graph that it is in; `borrowed`: of groups from files too."""
    todo = [graph]
    while todo:
        body = todo.pop()
        for item in body.nodes.values():
            if not isinstance(item, Group):
                yield body, item
            elif borrowed or not item.path:
                todo.append(item.graph)


def code_file(item: Item, folder: str) -> Path | None:
    """The file that the code of a node is in."""
    if isinstance(item, CustomNode):
        file = item.code.file
    else:
        file = item.raw.get("file") if isinstance(item, Unknown) and item.type in get_args(Language) else ""
    return resolve_path(file, folder) if isinstance(file, str) and file else None
