"""Rendering a graph again whenever a file that it is made of changes.

These are its own file, the files of its groups and code, its pictures, and the shaders and classes of nodes. What to
watch depends on the graph, and the graph may change between reading it and watching its files. So `_load_watched`
watches first, then reads, and repeats this until the list of files stays the same. A graph that cannot be read says
nothing of its files; then every path in its text is watched, as one of them may be what is missing.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

from msgspec import Struct

from ..compiler.library import reload_library
from ..errors import GraphError, HalationError, InputError
from ..graph import Graph
from ..renderer.jobs.reports import FrameReport, JobProgress, JobReport
from ..resources.input_files import read_bytes
from ..resources.sandbox import Sandbox
from .code_files import code_files
from .reloading import NodeFiles, shader_folder
from .sequence_files import list_sequence_files
from .watching import FileChange, FileWatcher, find_group_files, find_pictures

_POLL_SECONDS = 0.05
"""Seconds between two looks at what has changed: nobody notices them."""
_CALM_SECONDS = 0.1
"""Seconds without another change after which a burst of changes is over: programs often save several files at once."""


class WatchReport(Struct, frozen=True):
    """One rendering: its report, or the fault that prevented it; and the files that had changed before, if any."""

    changed: tuple[Path, ...]
    seconds: float
    report: JobReport | None = None
    fault: HalationError | None = None


class _Outdated(Exception):
    """Raised to end a rendering during which a file changed."""


class ContinuousRenderer:
    """An endless iterator of renderings; each waits until a file has changed.

    `load` reads the graph, `bindings` returns the files of its inputs, `render` renders it. If one of them raises an
    error of `app.errors`, that is a rendering without a report, and the files that the graph named last stay watched. A
    rendering during which a file changes is started again.
    """

    def __init__(
        self,
        path: Path,
        bindings: Callable[[Graph], Mapping[str, str]],
        load: Callable[[], Graph],
        render: Callable[[Graph, JobProgress], JobReport],
        sandbox: Sandbox,
    ) -> None:
        self._sandbox = sandbox
        self._path, self._bindings = path.absolute(), bindings
        self._load, self._render = load, render
        self._watcher, self._nodes = FileWatcher(sandbox), NodeFiles()
        self._watched: tuple[tuple[Path, ...], ...] = ((), (), ())
        self._news: dict[Path, FileChange] = {}

    def __iter__(self) -> Iterator[WatchReport]:
        changed: tuple[Path, ...] = ()
        while True:
            started = time.perf_counter()
            try:
                report, fault = self._render(self._load_watched(), _OutdatedCheck(self._has_news)), None
            except _Outdated:
                changed = tuple(dict.fromkeys((*changed, *self._wait_for_changes())))
                continue
            except HalationError as error:
                report, fault = None, error
            yield WatchReport(changed, time.perf_counter() - started, report, fault)
            changed = self._wait_for_changes()

    def close(self) -> None:
        """Stop watching."""
        self._watcher.close()

    # --- what is watched -----------------------------------------------------------------------------------------

    def _load_watched(self) -> Graph:
        """Read the graph, with the watch on all its files started before they are read."""
        while True:
            self._watch()
            try:
                graph = self._load()
                bound = self._bindings(graph)
            except HalationError:
                self._watched = (self._watched[0] + _find_named_files(self._path, self._sandbox), *self._watched[1:])
                self._watch()
                raise
            pictures = list_sequence_files(find_pictures(graph, bound), sandbox=self._sandbox)
            files = (find_group_files(graph), pictures, code_files(graph))
            if files == self._watched:
                return graph
            self._watched = files

    def _watch(self) -> None:
        groups, pictures, code = self._watched
        self._watcher.watch(self._path, groups, pictures, [shader_folder()], [self._nodes.folder], code)

    def _has_news(self) -> bool:
        """True if there is news."""
        self._news |= {change.path: change for change in self._watcher.poll()}
        return bool(self._news)

    def _wait_for_changes(self) -> tuple[Path, ...]:
        """Wait until something has changed, and then until nothing changes any more."""
        while not self._has_news():
            time.sleep(_POLL_SECONDS)
        count = 0
        while count != len(self._news):
            count = len(self._news)
            time.sleep(_CALM_SECONDS)
            self._has_news()
        news, self._news = self._news, {}
        if any(change.kind == "shader" for change in news.values()):
            reload_library()
        if any(change.kind == "node" for change in news.values()) and (fault := self._nodes.reload()):
            self._refuse(fault)
        return tuple(news)

    def _refuse(self, fault: str) -> None:
        """Report in the next rendering that a file of a node is broken; all node classes stay as they were."""
        load = self._load

        def raise_fault() -> Graph:
            self._load = load
            raise GraphError(fault)

        self._load = raise_fault


class _OutdatedCheck:
    """Ends a rendering between two passes once a file has changed."""

    def __init__(self, is_outdated: Callable[[], bool]) -> None:
        self._is_outdated = is_outdated

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """A pass is through."""
        if self._is_outdated():
            raise _Outdated

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """A finished frame is no reason to stop."""


def _find_named_files(path: Path, sandbox: Sandbox) -> tuple[Path, ...]:
    """All files that a document which cannot be loaded may name, and that these name: one may be missing."""
    files: dict[Path, None] = {}
    todo = [path]
    while todo:
        file = todo.pop()
        try:
            tree: Any = json.loads(read_bytes(file, sandbox))
        except (InputError, ValueError, RecursionError):
            continue
        for text in _texts(tree):
            named = Path(file.parent, text).absolute()
            if named not in files:
                files[named] = None
                if named.suffix.casefold() == ".json":
                    todo.append(named)
    return tuple(files)


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
