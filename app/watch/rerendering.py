"""A graph rendered again whenever what it is made of changes: its file, groups, code, pictures, shaders, nodes."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from ..compiler import installed_library
from ..errors import GraphError, HalationError
from ..graph import Graph
from ..renderer.jobs.job import FrameReport, Progress, Report
from .code_files import code_files
from .reloading import NodeFiles, shader_folder
from .sequence_files import all_files
from .watching import Change, Watcher, groups_of, pictures_of

_LOOK = 0.05
_CALM = 0.1
"""Seconds without another change after which a burst of them is over."""


@dataclass(frozen=True)
class Turn:
    """What came of rendering once: a report, or why there is none; and the files that had changed before, if any."""

    changed: tuple[Path, ...]
    seconds: float
    report: Report | None = None
    fault: HalationError | None = None


class _Outdated(Exception):
    """Something changed while it was being rendered."""


class Rerendering:
    """Turn after turn, for as long as somebody asks for the next one; each waits until something has changed.

    `load` reads the graph, `bindings` are the files that fill its inputs, `render` renders it. What either raises of
    `app.errors` is a turn without a report, and what the graph named last goes on being watched. A rendering that is
    outdated before it has ended is begun again.
    """

    def __init__(
        self,
        path: Path,
        bindings: Callable[[Graph], Mapping[str, str]],
        load: Callable[[], Graph],
        render: Callable[[Graph, Progress], Report],
    ) -> None:
        self._path, self._bindings = path.absolute(), bindings
        self._load, self._render = load, render
        self._watcher, self._nodes = Watcher(), NodeFiles()
        self._watched: tuple[tuple[Path, ...], ...] = ((), (), ())
        self._news: dict[Path, Change] = {}

    def __iter__(self) -> Iterator[Turn]:
        changed: tuple[Path, ...] = ()
        while True:
            started = time.perf_counter()
            try:
                report, fault = self._render(self._loaded(), _Ends(self._look)), None
            except _Outdated:
                changed = tuple(dict.fromkeys((*changed, *self._changes())))
                continue
            except HalationError as error:
                report, fault = None, error
            yield Turn(changed, time.perf_counter() - started, report, fault)
            changed = self._changes()

    def close(self) -> None:
        """Stop watching."""
        self._watcher.close()

    # --- what is watched -----------------------------------------------------------------------------------------

    def _loaded(self) -> Graph:
        """The graph as it is now; what it is made of is watched before it is read."""
        while True:
            self._watch()
            try:
                graph = self._load()
                bound = self._bindings(graph)
            except HalationError:
                self._watched = (self._watched[0] + _named(self._path), *self._watched[1:])
                self._watch()
                raise
            pictures = all_files(pictures_of(graph, bound))
            now = (groups_of(graph), pictures, code_files(graph))
            if now == self._watched:
                return graph
            self._watched = now

    def _watch(self) -> None:
        groups, pictures, code = self._watched
        self._watcher.watch(self._path, groups, pictures, [shader_folder()], [self._nodes.folder], code)

    def _look(self) -> bool:
        """True if there is news."""
        self._news |= {change.path: change for change in self._watcher.poll()}
        return bool(self._news)

    def _changes(self) -> tuple[Path, ...]:
        """Wait until something has changed, and then until nothing changes any more."""
        while not self._look():
            time.sleep(_LOOK)
        count = 0
        while count != len(self._news):
            count = len(self._news)
            time.sleep(_CALM)
            self._look()
        news, self._news = self._news, {}
        if any(change.kind == "shader" for change in news.values()):
            installed_library.cache_clear()
        if any(change.kind == "node" for change in news.values()) and (fault := self._nodes.reload()):
            self._refuse(fault)
        return tuple(news)

    def _refuse(self, fault: str) -> None:
        """Say in the next turn that a file of a node is broken; all nodes are as they were."""
        load = self._load

        def refusing() -> Graph:
            self._load = load
            raise GraphError(fault)

        self._load = refusing


class _Ends:
    """Ends a rendering between two passes once it is outdated."""

    def __init__(self, is_outdated: Callable[[], bool]) -> None:
        self._is_outdated = is_outdated

    def passed(self, frame: int, done: int, total: int, nodes: Sequence[str]) -> None:
        """A pass is through."""
        if self._is_outdated():
            raise _Outdated

    def finished(self, report: FrameReport, done: int, total: int) -> None:
        """The files of a frame are there, which is no reason to stop."""


def _named(path: Path) -> tuple[Path, ...]:
    """Files that a document names which cannot be loaded: one of them may be what is missing."""
    found: dict[Path, None] = {}
    todo = [path]
    while todo:
        file = todo.pop()
        try:
            tree: Any = json.loads(file.read_bytes())
        except (OSError, ValueError, RecursionError):
            continue
        for text in _texts(tree):
            other = Path(file.parent, text).absolute()
            if other not in found:
                found[other] = None
                if other.suffix.casefold() == ".json":
                    todo.append(other)
    return tuple(found)


def _texts(tree: Any) -> Iterable[str]:
    """The paths in a tree of JSON."""
    todo = [tree]
    while todo:
        item = todo.pop()
        if isinstance(item, dict):
            entries = cast("dict[str, Any]", item)
            yield from (text for key in ("path", "file") if isinstance(text := entries.get(key), str) and text)
            todo += entries.values()
        elif isinstance(item, list):
            todo += cast("list[Any]", item)
