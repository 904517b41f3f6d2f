"""Notices when files change that the editor shows: graphs, pictures, shaders, files of nodes.

What the system tells only says when to look. What changed is found by comparing files with what was known of them:
nothing is missed while folders come and go, and a system that tells nothing merely makes it slower.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from hashlib import blake2b
from pathlib import Path
from typing import Literal

from halation.nodes import Node
from watchfiles import watch

from ..graph import Graph, Group, Port
from ..media.layers import split_layer

Kind = Literal["graph", "group", "picture", "code", "shader", "node"]
_Key = tuple[Kind, Path]

_ENDINGS: Mapping[Kind, str] = {"shader": ".glsl", "node": ".py"}
_LOOK = 1.0
"""Seconds after which files are compared even if nothing was told."""

_REST = 0.15
"""Seconds that a file must be left alone before it is read: it may still be being written."""


@dataclass(frozen=True)
class Change:
    """A file that is not what it was. In a folder, `path` is that of the file."""

    kind: Kind
    path: Path
    exists: bool = True


@dataclass(frozen=True)
class _Watched:
    """What to watch: files, and folders with all that is in them."""

    files: tuple[_Key, ...] = ()
    folders: tuple[_Key, ...] = ()


@dataclass(frozen=True)
class _Known:
    """What is known of a file: the stamp it had at time `seen`, and the content that was there when it last rested."""

    stamp: tuple[int, int, int] | None
    content: bytes
    seen: float
    rests: bool


@dataclass
class _Wake:
    """True when the thread has to look up from waiting."""

    ended: threading.Event = field(default_factory=threading.Event)
    changed: threading.Event = field(default_factory=threading.Event)

    def is_set(self) -> bool:
        """What `watchfiles` asks."""
        return self.ended.is_set() or self.changed.is_set()


class Watcher:
    """Watches on a thread of its own; `poll` never waits. `fault` says so if the system does not tell of changes."""

    def __init__(self) -> None:
        self.fault = ""
        self._watched = _Watched()
        self._known: dict[_Key, _Known] = {}
        self._listed: frozenset[_Key] = frozenset()
        self._expected: dict[Path, list[bytes]] = {}
        self._news: dict[_Key, _Known] = {}
        self._lock = threading.Lock()
        self._wake = _Wake()
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
        wanted = _Watched(files, (*_keys("shader", shaders), *_keys("node", nodes)))
        if wanted == self._watched:
            return
        # What is there now, not a moment later, is what the caller has read.
        fresh = {key: _look(key, None) for key in wanted.files if key not in self._watched.files}
        with self._lock:
            self._watched = wanted
            self._known |= fresh
            self._news = {key: one for key, one in self._news.items() if key in _covered(wanted, self._news)}
        self._wake.changed.set()

    def poll(self) -> tuple[Change, ...]:
        """What changed since the last call, each file once."""
        if not self._news:
            return ()
        with self._lock:
            news, self._news = self._news, {}
            return tuple(
                Change(*key, exists=one.stamp is not None)
                for key, one in news.items()
                if not self._is_ours(key[1], one.content)
            )

    def differs(self, path: Path) -> bool:
        """True if the graph file holds something that nobody here has read, been told of, or written."""
        key: _Key = ("graph", path)
        with self._lock:
            known, now = self._known.get(key), _content(key, _stamp(path))
            if known is None or not now or now in self._expected.get(path, ()):
                return False
            return now != known.content or key in self._news

    def expect(self, path: Path) -> None:
        """What the file holds now is our own doing, and no news."""
        with self._lock:
            self._expected.setdefault(path, []).append(_content(("graph", path), _stamp(path)))

    def close(self) -> None:
        """Stop watching."""
        self._wake.ended.set()
        self._thread.join()

    def _is_ours(self, path: Path, content: bytes) -> bool:
        """True if we wrote this. What was expected before that will not come any more."""
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
                self._wait(_LOOK)
                continue
            try:
                self._listen(folders)
            except (OSError, RuntimeError) as fault:
                if folders == self._folders():
                    self.fault = f"the system does not tell when files change ({fault}): they are compared every second"

    def _listen(self, folders: frozenset[tuple[Path, int]]) -> None:
        """Compare whenever something happens in the folders, until others are wanted. Raises OSError, RuntimeError."""
        told = watch(
            *(path for path, _ in folders),
            watch_filter=None,
            recursive=False,
            debounce=100,
            step=20,
            rust_timeout=int(1000 * _LOOK),
            stop_event=self._wake,
            yield_on_timeout=True,
            raise_interrupt=False,
        )
        for _ in told:
            self._settle()
            if self._folders() != folders:
                return

    def _wait(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while not self._wake.is_set() and time.monotonic() < end:
            self._wake.ended.wait(0.05)

    def _folders(self) -> frozenset[tuple[Path, int]]:
        """The folders to listen to, each with its number: one that was made again is another."""
        watched = self._watched
        found = {parent for _, path in watched.files for parent in (path.parent, Path(os.path.realpath(path)).parent)}
        for _, top in watched.folders:
            found |= {Path(folder) for folder, _, _ in os.walk(top)}
        numbers = ((path, _stamp(path)) for path in found)
        return frozenset((path, stamp[2]) for path, stamp in numbers if stamp)

    def _settle(self) -> None:
        """Compare until every file has been at rest."""
        self._compare()
        while not self._wake.is_set() and not all(one.rests for one in self._known.values()):
            self._wait(_REST)
            self._compare()

    def _compare(self) -> None:
        """Note what is not as it was known to be."""
        with self._lock:
            watched, before, listed = self._watched, dict(self._known), self._listed
        inside = {key: folder for folder in watched.folders for key in _inside(folder)}
        gone = [key for key in before if key not in inside and key in _covered(watched, (key,))]
        nothing = _Known(None, b"", 0.0, True)
        # A file that a folder did not have when it was first looked at is news; all others are known from then on.
        old = {key: before.get(key) or (nothing if folder in listed else None) for key, folder in inside.items()}
        old |= {key: before.get(key) for key in (*watched.files, *gone)}
        now = {key: _look(key, one) for key, one in old.items()}
        with self._lock:
            if watched is not self._watched:
                return
            self._known, self._listed = now, frozenset(watched.folders)
            self._news |= {key: one for key, one in now.items() if (was := old[key]) and was.content != one.content}


def pictures_of(graph: Graph, bindings: Mapping[str, object] | None = None) -> tuple[Path, ...]:
    """The image files that a graph reads, groups included; `bindings` fill its inputs in place of their own files."""
    bound = bindings or {}
    found = [Path(split_layer(str(item))[0]) for item in bound.values() if isinstance(item, str | Path)]
    todo = [(graph, frozenset(bound))]
    while todo:
        body, filled = todo.pop()
        found += [Path(body.folder, end.file) for name, end in body.inputs.items() if end.file and name not in filled]
        for id, item in body.nodes.items():
            if isinstance(item, Group):
                linked = (name for name in item.graph.inputs if Port(id, name) in body.links)
                todo.append((item.body(), frozenset(linked)))
            elif isinstance(item, Node):
                named = (str(getattr(item, value.name)) for value in item.values.values() if value.type == "path")
                found += [Path(body.folder, path) for path in named if path]
    return tuple(dict.fromkeys(path.absolute() for path in found))


def groups_of(graph: Graph) -> tuple[Path, ...]:
    """The graph files that groups come from, groups inside groups included."""
    found, todo = dict[Path, None](), [graph]
    while todo:
        body = todo.pop()
        for item in body.nodes.values():
            if isinstance(item, Group):
                todo.append(item.graph)
                if item.path:
                    found[Path(body.folder, item.path).absolute()] = None
    return tuple(found)


def _covered(watched: _Watched, keys: Iterable[_Key]) -> set[_Key]:
    """Those of the keys that are watched, as files or within folders."""
    files, folders = set(watched.files), set(watched.folders)
    return {key for key in keys if key in files or any((key[0], folder) in folders for folder in key[1].parents)}


def _inside(folder: _Key) -> Iterator[_Key]:
    """The files of a folder that count."""
    kind, top = folder
    for path, _, names in os.walk(top):
        yield from _keys(kind, (Path(path, name) for name in names if name.endswith(_ENDINGS[kind])))


def _keys(kind: Kind, paths: Iterable[Path]) -> Iterator[_Key]:
    return ((kind, path) for path in dict.fromkeys(paths))


def _look(key: _Key, before: _Known | None) -> _Known:
    """What is known of a file now. Its content stays what it was before until the file has been at rest."""
    stamp, now = _stamp(key[1]), time.monotonic()
    if before is None:
        return _Known(stamp, _content(key, stamp), now, False)
    if stamp != before.stamp:
        return replace(before, stamp=stamp, seen=now, rests=False)
    if before.rests or now - before.seen < _REST:
        return before
    return _Known(stamp, _content(key, stamp), now, True)


def _stamp(path: Path) -> tuple[int, int, int] | None:
    """Time, size and number of a file; None if there is none."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _content(key: _Key, stamp: tuple[int, int, int] | None) -> bytes:
    """What tells one content from another: of pictures, which are large, the stamp. b"" if there is no file."""
    kind, path = key
    if stamp is None or kind == "picture":
        return repr(stamp).encode() if stamp else b""
    try:
        return blake2b(path.read_bytes(), digest_size=16).digest()
    except OSError:
        return b""
