"""Rules about the surroundings of a graph file: its folder and its repository."""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Iterator
from pathlib import Path, PurePath

from msgspec import Struct, field
from msgspec.structs import replace

from ..errors import UsageError
from ..graph import Graph, Problem
from ..graph.frames import Pattern
from ..graph.rules import Rule
from ..resources.sandbox import Sandbox
from .rules.paths import is_absolute, list_paths, who
from .sheet import bodies

PATH_CASE = Rule(
    "path-case",
    "warning",
    "A path differs from the name on the disk in case or in the encoding of accents: some systems find "
    "the file, others do not.",
    "Write it as on the disk.",
)
OUTSIDE_REPOSITORY = Rule(
    "outside-repository",
    "warning",
    "A path leads out of the repository: a fresh clone does not have the file.",
    "Move the file into the repository, or allow it if a script provides the file.",
)
RULES = (PATH_CASE, OUTSIDE_REPOSITORY)


class Surroundings(Struct, eq=False):
    """Facts about folders, each read once."""

    sandbox: Sandbox
    _names: dict[str, frozenset[str]] = field(default_factory=dict[str, frozenset[str]])
    _spellings: dict[str, dict[str, list[str]]] = field(default_factory=dict[str, dict[str, list[str]]])
    _roots: dict[str, Path | None] = field(default_factory=dict[str, "Path | None"])

    def problems(self, graph: Graph) -> Iterator[Problem]:
        """Problems of the paths in a graph that has a folder."""
        folder = os.path.abspath(graph.folder)  # noqa: PTH100
        root = self.root(Path(folder))
        for body, inside, above in bodies(graph):
            for node, socket, at, path in list_paths(body):
                if is_absolute(path):
                    continue
                asker = f"{inside}{who(node, socket)}"
                problem = Problem(f"{inside}{node}", socket, "", PATH_CASE, f"{above}{at}")
                if right := self._find_spelling(folder, path):
                    sentence = f"{asker}: '{path}' is called '{right}' on disk: spell it like that"
                    yield replace(problem, sentence=sentence)
                if root and not os.path.normpath(os.path.join(folder, path)).startswith(os.path.join(root, "")):  # noqa: PTH118
                    sentence = f"{asker}: '{path}' leads out of the repository, where a fresh clone has nothing"
                    yield replace(problem, sentence=sentence, rule=OUTSIDE_REPOSITORY)

    def root(self, folder: Path) -> Path | None:
        """The root of the repository that a folder is in, or None."""
        key = str(folder)
        if key not in self._roots:
            home = (folder / ".git").exists()
            self._roots[key] = folder if home else self.root(folder.parent) if folder.parent != folder else None
        return self._roots[key]

    def _find_spelling(self, folder: str, path: str) -> str:
        """The path with the upper and lower case of the disk, if only the case differs; else ""."""
        here, parts = folder, list[str]()
        for part in PurePath(path).parts:
            if part != ".." and part not in self._in(here):
                if _is_pattern(part):
                    parts.append(part)
                    break
                alike = self._alike(here).get(_plain(part), ())
                if len(alike) != 1:
                    return ""
                parts.append(alike[0])
            else:
                parts.append(part)
            here = os.path.normpath(os.path.join(here, parts[-1]))  # noqa: PTH118
        spelling = "/".join(parts)
        return spelling if spelling != "/".join(PurePath(path).parts) else ""

    def _alike(self, folder: str) -> dict[str, list[str]]:
        """The content of a folder, by names without case."""
        if folder not in self._spellings:
            spellings = self._spellings.setdefault(folder, {})
            for name in self._in(folder):
                spellings.setdefault(_plain(name), []).append(name)
        return self._spellings[folder]

    def _in(self, folder: str) -> frozenset[str]:
        """The content of a folder; nothing if it may not be read."""
        if folder not in self._names:
            try:
                is_allowed = not self.sandbox.find_read_fault(folder)
                self._names[folder] = frozenset(os.listdir(folder) if is_allowed else ())  # noqa: PTH208
            except OSError:
                self._names[folder] = frozenset()
        return self._names[folder]


def _is_pattern(name: str) -> bool:
    try:
        return Pattern.parse(name) is not None
    except UsageError:
        return False


def _plain(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()
