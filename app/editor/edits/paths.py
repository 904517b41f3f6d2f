"""Paths of files in a graph, which are relative to the folder that the graph is saved in."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path, PurePath

from ....nodes import Node, Plain
from ...errors import UsageError
from ...graph import Graph, Group, Item, signature


def rebased(graph: Graph, folder: str) -> Graph:
    """The same graph saved in another folder: its relative paths lead to the same files as before.

    Bodies of groups that are part of the graph follow; those with a file of their own stay what they are.
    """
    if graph.folder == folder:
        return graph

    def moved(path: str) -> str:
        return relocated(path, graph.folder, folder)

    return replace(
        graph, folder=folder,
        inputs={name: replace(end, file=moved(end.file)) for name, end in graph.inputs.items()},
        nodes={id: _item(item, graph.folder, folder) for id, item in graph.nodes.items()},
    )


def relocated(path: str, old: str, new: str) -> str:
    """A path relative to folder `old`, as seen from folder `new`. Absolute and empty ones stay."""
    if not path or PurePath(path).is_absolute():
        return path
    there = os.path.abspath(Path(old, path))  # noqa: PTH100  (a link to a folder stays a link)
    try:
        return Path(os.path.relpath(there, Path(new).absolute())).as_posix()
    except ValueError:
        return Path(there).as_posix()


def relative(path: str | Path, folder: str) -> str:
    """How a graph in `folder` names a file: relative if the file is below that folder, else absolute."""
    full = Path(os.path.abspath(path))  # noqa: PTH100
    base = Path(folder).absolute()
    return full.relative_to(base).as_posix() if folder and full.is_relative_to(base) else full.as_posix()


def group_files(graph: Graph) -> Iterator[Path]:
    """The files that groups are read from, at any depth."""
    todo = [graph]
    while todo:
        body = todo.pop()
        for item in body.nodes.values():
            if isinstance(item, Group):
                if item.path:
                    yield Path(body.folder, item.path)
                todo.append(item.graph)


def check_target(graph: Graph, target: Path) -> None:
    """Raise UsageError where saving `graph` as `target` would put that file into itself."""
    if target.resolve() in {file.resolve() for file in group_files(graph)}:
        raise UsageError(f"{target}: this file is used as a group in what would be saved there: choose another name")


def _item(item: Item, old: str, new: str) -> Item:
    paths = {name for name, value in signature(item).values.items() if value.type == "path"}
    if isinstance(item, Node):
        changed: dict[str, Plain] = {name: relocated(getattr(item, name), old, new) for name in paths}
        return item.changed(**changed) if changed else item
    if isinstance(item, Group):
        values = {
            name: relocated(str(plain), old, new) if name in paths and _is_ours(item, name) else plain
            for name, plain in item.values.items()
        }
        graph = item.graph if item.path else rebased(replace(item.graph, folder=old), new)
        path = relocated(item.path, old, new)
        return Group(graph, path, values)
    return item


def _is_ours(item: Item | None, control: str) -> bool:
    """True if what a control of a group sets belongs to the same file as the group."""
    while isinstance(item, Group):
        if item.path or control not in item.graph.controls:
            return False
        target = item.graph.controls[control].target
        item, control = item.graph.nodes.get(target.node), target.socket
    return True
