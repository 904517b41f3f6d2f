"""Files that are read: whether they may be, which version of one is there, and what it holds byte by byte.

Everything that a graph or a command names is opened by `open_file`, or found by `check_file` for a library that opens
files itself. Both refuse what is no regular file: a FIFO or a device would be waited for without end.
"""

from __future__ import annotations

import difflib
import errno
import hashlib
import os
import re
import stat
from collections.abc import Collection
from io import BufferedReader
from pathlib import Path, PurePath

from ..errors import InputError
from .sandbox import Sandbox, make_path_printable
from .suggestions import find_near_names, may_compare

_OPEN_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)
"""Windows has only the last of them, and needs it."""


def open_file(path: str | Path, sandbox: Sandbox) -> BufferedReader:
    """Open a regular file for reading.

    What is none is refused before it is opened, which may block or change it, and again once it is open, as it may
    have been exchanged meanwhile.

    Raises:
        InputError: the sandbox forbids it, or it is no regular file.
        OSError, ValueError: the system cannot open it.
    """
    sandbox.check(path)
    _check_regular(path, Path(path).stat())
    descriptor = os.open(Path(path), _OPEN_FLAGS)
    try:
        _check_regular(path, os.fstat(descriptor))
        return os.fdopen(descriptor, "rb")
    except BaseException:
        os.close(descriptor)
        raise


def find_special_kind(mode: int) -> str:
    """What a file is that is neither regular nor a folder, such as "a FIFO", by the mode of its status; else ""."""
    kinds = (
        (stat.S_ISFIFO, "a FIFO"),
        (stat.S_ISSOCK, "a socket"),
        (stat.S_ISCHR, "a device"),
        (stat.S_ISBLK, "a device"),
    )
    if stat.S_ISREG(mode) or stat.S_ISDIR(mode):
        return ""
    return next((kind for is_kind, kind in kinds if is_kind(mode)), "no regular file")


def check_file(path: str | Path, sandbox: Sandbox) -> Path:
    """The file, if there is one that may be read and holds something. Raises InputError."""
    sandbox.check(path)
    file = Path(path)
    try:
        status = file.stat()
    except FileNotFoundError:
        raise InputError(f"{path}: {_describe_missing(file)}") from None
    except (OSError, ValueError) as error:
        reason = (
            _describe_missing(file)
            if not isinstance(error, PermissionError)
            else "may not be read: check its permissions"
        )
        raise InputError(f"{make_path_printable(path)}: {reason}") from error
    if stat.S_ISDIR(status.st_mode):
        raise InputError(f"{path}: is a folder: name a picture inside it")
    _check_regular(path, status)
    if not os.access(file, os.R_OK):
        raise InputError(f"{path}: may not be read: check its permissions")
    if status.st_size == 0:
        raise InputError(f"{path}: is empty (0 bytes): copy or render it again")
    return file


def fingerprint(path: str | Path, sandbox: Sandbox) -> str:
    """A cheap mark of this version of the file: where it is, when it was written, how long it is. Raises InputError."""
    sandbox.check(path)
    try:
        status = Path(path).stat()
    except (OSError, ValueError) as error:
        raise InputError(f"{make_path_printable(path)}: {_describe_missing(Path(path))}") from error
    _check_regular(path, status)
    return f"{Path(path).absolute()}:{status.st_mtime_ns}:{status.st_size}"


def content_hash(path: str | Path, sandbox: Sandbox) -> str:
    """SHA-256 of the bytes of the file, in hexadecimal. Raises InputError."""
    try:
        with open_file(path, sandbox) as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{make_path_printable(path)}: cannot be read: {reason}") from error


def read_bytes(path: str | Path, sandbox: Sandbox, count: int = -1) -> bytes:
    """All of a file, or its first `count` bytes. Raises InputError."""
    try:
        with open_file(path, sandbox) as file:
            return file.read(count)
    except FileNotFoundError:
        raise InputError(f"{make_path_printable(path)}: {_describe_missing(Path(path))}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{make_path_printable(path)}: cannot be read: {reason}") from error


def _check_regular(path: str | Path, status: os.stat_result) -> None:
    if kind := find_special_kind(status.st_mode):
        raise InputError(f"{make_path_printable(path)}: is {kind}, not a file: name a regular file")
    if stat.S_ISDIR(status.st_mode):  # Linux opens one for reading, and Python would name its descriptor
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))


def _describe_missing(path: Path) -> str:
    """What to say of a file that is not there."""
    try:
        if not path.parent.is_dir():
            return "there is no such file; its folder is missing too"
        names = os.listdir(path.parent) if may_compare() else ()  # noqa: PTH208 - of many files, names are enough
        numbered = _list_numbered(path.name, names)
        guess = find_similar_name(path.name, names)
    except (OSError, ValueError):
        return "no file can have such a name: check it"
    if numbered:
        others = f"{numbered[0]} to {numbered[-1]}" if len(numbered) > 1 else numbered[0]
        return f"there is no such file, only {others}"
    return f"there is no such file; did you mean '{guess}'?" if guess else "there is no such file: check the name"


def _list_numbered(name: str, names: Collection[str]) -> list[str]:
    """The names that differ from one in their numbers alone, such as other frames of a sequence, in order."""
    shape = _split_numbers(name)[::2]
    alike = (item for item in names if _split_numbers(item)[::2] == shape) if len(shape) > 1 else ()
    return sorted(alike, key=lambda item: [int(digits) for digits in _split_numbers(item)[1::2]])


def _split_numbers(name: str) -> list[str]:
    """Texts and numbers of a name in turn, the texts without regard to capitals."""
    return re.split(r"([0-9]+)", name.casefold())


def find_similar_name(name: str, names: Collection[str]) -> str:
    """The most similar of the names of files, for a suggestion; "" if none is similar.

    What stands before the first dot must be near (`find_near_names`), in capitals or not: all names of a folder of
    pictures may end alike, and then `nope.exr` looks like each of them. The endings must be of one kind: `shot.log` is
    no suggestion for `shot.exr`. Of many faults only the first get suggestions (`limit_suggestions`).
    """
    if not may_compare(len(names)):
        return ""
    names_by_stem: dict[str, list[str]] = {}
    ending = _find_ending(name)
    for candidate in names:
        if not _may_stand_for(_find_ending(candidate), ending):
            continue
        names_by_stem.setdefault(_find_stem(candidate), []).append(candidate)
    stems = find_near_names(_find_stem(name), names_by_stem)
    return difflib.get_close_matches(name, names_by_stem[stems[0]], 1, 0.0)[0] if stems else ""


def _find_stem(name: str) -> str:
    return name.partition(".")[0].casefold()


def _find_ending(name: str) -> str:
    return PurePath(name).suffix.casefold()


def _may_stand_for(ending: str, sought: str) -> bool:
    """True if a file with one ending may be what was meant by a name with another."""
    if ending == sought or not sought:
        return True
    kind = next((kind for kind in _KINDS if sought in kind), None)
    return ending in kind if kind else bool(difflib.get_close_matches(ending, [sought], 1))


_KINDS = tuple(
    frozenset(f".{ending}" for ending in endings.split())
    for endings in (
        "bmp cin dpx exr gif hdr heic jp2 jpeg jpg jxl pfm png ppm psd sgi tga tif tiff tx webp avi mkv mov mp4 webm",
        "json",
        "glsl frag fs vs",
        "glb gltf obj ply stl",
        "3dl clf csp cube spi1d spi3d vf ocio ocioz",
    )
)
"""Endings of files that can take each other's place: pictures and video, graphs, shaders, meshes, color tables."""
