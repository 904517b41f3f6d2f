"""Files of text: read with a limit, written whole or not at all."""

from __future__ import annotations

import contextlib
import glob
import os
import stat
import time
from pathlib import Path

from ..errors import DocumentError, OutputError
from ..resources.sandbox import outside
from .limits import MAX_BYTES, size_fault

STALE = 60.0
"""Seconds after which what a process began to write and never finished is nobody's any more."""


def read_text(path: Path) -> str:
    """The text of a graph file. Raises DocumentError; a file that is too large is not read."""
    if said := outside(path):
        raise DocumentError(str(path), "", said, rule="unreadable-graph")
    try:
        with path.open("rb") as file:
            if fault := size_fault(max(os.fstat(file.fileno()).st_size, 1)):
                raise DocumentError(str(path), "", fault, rule="unreadable-graph")
            found = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise DocumentError(str(path), "", "there is no such file", rule="unreadable-graph") from None
    except IsADirectoryError:
        raise DocumentError(str(path), "", "this is a folder, not a graph file", rule="unreadable-graph") from None
    except (OSError, ValueError) as error:
        raise DocumentError(str(path), "", f"it cannot be read ({_reason(error)})", rule="unreadable-graph") from None
    try:
        return found.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        fault = f"the text is not UTF-8 (byte {error.start}); save it as UTF-8"
        raise DocumentError(str(path), "", fault, rule="unreadable-graph") from None


def write_text(path: Path, text: str) -> None:
    """Replace `path` by `text`: after any failure the old file is still there. Raises OutputError."""
    if said := outside(path):
        raise OutputError(f"{path}: {said}")
    try:
        # A link to a file stays a link: what it points at is replaced.
        target = path.resolve()
        if target.exists() and not target.stat().st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
            raise OutputError(f"{path}: the file is read-only; save under another name, or make it writable")
        begun = f".{target.name[:100]}."
        temporary = target.with_name(f"{begun}{os.urandom(4).hex()}.tmp")
        handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    except (OSError, ValueError, RuntimeError) as error:
        raise OutputError(f"{path}: it cannot be saved here ({_reason(error)}); choose another folder") from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(text.encode())
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            temporary.chmod(target.stat().st_mode & 0o777)
        os.replace(temporary, target)  # noqa: PTH105
    except BaseException as error:
        with contextlib.suppress(OSError):
            temporary.unlink()
        if isinstance(error, OSError):
            kept = "; the old file is unchanged" if target.exists() else ""
            raise OutputError(f"{path}: it could not be saved ({_reason(error)}){kept}") from None
        raise
    _sync_folder(target.parent)
    _tidy(target.parent, begun)


def _tidy(folder: Path, begun: str) -> None:
    """Remove what processes that were killed have left of the same file."""
    with contextlib.suppress(OSError):
        for left in folder.glob(f"{glob.escape(begun)}{'[0-9a-f]' * 8}.tmp"):
            if time.time() - left.stat().st_mtime > STALE:
                left.unlink()


def _sync_folder(folder: Path) -> None:
    """Make the new name last too; not every system can."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _reason(error: Exception) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)
