"""Paths of files in a graph, which are relative to the folder that the graph is saved in."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ...errors import UsageError
from ...graph import Graph, Group
from ...graph.paths import rebase_paths, relocate_path, resolve_path
from ...language.translation import translate

__all__ = ["check_target", "group_files", "make_relative", "rebase_paths", "relocate_path", "resolve_path"]


def make_relative(path: str | Path, folder: str) -> str:
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
        raise UsageError(
            translate(
                "{target}: this file is used as a group in what would be saved there: choose another name",
                target=target,
            )
        )
