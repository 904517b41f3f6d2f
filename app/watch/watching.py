"""Noticing that files change: graphs, groups, pictures, shaders, code, files of nodes.

The notifications of the operating system only say when to look, not what changed. A thread then compares every watched
file with the state it had: its stamp (time, size, inode) and, except for pictures, the hash of its content. This has
four reasons. Editors save in different ways: they write in place, or replace the file, or remove and create it, and
notifications differ for each. Folders can be deleted and created again, and a watched folder that is gone sends
nothing. Network drives send nothing at all; there, files are compared once a second. And a file that was saved without
a change is no news.

A file that was just written is read only after it has rested for a moment, because the writer may not be done. What
this process writes itself is announced by `expect`, and is no news. `poll` hands over what changed and never waits, so
an interface can call it in every frame; `ContinuousRenderer` (rerendering) waits for it in a loop.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from hashlib import blake2b
from pathlib import Path
from typing import Literal

from halation.nodes import Node
from msgspec import Struct, field
from msgspec.structs import replace

from ..errors import InputError
from ..graph import Graph, Group, Port
from ..media.layers import split_layer
from ..resources.input_files import read_bytes
from ..resources.sandbox import UNRESTRICTED, Sandbox

_BURST_MILLISECONDS, _STEP_MILLISECONDS = 100, 20
"""Changes that follow each other faster are told together, at the latest after the first number: programs write a file
in several steps. Chosen by judgement."""

_WAKE_SECONDS = 0.05
"""How long it may take to notice that other files are wanted, where nothing wakes it."""

Kind = Literal["graph", "group", "picture", "code", "shader", "node"]
_Key = tuple[Kind, Path]

_ENDINGS: Mapping[Kind, str] = {"shader": ".glsl", "node": ".py"}
_POLL_SECONDS = 1.0
"""Seconds after which files are compared without a notification: a choice, for drives that send none."""

_FOLDERS_EVERY = 10
"""Comparisons without a notification, of which one looks into folders of shaders and nodes: these are part of
the installation, hardly ever on a network drive, and to look through their 300 files takes 20 ms."""

_REST_SECONDS = 0.15
"""Seconds that a file must stay unchanged before it is read, as its writer may not be done: a choice that users do not
notice."""


class FileChange(Struct, frozen=True):
    """A file whose content changed, or that was created or deleted."""

    kind: Kind
    path: Path
    exists: bool = True


class _WatchList(Struct, frozen=True):
    """What is watched: files, and folders with all files below them."""

    files: tuple[_Key, ...] = ()
    folders: tuple[_Key, ...] = ()


class _FileState(Struct, frozen=True):
    """The last state of a file: its stamp and since when it has it, and a mark of its content when it last rested."""

    stamp: tuple[int, int, int] | None
    content: bytes
    stamped_at: float
    rests: bool


class _WakeSignal(Struct):
    """The events that wake the thread: the end, and another list of files."""

    ended: threading.Event = field(default_factory=threading.Event)
    changed: threading.Event = field(default_factory=threading.Event)

    def is_set(self) -> bool:
        """True if the thread must wake up; `watchfiles` calls this."""
        return self.ended.is_set() or self.changed.is_set()


class FileWatcher:
    """Watches files on a thread of its own; `poll` never waits. `fault` is set if the system sends no notifications."""

    def __init__(self, sandbox: Sandbox) -> None:
        self.fault, self._sandbox = "", sandbox
        self._watched = _WatchList()
        self._known: dict[_Key, _FileState] = {}
        self._listed: frozenset[_Key] = frozenset()
        self._expected: dict[Path, list[bytes]] = {}
        self._news: dict[_Key, _FileState] = {}
        self._lock = threading.Lock()
        self._wake = _WakeSignal()
        self._thread = threading.Thread(target=self._run, name="watcher", daemon=True)
        self._thread.start()

    def watch(
        self,
        graph: Path | None = None,
        groups: Iterable[Path] = (),
        pictures: Iterable[Path] = (),
        shaders: Iterable[Path] = (),
        nodes: Iterable[Path] = (),
        code: Iterable[Path] = (),
    ) -> None:
        """Watch these from now on, and nothing else. Files may be missing; of shaders and nodes, give the folders."""
        files = (
            *_keys("graph", [graph] if graph else ()),
            *_keys("group", groups),
            *_keys("picture", pictures),
            *_keys("code", code),
        )
        watch_list = _WatchList(files, (*_keys("shader", shaders), *_keys("node", nodes)))
        if watch_list == self._watched:
            return
        # What is there now, not a moment later, is what the caller has read.
        fresh = {key: _inspect(key, None, self._sandbox) for key in watch_list.files if key not in self._watched.files}
        with self._lock:
            self._watched = watch_list
            self._known |= fresh
            self._news = {
                key: state for key, state in self._news.items() if key in _select_watched(watch_list, self._news)
            }
        self._wake.changed.set()

    @property
    def has_news(self) -> bool:
        """True if `poll` would return something; other threads may ask."""
        return bool(self._news)

    def poll(self) -> tuple[FileChange, ...]:
        """What changed since the last call, each file once."""
        if not self._news:
            return ()
        with self._lock:
            news, self._news = self._news, {}
            return tuple(
                FileChange(*key, exists=state.stamp is not None)
                for key, state in news.items()
                if not self._is_ours(key[1], state.content)
            )

    def differs(self, path: Path) -> bool:
        """True if the graph file was changed by another program, and the change was not polled yet."""
        key: _Key = ("graph", path)
        with self._lock:
            state, content = self._known.get(key), _content_mark(key, _file_stamp(path, self._sandbox), self._sandbox)
            if state is None or not content or content in self._expected.get(path, ()):
                return False
            return content != state.content or key in self._news

    def expect(self, path: Path) -> None:
        """Announce that this process wrote the file as it is now: that is no news."""
        with self._lock:
            self._expected.setdefault(path, []).append(
                _content_mark(("graph", path), _file_stamp(path, self._sandbox), self._sandbox)
            )

    def close(self) -> None:
        """Stop watching."""
        self._wake.ended.set()
        self._thread.join()

    def _is_ours(self, path: Path, content: bytes) -> bool:
        """True if this process wrote that content. Older expected contents are dropped: they were overwritten."""
        expected = self._expected.pop(path, [])
        if content not in expected:
            return False
        self._expected[path] = expected[expected.index(content) + 1 :]
        return True

    # --- on the thread of its own ------------------------------------------------------------------------------

    def _run(self) -> None:
        while not self._wake.ended.is_set():
            self._wake.changed.clear()
            self._settle()
            folders = self._folders()
            if not folders or self.fault:
                self._wait(_POLL_SECONDS)
                continue
            try:
                self._listen(folders)
            except (OSError, RuntimeError) as fault:
                if folders == self._folders():
                    self.fault = f"the system does not tell when files change ({fault}): they are compared every second"

    def _listen(self, folders: frozenset[tuple[Path, int]]) -> None:
        """Compare whenever something happens in the folders, until others are wanted. Raises OSError, RuntimeError."""
        from watchfiles import watch  # in this thread: an editor that starts need not wait for it

        events = watch(
            *(path for path, _ in folders),
            watch_filter=None,
            recursive=False,
            debounce=_BURST_MILLISECONDS,
            step=_STEP_MILLISECONDS,
            rust_timeout=int(1000 * _POLL_SECONDS),
            stop_event=self._wake,
            yield_on_timeout=True,
            raise_interrupt=False,
        )
        for number, changes in enumerate(events):
            is_whole = bool(changes) or number % _FOLDERS_EVERY == 0
            self._settle(is_whole)
            if is_whole and self._folders() != folders:
                return

    def _wait(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while not self._wake.is_set() and time.monotonic() < end:
            self._wake.ended.wait(_WAKE_SECONDS)

    def _folders(self) -> frozenset[tuple[Path, int]]:
        """The folders to listen to, each with its number: one that was made again is another."""
        watched = self._watched
        folders = {parent for _, path in watched.files for parent in (path.parent, Path(os.path.realpath(path)).parent)}
        for _, top in watched.folders:
            folders |= {Path(folder) for folder, _, _ in os.walk(top)}
        numbers = ((path, _file_stamp(path, UNRESTRICTED)) for path in folders)
        return frozenset((path, stamp[2]) for path, stamp in numbers if stamp)

    def _settle(self, is_whole: bool = True) -> None:
        """Compare until every file has been at rest; without folders if it is not `is_whole`."""
        self._compare(is_whole)
        while not self._wake.is_set() and not all(state.rests for state in self._known.values()):
            self._wait(_REST_SECONDS)
            self._compare()

    def _compare(self, is_whole: bool = True) -> None:
        """Note the files that changed since the last comparison; of watched folders only if it is `is_whole`."""
        with self._lock:
            watched, before, listed = self._watched, dict(self._known), self._listed
        folders = watched.folders if is_whole else ()
        inside = {key: folder for folder in folders for key in _files_inside(folder)}
        unlisted = [key for key in before if is_whole and key not in inside]
        removed = [key for key in unlisted if key in _select_watched(watched, (key,))]
        nothing = _FileState(None, b"", 0.0, True)
        # A file that a folder did not have when it was first looked at is news; all others are known from then on.
        old = {key: before.get(key) or (nothing if folder in listed else None) for key, folder in inside.items()}
        old |= {key: before.get(key) for key in (*watched.files, *removed)}
        states = {key: _inspect(key, state, self._sandbox) for key, state in old.items()}
        with self._lock:
            if watched is not self._watched:
                return
            self._known = states if is_whole else {**before, **states}
            self._listed = frozenset(watched.folders) if is_whole else listed
            self._news |= {
                key: state
                for key, state in states.items()
                if (before_state := old[key]) and before_state.content != state.content
            }


def find_pictures(graph: Graph, bindings: Mapping[str, object] | None = None) -> tuple[Path, ...]:
    """The image files that a graph reads, groups included; `bindings` fill its inputs in place of their own files."""
    bound = bindings or {}
    paths = [Path(split_layer(str(item))[0]) for item in bound.values() if isinstance(item, str | Path)]
    todo = [(graph, frozenset(bound))]
    while todo:
        body, filled = todo.pop()
        paths += [Path(body.folder, end.file) for name, end in body.inputs.items() if end.file and name not in filled]
        for id, item in body.nodes.items():
            if isinstance(item, Group):
                linked = (name for name in item.graph.inputs if Port(id, name) in body.links)
                todo.append((item.body(), frozenset(linked)))
            elif isinstance(item, Node):
                named = (str(item.setting(value.name)) for value in item.values.values() if value.type == "path")
                paths += [Path(body.folder, path) for path in named if path]
    return tuple(dict.fromkeys(path.absolute() for path in paths))


def find_group_files(graph: Graph) -> tuple[Path, ...]:
    """The graph files that groups come from, groups inside groups included."""
    files, todo = dict[Path, None](), [graph]
    while todo:
        body = todo.pop()
        for item in body.nodes.values():
            if isinstance(item, Group):
                todo.append(item.graph)
                if item.path:
                    files[Path(body.folder, item.path).absolute()] = None
    return tuple(files)


def _select_watched(watched: _WatchList, keys: Iterable[_Key]) -> set[_Key]:
    """The keys that are watched, as files or inside folders."""
    files, folders = set(watched.files), set(watched.folders)
    return {key for key in keys if key in files or any((key[0], folder) in folders for folder in key[1].parents)}


def _files_inside(folder: _Key) -> Iterator[_Key]:
    """The files of a folder that have the right ending."""
    kind, top = folder
    for path, _, names in os.walk(top):
        yield from _keys(kind, (Path(path, name) for name in names if name.endswith(_ENDINGS[kind])))


def _keys(kind: Kind, paths: Iterable[Path]) -> Iterator[_Key]:
    return ((kind, path) for path in dict.fromkeys(paths))


def _inspect(key: _Key, before: _FileState | None, sandbox: Sandbox) -> _FileState:
    """The state of a file now. Its content mark stays the old one until the file has rested."""
    reach = UNRESTRICTED if key[0] in _ENDINGS else sandbox  # shaders and nodes are those of Halation
    stamp, time_now = _file_stamp(key[1], reach), time.monotonic()
    if before is None:
        return _FileState(stamp, _content_mark(key, stamp, reach), time_now, False)
    if stamp != before.stamp:
        return replace(before, stamp=stamp, stamped_at=time_now, rests=False)
    if before.rests or time_now - before.stamped_at < _REST_SECONDS:
        return before
    return _FileState(stamp, _content_mark(key, stamp, reach), time_now, True)


def _file_stamp(path: Path, sandbox: Sandbox) -> tuple[int, int, int] | None:
    """Time, size and number of a file; None if there is none that may be read."""
    if sandbox.find_read_fault(path):
        return None
    try:
        status = path.stat()
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


def _content_mark(key: _Key, stamp: tuple[int, int, int] | None, sandbox: Sandbox) -> bytes:
    """What tells one content from another: of pictures, which are large, the stamp. b"" if there is no file."""
    kind, path = key
    if stamp is None or kind == "picture":
        return repr(stamp).encode() if stamp else b""
    try:
        return blake2b(read_bytes(path, sandbox), digest_size=16).digest()
    except InputError:
        return b""
