"""Paths of files in a graph, which are relative to the folder that the graph is saved in."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path, PurePath
from typing import get_args

from halation.nodes import Node, Plain
from msgspec import structs

from ..custom_nodes import CustomNode, Language, node_type
from .color import BUILT_IN
from .graph import Graph, Group, Item, signature

Change = Callable[[str], str]


def rebased(graph: Graph, folder: str) -> Graph:
    """The same graph saved in another folder: its relative paths lead to the same files as before.

    Bodies of groups that are part of the graph follow; those with a file of their own stay what they are.
    """
    if graph.folder == folder:
        return graph
    old, color = graph.folder, graph.settings.color
    if color.config and not color.config.startswith(BUILT_IN):
        color = structs.replace(color, config=relocated(color.config, old, folder))
        graph = replace(graph, settings=replace(graph.settings, color=color))
    return _changed(graph, folder, lambda path: relocated(path, old, folder))


def repointed(graph: Graph, change: Change) -> Graph:
    """The same graph with other paths of files, those of its own groups included."""
    return _changed(graph, graph.folder, lambda path: change(path) if path else path)


def inlined(graph: Graph) -> Graph:
    """The graph with the bodies of all groups and all code in it, and their paths as seen from its own folder.

    Shaders in the Interactive Shader Format that have files of their own beside them stay in their file.
    """
    return replace(graph, nodes={id: _inlined(item, graph.folder) for id, item in graph.nodes.items()})


def relocated(path: str, old: str, new: str) -> str:
    """A path relative to folder `old`, as seen from folder `new`. Absolute and empty ones stay."""
    if not path or PurePath(path).is_absolute():
        return path
    there = os.path.abspath(Path(old, path))  # noqa: PTH100  (a link to a folder stays a link)
    try:
        return Path(os.path.relpath(there, Path(new).absolute())).as_posix()
    except ValueError:
        return Path(there).as_posix()


def _changed(graph: Graph, folder: str, change: Change) -> Graph:
    return replace(
        graph,
        folder=folder,
        inputs={name: replace(end, file=change(end.file)) for name, end in graph.inputs.items()},
        nodes={id: _item(item, folder, change) for id, item in graph.nodes.items()},
    )


def _item(item: Item, folder: str, change: Change) -> Item:
    paths = _paths(item)
    if isinstance(item, Node):
        changed: dict[str, Plain] = {name: change(getattr(item, name)) for name in paths}
        return _code(item.with_values(**changed) if changed else item, change)
    if isinstance(item, Group):
        values = {
            name: change(str(plain)) if name in paths and _is_ours(item, name) else plain
            for name, plain in item.values.items()
        }
        graph = item.graph if item.path else _changed(item.graph, folder, change)
        return Group(graph, change(item.path), values)
    file = item.raw.get("file") if item.type in get_args(Language) else None
    return replace(item, raw={**item.raw, "file": change(file)}) if isinstance(file, str) else item


def _code(item: Node, change: Change) -> Node:
    """The same node with the file that its code is in, if it is in one, somewhere else."""
    if not isinstance(item, CustomNode) or not item.code.file:
        return item
    kind = node_type(structs.replace(item.code, file=change(item.code.file)))
    return kind(**{name: getattr(item, name) for name in item.values})


def _inlined(item: Item, folder: str) -> Item:
    if isinstance(item, CustomNode) and item.code.file and not (item.code.vertex or "IMPORTED" in item.code.text):
        kind = node_type(structs.replace(item.code, file=""))
        return kind(**{name: getattr(item, name) for name in item.values})
    if not isinstance(item, Group):
        return item
    # A path that a control sets belongs to the file that the control is in: it goes there before that file is left.
    whole = bool(_paths(item) & item.values.keys())
    body = item.body() if whole else item.graph
    body = body if item.path else replace(body, folder=folder)
    return Group(rebased(inlined(body), folder), "", {} if whole else item.values)


def _paths(item: Item) -> set[str]:
    return {name for name, value in signature(item).values.items() if value.type == "path"}


def _is_ours(item: Item | None, control: str) -> bool:
    """True if what a control of a group sets belongs to the same file as the group."""
    while isinstance(item, Group):
        if item.path or control not in item.graph.controls:
            return False
        target = item.graph.controls[control].target
        item, control = item.graph.nodes.get(target.node), target.socket
    return True


def full(path: str, folder: str) -> Path:
    """The file that a graph in `folder` names, always written in the same way; links stay as they are."""
    return Path(os.path.abspath(Path(folder, path)))  # noqa: PTH100
