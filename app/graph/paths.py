"""Changes the paths of files in a graph, which are relative to the folder of the graph file."""

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


def rebase_paths(graph: Graph, folder: str) -> Graph:
    """The graph for another folder: its relative paths are changed so that they name the same files.

    Also changes the bodies of groups, except those in files of their own.
    """
    if graph.folder == folder:
        return graph
    old, color = graph.folder, graph.settings.color
    if color.config and not color.config.startswith(BUILT_IN):
        color = structs.replace(color, config=relocate_path(color.config, old, folder))
        graph = replace(graph, settings=replace(graph.settings, color=color))
    return _change_graph(graph, folder, lambda path: relocate_path(path, old, folder))


def change_paths(graph: Graph, change: Change) -> Graph:
    """The graph with `change` applied to each path of a file, also in its groups."""
    return _change_graph(graph, graph.folder, lambda path: change(path) if path else path)


def inline_files(graph: Graph) -> Graph:
    """The graph with all bodies of groups and all code in itself, not in files; their paths are relative to its folder.

    ISF shaders that import files of their own stay in their file.
    """
    return replace(graph, nodes={id: _inline_item(item, graph.folder) for id, item in graph.nodes.items()})


def relocate_path(path: str, old: str, new: str) -> str:
    """A path relative to folder `old`, made relative to folder `new`. Absolute and empty paths stay as they are."""
    if not path or PurePath(path).is_absolute():
        return path
    target = os.path.abspath(Path(old, path))  # noqa: PTH100  (symbolic links stay)
    try:
        return Path(os.path.relpath(target, Path(new).absolute())).as_posix()
    except ValueError:
        return Path(target).as_posix()


def _change_graph(graph: Graph, folder: str, change: Change) -> Graph:
    return replace(
        graph,
        folder=folder,
        inputs={name: replace(end, file=change(end.file)) for name, end in graph.inputs.items()},
        nodes={id: _change_item(item, folder, change) for id, item in graph.nodes.items()},
    )


def _change_item(item: Item, folder: str, change: Change) -> Item:
    paths = _path_values(item)
    if isinstance(item, Node):
        new_paths: dict[str, Plain] = {name: change(str(item.setting(name))) for name in paths}
        return _change_code_file(item.with_values(**new_paths) if new_paths else item, change)
    if isinstance(item, Group):
        values = {
            name: change(str(plain)) if name in paths and _is_in_same_file(item, name) else plain
            for name, plain in item.values.items()
        }
        graph = item.graph if item.path else _change_graph(item.graph, folder, change)
        return Group(graph, change(item.path), values)
    file = item.raw.get("file") if item.type in get_args(Language) else None
    return structs.replace(item, raw={**item.raw, "file": change(file)}) if isinstance(file, str) else item


def _change_code_file(item: Node, change: Change) -> Node:
    """The node with another path of its code file, if it has one."""
    if not isinstance(item, CustomNode) or not item.code.file:
        return item
    kind = node_type(structs.replace(item.code, file=change(item.code.file)))
    return kind(**item.settings).with_length_units(item.length_units)


def _inline_item(item: Item, folder: str) -> Item:
    if isinstance(item, CustomNode) and item.code.file and not (item.code.vertex or "IMPORTED" in item.code.text):
        kind = node_type(structs.replace(item.code, file=""))
        return kind(**item.settings).with_length_units(item.length_units)
    if not isinstance(item, Group):
        return item
    # A path that a control sets is relative to the file of the control, so it is set before the body leaves that file.
    sets_paths = bool(_path_values(item) & item.values.keys())
    body = item.body() if sets_paths else item.graph
    body = body if item.path else replace(body, folder=folder)
    return Group(rebase_paths(inline_files(body), folder), "", {} if sets_paths else item.values)


def _path_values(item: Item) -> set[str]:
    return {name for name, value in signature(item).values.items() if value.type == "path"}


def _is_in_same_file(item: Item | None, control: str) -> bool:
    """True if the value that a control of a group sets lies in the same file as the group."""
    while isinstance(item, Group):
        if item.path or control not in item.graph.controls:
            return False
        target = item.graph.controls[control].target
        item, control = item.graph.nodes.get(target.node), target.socket
    return True


def resolve_path(path: str, folder: str) -> Path:
    """The absolute, normalized path of a file that a graph in `folder` names; symbolic links are not followed."""
    return Path(os.path.abspath(Path(folder, path)))  # noqa: PTH100
