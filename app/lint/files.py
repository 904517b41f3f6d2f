"""Finds the files to check: by name, folder or pattern."""

from __future__ import annotations

import glob
import json
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..document.disk import read_text
from ..errors import DocumentError, InputError
from ..resources.folders import find_matches, is_foreign, walk_project
from ..resources.sandbox import Sandbox

_KEY = re.compile(r'"halation"\s*:')


def find_graphs(paths: Iterable[Path], sandbox: Sandbox) -> Iterator[Path]:
    """The files to check, each once, in order.

    A folder stands for all graphs in it and below, except hidden folders, virtual environments and installed packages;
    a pattern for its matches, with the same exceptions below the folders that it names. A name stands for itself,
    whether such a file exists or not.
    """
    real_paths = set[str]()
    for path in paths:
        for graph_path in _expand(path, sandbox=sandbox):
            key = os.path.realpath(graph_path)
            if key not in real_paths:
                real_paths.add(key)
                yield graph_path


def _expand(path: Path, sandbox: Sandbox) -> Iterator[Path]:
    if path.is_dir():
        yield from _graphs_in_folder(path, sandbox=sandbox)
    elif path.exists() or not (matches := _find_matches(path, sandbox)):
        yield path
    else:
        depth = next((index for index, part in enumerate(path.parts) if glob.has_magic(part)), len(path.parts))
        for match in matches:
            steps = Path(match).parts
            if any(is_foreign(Path(*steps[:end])) for end in range(depth + 1, len(steps) + 1)):
                continue
            yield from _graphs_in_folder(Path(match), sandbox=sandbox) if Path(match).is_dir() else (Path(match),)


def _find_matches(path: Path, sandbox: Sandbox) -> list[str]:
    """The matches of a pattern; none of what is no pattern, or leads outside, so that it is refused as a file is."""
    try:
        return find_matches(str(path), sandbox) if glob.has_magic(str(path)) else []
    except InputError:
        return []


def _graphs_in_folder(folder: Path, sandbox: Sandbox) -> Iterator[Path]:
    """The graphs in a folder: JSON files that contain the key of graphs."""
    for path in walk_project(folder):
        if path.name.lower().endswith(".json") and is_graph(path, sandbox=sandbox):
            yield path


def is_graph(path: Path, sandbox: Sandbox) -> bool:
    """True for a text with the key that all graphs have, damaged or not."""
    try:
        text = read_text(path, sandbox=sandbox)
        return _KEY.search(text) is not None and "halation" in json.loads(text)
    except DocumentError:
        return False
    except (ValueError, RecursionError):
        return True
    except TypeError:
        return False
