"""Files that are replaced whole or not at all: the one way in which anything is written.

The new bytes go into a temporary file in the same folder, which then takes the name of the file. A rename is atomic, so
who reads sees the old file or the new one, never half of one. After any failure the temporary file is removed and the
old file is as it was. A link stays a link: the file that it points at is replaced. Permissions stay too.

- `write_text_atomically` is for documents, which are a user's work: they are on the disk before their name changes.
- `write_atomically` is for pictures: an encoder writes to a name, by default one in memory.
- `replace_file` is for videos and large pictures, which are written for minutes.

A process that is killed leaves its temporary files behind. Their names say so (`.halation-<process>-...`), and those
that nobody writes to any more are removed by whoever writes to the folder later.
"""

from __future__ import annotations

import contextlib
import errno
import glob
import os
import stat
import time
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager
from pathlib import Path

from ..errors import OutputError
from .input_files import find_special_kind
from .interrupts import delay_interrupts
from .sandbox import Sandbox

_REASONS = {
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
"""Bytes that must stay free besides a file, for its header and what the file system notes about it."""

_BLOCK = 1 << 20
"""Bytes that are copied at a time."""

_PREFIX = ".halation-"
_SUFFIX = ".tmp"
_ABANDONED_AFTER = 3600.0
"""Seconds without a change after which a temporary file is abandoned: no encoder pauses for so long."""

_TEXT_ABANDONED_AFTER = 60.0
"""The same for texts, which are written in one go."""

_LONGEST_NAME = 100
"""Characters of a file's name that its temporary file repeats: names may have 255 bytes."""


class Replacement:
    """A temporary file that is to take the place of `target`, which may not be there yet."""

    def __init__(self, path: str | Path, temporary: Path, target: Path) -> None:
        self.path, self.temporary, self.target = path, temporary, target

    def commit(self, *, durable: bool = True) -> None:
        """Give the temporary file the name and the permissions of the target. Raises OSError.

        A `durable` one survives a power failure: bytes and name are on the disk when this returns.
        """
        if durable:
            with self.temporary.open("r+b") as file:
                os.fsync(file.fileno())
        if self.target.exists():
            self.temporary.chmod(stat.S_IMODE(self.target.stat().st_mode) & 0o777)
        self.temporary.replace(self.target)
        if durable:
            _sync_folder(self.target.parent)

    def explain(self, error: Exception) -> OutputError:
        """The error that says why the file cannot be written."""
        unchanged = "; the old file is unchanged" if self.target.is_file() else ""
        return OutputError(f"{self.path}: cannot be written: {describe_write_error(error)}{unchanged}")


@contextmanager
def replace_file(path: str | Path, sandbox: Sandbox, suffix: str = _SUFFIX) -> Generator[Replacement]:
    """Make an empty temporary file beside `path`, which is removed unless it is committed. Raises OutputError.

    `suffix` is how its name ends, for encoders that tell the format by it.
    """
    try:
        check_replaceable(path, sandbox)
        target = Path(os.path.realpath(path))
    except ValueError as error:
        raise OutputError(f"{path!s:.200}: cannot be written: no file can have such a name") from error
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {describe_write_error(error)}") from error
    unique = f"{temporary_prefix(os.getpid())}{os.urandom(6).hex()}"
    replacement = Replacement(path, target.with_name(f"{unique}-{target.name[:_LONGEST_NAME]}{suffix}"), target)
    try:
        # A file is there before Python knows that it is; an interrupt in between would leave it there.
        with delay_interrupts():
            replacement.temporary.open("xb").close()
        yield replacement
    except OSError as error:
        raise replacement.explain(error) from error
    finally:
        with delay_interrupts(), contextlib.suppress(OSError):
            replacement.temporary.unlink(missing_ok=True)


def check_replaceable(path: str | Path, sandbox: Sandbox) -> None:
    """Refuse what a file may not replace: a folder, a FIFO, a device or a socket, also behind a link.

    Raises:
        OutputError: it is one of these, or the sandbox forbids the path.
        OSError, ValueError: the system cannot tell.
    """
    if reason := sandbox.find_write_fault(path):
        raise OutputError(f"{path}: {reason}")
    try:
        mode = Path(path).stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return
    if stat.S_ISDIR(mode):
        raise OutputError(f"{path}: is a folder: add the name of a file")
    if kind := find_special_kind(mode):
        raise OutputError(f"{path}: is {kind}, which is not replaced: write to a regular file")


def write_text_atomically(path: str | Path, text: str, sandbox: Sandbox) -> None:
    """Replace a file by a text in UTF-8. Raises OutputError, also for a file that is read-only."""
    write_bytes_atomically(path, text.encode(), sandbox)


def write_bytes_atomically(path: str | Path, content: bytes, sandbox: Sandbox) -> None:
    """Replace a file by some bytes. Raises OutputError, also for a file that is read-only."""
    with replace_file(path, sandbox) as replacement:
        target = replacement.target
        if target.exists() and not target.stat().st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
            raise OutputError(f"{path}: the file is read-only: save under another name, or make it writable")
        replacement.temporary.write_bytes(content)
        replacement.commit()
    remove_abandoned_files(target.parent, target.name)


def write_atomically(path: str | Path, encode: Callable[[str], None], size: int, sandbox: Sandbox) -> None:
    """Replace a file by what `encode` writes to the name that it is given: about `size` bytes at most.

    Encoders do not notice a full disk (OpenImageIO 3.2: PNG and WebP report success, JPEG ends the process), so they
    write into memory where the system has such files. The file is not synced: a folder of frames would take as long
    as the disk does, and rendering gives them again.

    Raises:
        OutputError: the folder is missing or read-only, or the disk is full.
    """
    with replace_file(path, sandbox) as replacement:
        if hasattr(os, "memfd_create") and Path("/proc/self/fd").is_dir():
            _encode_in_memory(replacement.temporary, encode)
        else:
            _encode_on_disk(replacement.temporary, encode, size)
        replacement.commit(durable=False)


def check_writable(path: str | Path, sandbox: Sandbox) -> None:
    """Find out whether a file can be made here, by making a temporary one. Raises OutputError."""
    with delay_interrupts(), replace_file(path, sandbox):
        pass


def temporary_prefix(process: int) -> str:
    """How the names of the temporary files of a process begin: one that is killed cannot remove them itself."""
    return f"{_PREFIX}{process}-"


def find_temporary_files(folder: str | Path, name: str = "") -> tuple[Path, ...]:
    """The temporary files in a folder, or only those that were to become the file of that name."""
    ending = f"-{glob.escape(name[:_LONGEST_NAME])}{_SUFFIX}" if name else ""
    try:
        return tuple(Path(folder).glob(f"{_PREFIX}*{ending}"))
    except OSError:
        return ()


def remove_files_of(processes: Iterable[int], paths: Iterable[str | Path]) -> None:
    """Remove what killed processes have begun to write beside these paths."""
    numbers = tuple(processes)
    for folder in {Path(os.path.realpath(path)).parent for path in paths}:
        for number in numbers:
            for part in folder.glob(f"{temporary_prefix(number)}*"):
                with contextlib.suppress(OSError):
                    part.unlink()


def remove_abandoned_files(folder: str | Path, name: str = "") -> None:
    """Remove temporary files that processes left in a folder when they were killed; with a `name` those of that text.

    Age decides and not whether the process is alive: other machines may write to the same folder.
    """
    limit = _TEXT_ABANDONED_AFTER if name else _ABANDONED_AFTER
    for file in find_temporary_files(folder, name):
        with contextlib.suppress(OSError):
            if time.time() - file.stat().st_mtime > limit:
                file.unlink()


def describe_write_error(error: Exception) -> str:
    """Why something cannot be written, as the rest of a sentence."""
    message = getattr(error, "strerror", None) or str(error) or "the encoder gave no reason"
    return _REASONS.get(getattr(error, "errno", None) or 0, message)


def _encode_in_memory(file: Path, encode: Callable[[str], None]) -> None:
    """Encode to a file in memory, and copy that to the disk."""
    import shutil  # slow to import, and most commands write no picture

    memory = os.memfd_create("halation")
    with open(memory, "rb") as source, file.open("r+b") as sink:  # noqa: PTH123 - a descriptor, not a path
        encode(f"/proc/self/fd/{memory}")
        size = _check_not_empty(memory)
        if _reserve_space(sink.fileno(), size):
            copied = 0
            while copied < size:
                copied += os.sendfile(sink.fileno(), memory, copied, size - copied)
        else:
            shutil.copyfileobj(source, sink, _BLOCK)
            sink.flush()
            os.fsync(sink.fileno())


def _encode_on_disk(file: Path, encode: Callable[[str], None], size: int) -> None:
    import shutil

    if shutil.disk_usage(file.parent).free < size + _MARGIN:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    encode(str(file))
    with file.open("r+b") as sink:
        os.fsync(sink.fileno())
        _check_not_empty(sink.fileno())


def _reserve_space(descriptor: int, size: int) -> bool:
    """Reserve the space on the disk, which finds out a full one before the rename. False where that is not possible.

    Then the file has to be synced, which finds it out as well, and takes as long as the disk does.
    """
    try:
        os.posix_fallocate(descriptor, 0, size)
    except OSError as error:
        if error.errno in (errno.ENODEV, errno.EINVAL, errno.EOPNOTSUPP):
            return False
        raise
    return True


def _check_not_empty(descriptor: int) -> int:
    """The size of a file. An encoder that wrote nothing had no space."""
    size = os.fstat(descriptor).st_size
    if size == 0:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    return size


def _sync_folder(folder: Path) -> None:
    """Make a new name in a folder last; not every system can."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
