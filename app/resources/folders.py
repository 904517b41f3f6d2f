"""Walks through folders: those of a project, without what somebody else's software has installed, and those that a
pattern with wildcards names."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path, PurePath

from .sandbox import Sandbox

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


def find_matches(pattern: str, sandbox: Sandbox) -> list[str]:
    """The files and folders that match a pattern, in order. `*`, `?` and `[]` match as in a shell, not a leading dot.

    `**` stands for any folders, but enters none through a link: links may lead in circles, and `glob` follows them for
    ever. What a link leads to outside of the sandbox does not match. Raises InputError for a pattern that itself leads
    outside.
    """
    parts = PurePath(pattern).parts
    depth = next((index for index, part in enumerate(parts) if glob.has_magic(part)), len(parts))
    start, wildcards = str(PurePath(*parts[:depth])) if depth else "", parts[depth:]
    sandbox.check(start or ".")
    matches, states = set[str](), [(start, 0)]
    seen = set(states)  # a file may match in many ways, which are not tried one by one
    while states:
        folder, index = states.pop()
        if index == len(wildcards):
            matches.add(folder)
            continue
        for state in _step_into(folder, wildcards, index, sandbox):
            if state not in seen:
                seen.add(state)
                states.append(state)
    return sorted(matches - {""})


def _step_into(folder: str, parts: tuple[str, ...], index: int, sandbox: Sandbox) -> Iterator[tuple[str, int]]:
    """What matches up to a part of a pattern, and the index of the part that comes next."""
    part = parts[index]
    if not glob.has_magic(part):
        path = str(PurePath(folder, part))
        if os.path.lexists(path):
            yield path, index + 1
        return
    if part == "**":
        yield folder, index + 1
    for entry in _list_entries(folder, sandbox):
        path = str(PurePath(folder, entry.name))
        if entry.name.startswith(".") and not part.startswith("."):
            continue
        if part != "**":
            if fnmatch(entry.name, part):
                yield path, index + 1
        elif entry.is_dir(follow_symlinks=False):
            yield path, index
        elif index + 1 == len(parts):
            yield path, index + 1


def _list_entries(folder: str, sandbox: Sandbox) -> list[os.DirEntry[str]]:
    """The content of a folder; nothing of what is none, or may not be read."""
    if sandbox.find_read_fault(folder or "."):
        return []
    try:
        with os.scandir(folder or ".") as entries:
            return list(entries)
    except (OSError, ValueError):
        return []
