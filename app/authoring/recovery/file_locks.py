"""Locks between processes. The system takes them back when their holder ends, however it ends."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

_TAKEN = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)


def lock(file: BinaryIO, *, wait: bool = False) -> bool:
    """Lock an open file until it is closed; False if another has it. Where files cannot be locked, True."""
    try:
        if sys.platform == "win32":
            msvcrt.locking(file.fileno(), msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
        else:
            fcntl.flock(file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        return error.errno not in _TAKEN
    return True


def is_held(path: Path) -> bool:
    """True if a process that still runs, this one included, has locked the file."""
    try:
        with path.open("r+b") as file:
            return not lock(file)
    except OSError:
        return False


@contextmanager
def hold_lock(path: Path) -> Iterator[None]:
    """Wait for the file at `path`, made if need be, and hold it. Raises OSError if it cannot be made."""
    with os.fdopen(os.open(path, os.O_RDWR | os.O_CREAT, 0o666), "r+b") as file:
        lock(file, wait=True)
        yield
