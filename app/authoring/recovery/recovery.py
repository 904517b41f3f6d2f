"""Keeps unsaved work through crashes: it is written beside the preferences, never over a document.

Each editor has a file of its own and holds a lock while it runs. A file whose lock is free belongs to an editor that
is gone: numbers of processes are used again, locks are not.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import msgspec
from msgspec import Struct

from ... import document
from ...document.disk import read_text
from ...errors import DocumentError, HalationError, OutputError
from ...graph import Graph
from ...language.translation import translate
from ...resources.atomic_write import find_temporary_files, write_text_atomically
from ...resources.sandbox import UNRESTRICTED, Sandbox
from ...resources.typed_data import decode_data
from ...version import VERSION
from .claims import DocumentClaim
from .file_locks import is_held, lock

FIRST = 1.0
"""Seconds from the first change to the first write: a crash soon after the start loses little."""

USUAL_INTERVAL = 5.0
"""Seconds between writes, half of what may be lost. Chosen by judgement."""

LONGEST = 9.0
"""Seconds between writes at most: with the time that writing takes, what is kept is never older than ten."""


class _Record(msgspec.Struct):
    """The content of a recovery file. `graph` is the document."""

    graph: msgspec.Raw
    path: str = ""
    folder: str = ""
    time: float = 0.0
    version: str = ""
    nodes: int = 0


class RecoveredWork(Struct, frozen=True):
    """Work that an editor left behind at `time`, in seconds since 1970.

    `path` is the file that it belongs to, None if it was never saved; `nodes` counts those outside of groups.
    """

    file: Path
    path: Path | None = None
    folder: str = ""
    time: float = 0.0
    version: str = ""
    nodes: int = 0
    text: str = ""
    fault: str = ""
    """Why it cannot be read, or ""."""

    @property
    def title(self) -> str:
        """The title of the work: the name of its file."""
        return self.path.name if self.path else translate("Untitled")

    def load(self, sandbox: Sandbox) -> Graph:
        """The graph, finding its pictures where the original did. Raises DocumentError."""
        if self.fault:
            raise DocumentError("", "", self.fault)
        return document.loads(self.text, f"recovered {self.title}", self.folder, sandbox=sandbox)

    def discard(self) -> None:
        """Delete the recovered work. Raises OutputError."""
        _remove(self.file)
        _remove(self.file.with_suffix(".lock"))


class RecoveryFile:
    """Keeps the newest unsaved graph of one editor in `folder`/recovery, every `interval` seconds at most."""

    def __init__(self, folder: Path, interval: float = USUAL_INTERVAL) -> None:
        self.folder = folder / "recovery"
        self.interval = min(interval, LONGEST)
        self.fault = ""
        self._file: Path | None = None
        self._claim: DocumentClaim | None = None
        self._noted: tuple[Graph, Path | None] | None = None
        self._changes = self._settled = 0
        self._since = 0.0
        self._adopted: list[RecoveredWork] = []
        self._closing = False
        self._change = threading.Condition()
        self._own = contextlib.ExitStack()
        self._thread = threading.Thread(target=self._run, name="recovery", daemon=True)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            _remove_leftovers(self.folder)
            self._file = self._own.enter_context(_claim_name(self.folder))
            self._claim = DocumentClaim(self._file)
            self._thread.start()
        except OSError as fault:
            self.fault = translate(
                "unsaved work cannot be kept in {folder} ({reason}): save often",
                folder=self.folder,
                reason=fault.strerror,
            )

    def claim(self, path: Path | None) -> None:
        """Say which file this editor edits; other editors then know."""
        if self._claim is not None:
            self._claim.set_path(path)

    def find_rivals(self) -> str:
        """A sentence if another editor has the same file open, else ""."""
        if self._claim is None or not self._claim.is_shared():
            return ""
        return translate(
            "another editor has this document open too: the last one to save overwrites what the other saved"
        )

    def note(self, graph: Graph, path: Path | None, dirty: bool) -> None:
        """Note the current document; costs nothing if nothing changed."""
        if not dirty:
            if self._noted is not None or self._adopted:
                self.clear()
        elif self._noted is None or self._noted[0] is not graph or self._noted[1] != path:
            self._set_noted((graph, path))

    def clear(self) -> None:
        """Forget the noted work: it is saved, or the user discarded it."""
        self._set_noted(None)

    def find_abandoned(self) -> tuple[RecoveredWork, ...]:
        """The unsaved work of editors that no longer run, newest first. Work that its own file holds too is removed."""
        abandoned_files = [file for file in _files(self.folder, "*.json") if not is_held(file.with_suffix(".lock"))]
        abandoned: list[RecoveredWork] = []
        for recovered in map(_read, abandoned_files):
            if _is_saved(recovered):
                with contextlib.suppress(OutputError):
                    recovered.discard()
            elif recovered.file.exists():  # otherwise another editor has adopted it already
                abandoned.append(recovered)
        return tuple(sorted(abandoned, key=lambda recovered: recovered.time, reverse=True))

    def adopt(self, recovered: RecoveredWork, sandbox: Sandbox) -> Graph:
        """The graph of recovered work; its file goes once this editor has written the work. Raises DocumentError."""
        graph = recovered.load(sandbox)
        with self._change:
            self._adopted.append(recovered)
        return graph

    def close(self, keep: bool = False) -> None:
        """End. The file is removed; with `keep` it is brought up to date and stays, to be found the next time."""
        with self._change:
            self._closing = True
            if not keep:
                self.clear()
            self._change.notify()
        if self._thread.is_alive():
            self._thread.join()
        if self._claim is not None:
            self._claim.close()
        with contextlib.suppress(OutputError):
            self._own.close()

    def _set_noted(self, noted: tuple[Graph, Path | None] | None) -> None:
        with self._change:
            if self._changes == self._settled:
                self._since = time.monotonic()
            self._changes += 1
            self._noted = noted
            self._change.notify()

    # --- on the thread of its own ------------------------------------------------------------------------------

    def _run(self) -> None:
        last = -LONGEST
        while True:
            with self._change:
                self._change.wait_for(lambda: self._closing or self._changes != self._settled)
                while not self._closing and (self._noted or self.fault):
                    due = max(self._since + min(FIRST, self.interval), last + self.interval)
                    if (left := due - time.monotonic()) <= 0:
                        break
                    self._change.wait(left)
                noted, number, closing = self._noted, self._changes, self._closing
            if number != self._settled:
                last = time.monotonic()
                self.fault = self._settle(noted)
                with self._change:
                    self._since = time.monotonic()
                    self._settled = self._settled if self.fault else number
            if closing:
                return

    def _settle(self, noted: tuple[Graph, Path | None] | None) -> str:
        """Write what `noted` holds; returns what went wrong, or ""."""
        assert self._file is not None
        with self._change:
            adopted = tuple(self._adopted)
        try:
            if noted is None:
                _remove(self._file)
            else:
                write_text_atomically(self._file, _text(*noted), sandbox=UNRESTRICTED)
            for recovered in adopted:
                recovered.discard()
        except HalationError as fault:
            return translate("unsaved work is not kept: {fault}", fault=fault)
        except Exception as fault:
            return translate(
                "unsaved work is not kept because of a fault in Halation ({kind}: {fault})",
                kind=type(fault).__name__,
                fault=fault,
            )
        with self._change:
            self._adopted = self._adopted[len(adopted) :]
        return ""


def _text(graph: Graph, path: Path | None) -> str:
    record = _Record(
        msgspec.Raw(document.dumps(graph).strip().encode()),
        _plain(path.absolute()) if path else "",
        _plain(Path(graph.folder).absolute()),
        time.time(),
        VERSION,
        len(graph.nodes),
    )
    return msgspec.json.encode(record).decode()


def _plain(path: Path) -> str:
    """A path as text; the work is kept even if the path has bytes that are not UTF-8."""
    return os.fsencode(path).decode(errors="replace")


def _read(file: Path) -> RecoveredWork:
    """The work in a recovery file; a broken one has a `fault`."""
    try:
        record = decode_data(read_text(file, sandbox=UNRESTRICTED), _Record)
    except (DocumentError, msgspec.MsgspecError, UnicodeDecodeError) as fault:
        return RecoveredWork(
            file, fault=translate("{file}: this recovered work cannot be read ({fault})", file=file, fault=fault)
        )
    path = Path(record.path) if record.path else None
    return RecoveredWork(
        file, path, record.folder, record.time, record.version, record.nodes, bytes(record.graph).decode()
    )


def _is_saved(recovered: RecoveredWork) -> bool:
    """True if the work's own file has the same content: the editor ended just after saving."""
    if recovered.path is None or recovered.fault:
        return False
    try:
        return read_text(recovered.path, sandbox=UNRESTRICTED).strip() == recovered.text.strip()
    except DocumentError:
        return False


@contextlib.contextmanager
def _claim_name(folder: Path) -> Iterator[Path]:
    """A new file in the folder, locked for this editor. Raises OSError."""
    while True:
        file = folder / f"{secrets.token_hex(8)}.json"
        with file.with_suffix(".lock").open("xb") as lock_file:
            lock(lock_file, wait=True)
            # Another editor that removes leftovers may have removed it before it was locked.
            if not file.with_suffix(".lock").exists():
                continue
            yield file
        if not file.exists():
            _remove(file.with_suffix(".lock"))
        return


def _remove_leftovers(folder: Path) -> None:
    """Remove unfinished files of editors that have ended."""
    for path in find_temporary_files(folder):
        if not is_held(folder / f"{path.name.rpartition('-')[2].partition('.')[0]}.lock"):
            _remove(path)
    for path in _files(folder, "*.open"):
        if not is_held(path.with_suffix(".lock")):
            _remove(path)
    for path in _files(folder, "*.lock"):
        if not path.with_suffix(".json").exists() and not is_held(path):
            _remove(path)


def _files(folder: Path, pattern: str) -> tuple[Path, ...]:
    try:
        return tuple(folder.glob(pattern))
    except OSError:
        return ()


def _remove(path: Path) -> None:
    """Remove a file. Raises OutputError if it stays."""
    try:
        path.unlink(missing_ok=True)
    except OSError as fault:
        raise OutputError(translate("{path}: cannot be removed ({reason})", path=path, reason=fault.strerror)) from None
