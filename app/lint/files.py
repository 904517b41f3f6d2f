"""Which files are meant: names, folders and patterns."""

from __future__ import annotations

import glob
import json
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..document.disk import read_text
from ..errors import DocumentError

_KEY = re.compile(r'"halation"\s*:')


def find_graphs(paths: Iterable[Path]) -> Iterator[Path]:
    """Every file that is meant, once, in order.

    A folder stands for all graphs in it and below, hidden folders aside; a pattern for what it matches, `**` included.
    A name stands for itself, whether there is such a file or not.
    """
    real_paths = set[str]()
    for path in paths:
        for graph_path in _expand(path):
            key = os.path.realpath(graph_path)
            if key not in real_paths:
                real_paths.add(key)
                yield graph_path


def _expand(path: Path) -> Iterator[Path]:
    if path.is_dir():
        yield from _graphs_in_folder(path)
    elif path.exists() or not (matches := sorted(glob.glob(str(path), recursive=True))):  # noqa: PTH207
        yield path
    else:
        for match in matches:
            yield from _graphs_in_folder(Path(match)) if Path(match).is_dir() else (Path(match),)


def _graphs_in_folder(folder: Path) -> Iterator[Path]:
    """The graphs in a folder: JSON files that say they are one."""
    for here, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(names):
            if name.lower().endswith(".json") and not name.startswith(".") and is_graph(path := Path(here, name)):
                yield path


def is_graph(path: Path) -> bool:
    """True for a text with the key that all graphs have, damaged or not."""
    try:
        text = read_text(path)
        return _KEY.search(text) is not None and "halation" in json.loads(text)
    except DocumentError:
        return False
    except (ValueError, RecursionError):
        return True
    except TypeError:
        return False
