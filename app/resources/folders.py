"""Walks through the folders of a project, without those that somebody else's software was installed into."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

_INSTALLED = frozenset({"node_modules", "site-packages", "dist-packages", "__pypackages__"})
"""Folders that the package managers of Python and JavaScript fill."""

_ENVIRONMENT_MARKS = ("pyvenv.cfg", "conda-meta")
"""What `venv` (PEP 405) and conda leave at the top of an environment."""


def walk_project(top: Path) -> Iterator[Path]:
    """Every file in a folder and below, in order, without hidden files and folders and without installed packages."""
    for folder, names_below, names in os.walk(top):
        names_below[:] = sorted(name for name in names_below if not is_foreign(Path(folder, name)))
        yield from (Path(folder, name) for name in sorted(names) if not name.startswith("."))


def is_foreign(folder: Path) -> bool:
    """True for a hidden folder, a virtual environment and a folder of installed packages: not the project's own."""
    is_named_so = folder.name.startswith(".") or folder.name in _INSTALLED
    return is_named_so or any((folder / mark).exists() for mark in _ENVIRONMENT_MARKS)
