"""Files that are read: where they may lie, which version of one is there, and what it holds byte by byte."""

from __future__ import annotations

import difflib
import hashlib
import os
from pathlib import Path

from ..errors import InputError
from .sandbox import outside


def check_inside(path: str | Path) -> None:
    """Raise InputError for a file that `--root` forbids."""
    if refusal := outside(path):
        raise InputError(f"{_printable(path)}: {refusal}")


def check_file(path: str | Path) -> Path:
    """The file, if there is one that may be read and holds something. Raises InputError."""
    check_inside(path)
    file = Path(path)
    try:
        file.stat()
    except FileNotFoundError:
        pass
    except (OSError, ValueError) as error:
        reason = (
            _describe_missing(file)
            if not isinstance(error, PermissionError)
            else "may not be read: check its permissions"
        )
        raise InputError(f"{_printable(path)}: {reason}") from error
    if file.is_dir():
        raise InputError(f"{path}: is a folder: name a picture inside it")
    if not file.is_file():
        raise InputError(f"{path}: {_describe_missing(file)}")
    if not os.access(file, os.R_OK):
        raise InputError(f"{path}: may not be read: check its permissions")
    if file.stat().st_size == 0:
        raise InputError(f"{path}: is empty (0 bytes): copy or render it again")
    return file


def fingerprint(path: str | Path) -> str:
    """A cheap mark of this version of the file: where it is, when it was written, how long it is. Raises InputError."""
    check_inside(path)
    try:
        status = Path(path).stat()
    except (OSError, ValueError) as error:
        raise InputError(f"{_printable(path)}: {_describe_missing(Path(path))}") from error
    return f"{Path(path).absolute()}:{status.st_mtime_ns}:{status.st_size}"


def content_hash(path: str | Path) -> str:
    """SHA-256 of the bytes of the file, in hexadecimal. Raises InputError."""
    check_inside(path)
    try:
        with Path(path).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError) as error:
        raise InputError(f"{_printable(path)}: cannot be read: {getattr(error, 'strerror', None) or error}") from error


def _printable(path: str | Path) -> str:
    """A path as a sentence can hold it."""
    return str(path).replace("\0", "\\0")


def _describe_missing(path: Path) -> str:
    """What to say of a file that is not there."""
    try:
        if not path.parent.is_dir():
            return "there is no such file; its folder is missing too"
        guess = difflib.get_close_matches(path.name, (item.name for item in path.parent.iterdir()), 1)
    except (OSError, ValueError):
        return "no file can have such a name: check it"
    return f"there is no such file; did you mean '{guess[0]}'?" if guess else "there is no such file: check the name"
