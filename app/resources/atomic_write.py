"""Bytes onto the disk whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

from ..errors import OutputError
from .sandbox import outside

_FAULTS = {
    errno.ENOSPC: "the disk is full: make room or write elsewhere",
    errno.EDQUOT: "your disk quota is used up: make room or write elsewhere",
    errno.EACCES: "the folder may not be written: choose another",
    errno.EPERM: "the folder may not be written: choose another",
    errno.EROFS: "the disk is read-only: choose another",
    errno.ENOENT: "there is no such folder: create it first",
    errno.ENOTDIR: "part of the path is a file, not a folder",
    errno.EFBIG: "the file would be larger than may be written here: make it smaller or write elsewhere",
    errno.ENAMETOOLONG: "the name is too long",
}
_MARGIN = 1 << 20
_PART = ".halation-"
_ABANDONED = 3600.0
"""Seconds after which an unfinished file is nobody's any more; other machines may be writing to the same folder."""


def write_atomically(path: str | Path, encode: Callable[[str], None], room: int) -> None:
    """Replace the file by what `encode` writes to the name it is given; at most about `room` bytes.

    The encoders do not notice a full disk (PNG and WebP report success, JPEG ends the process: OpenImageIO 3.2), so
    they write into memory where the system has such files. A name in the same folder is written, then renamed; on
    any failure it is removed and an older file stays as it was.

    Raises:
        OutputError: the folder is missing or read-only, or the disk is full.
    """
    with replace_file(path) as (part, target):
        _fill(part, encode, room)
        part.replace(target)


def temporary_prefix(process: int) -> str:
    """How the names of unfinished files of a process begin: one that was killed cannot remove them itself."""
    return f"{_PART}{process}-"


def remove_abandoned_files(folder: str | Path) -> None:
    """Remove the unfinished files that processes left in a folder when they were killed."""
    for part in Path(folder).glob(f"{_PART}*"):
        with contextlib.suppress(OSError):
            if time.time() - part.stat().st_mtime > _ABANDONED:
                part.unlink()


def check_writable(path: str | Path) -> None:
    """Find out whether the folder may be written, by making a name in it and taking that away. Raises OutputError."""
    with replace_file(path):
        pass


@contextmanager
def replace_file(path: str | Path) -> Generator[tuple[Path, Path]]:
    """A new file that is gone afterwards, and the one that it may replace. Raises OutputError."""
    if said := outside(path):
        raise OutputError(f"{path}: {said}")
    target = Path(os.path.realpath(path))
    part = target.with_name(f"{temporary_prefix(os.getpid())}{os.urandom(6).hex()}{target.suffix[:8]}")
    try:
        if target.is_dir():
            raise OutputError(f"{path}: is a folder: add the name of a file")
        try:
            part.open("xb").close()
            yield part, target
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {describe_write_error(error)}") from error


def describe_write_error(error: Exception) -> str:
    """Why something cannot be written, as the rest of a sentence."""
    said = getattr(error, "strerror", None) or str(error) or "the encoder gave no reason"
    return _FAULTS.get(getattr(error, "errno", None) or 0, said)


def _fill(part: Path, encode: Callable[[str], None], room: int) -> None:
    if hasattr(os, "memfd_create") and Path("/proc/self/fd").is_dir():
        memory = os.memfd_create("halation")
        with open(memory, "rb") as source, part.open("r+b") as sink:  # noqa: PTH123 - a descriptor, not a path
            encode(f"/proc/self/fd/{memory}")
            size = _check_filled(memory)
            if _reserved(sink.fileno(), size):
                done = 0
                while done < size:
                    done += os.sendfile(sink.fileno(), memory, done, size - done)
            else:
                shutil.copyfileobj(source, sink, 1 << 20)
                sink.flush()
                os.fsync(sink.fileno())
        return
    if shutil.disk_usage(part.parent).free < room + _MARGIN:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    encode(str(part))
    with part.open("r+b") as sink:
        os.fsync(sink.fileno())
        _check_filled(sink.fileno())


def _reserved(descriptor: int, size: int) -> bool:
    """Take the room on the disk: a full one is found out now and not after the rename. False where that is unknown.

    Then the file has to be synced, which finds it out as well, and takes as long as the disk does.
    """
    try:
        os.posix_fallocate(descriptor, 0, size)
    except OSError as error:
        if error.errno in (errno.ENODEV, errno.EINVAL, errno.EOPNOTSUPP):
            return False
        raise
    return True


def _check_filled(descriptor: int) -> int:
    """The size of a file. An encoder that wrote nothing had no room."""
    size = os.fstat(descriptor).st_size
    if size == 0:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    return size
