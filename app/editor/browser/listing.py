"""The content of a folder: read in a thread, sorted and filtered."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Collection, Sequence
from pathlib import Path
from threading import Thread
from typing import Literal

from msgspec import Struct

from ...errors import InputError
from ...language.translation import translate
from ..shared.fuzzy import match

Order = Literal["name", "size", "time"]


class Item(Struct, frozen=True):
    """A file or a folder; `size` in bytes, `time` of the last change in seconds since 1970."""

    name: str
    is_folder: bool
    size: int
    time: float
    hidden: bool


def read_folder(folder: Path) -> tuple[Item, ...]:
    """All items of a folder; unreadable ones are left out. Raises InputError if the folder cannot be read."""
    try:
        with os.scandir(folder) as entries:
            items = [_item(entry) for entry in entries]
    except OSError as error:
        raise InputError(f"{folder}: {_reason(error)}") from None
    return tuple(item for item in items if item)


def arrange_items(
    items: Sequence[Item],
    endings: Collection[str],
    *,
    query: str = "",
    order: Order = "name",
    down: bool = False,
    hidden: bool = False,
    start: str = "",
) -> tuple[Item, ...]:
    """Sorted items: folders first, then files whose name ends in one of `endings` (none: all).

    With a `query` the best matches come first instead; with a `start` only names count that begin like it.
    """
    listed = [
        item
        for item in items
        if (hidden or not item.hidden)
        and (item.is_folder or not endings or extension_of(item.name) in endings)
        and item.name.lower().startswith(start.lower())
    ]
    keys = {
        "name": lambda item: _natural(item.name),
        "size": lambda item: (item.size, _natural(item.name)),
        "time": lambda item: (item.time, _natural(item.name)),
    }
    listed.sort(key=keys[order], reverse=down)
    listed.sort(key=lambda item: not item.is_folder)
    if not query:
        return tuple(listed)
    return tuple(listed[found_match.index] for found_match in match(query, tuple(item.name for item in listed)))


class Listing:
    """The folder that is shown; reading it never blocks. `fault` is a sentence if it cannot be read."""

    def __init__(self) -> None:
        self.folder = Path()
        self.items: tuple[Item, ...] = ()
        self.fault = ""
        self._reader: _FolderReader | None = None
        self._arguments: tuple[object, ...] = ()
        self._shown: tuple[Item, ...] = ()

    def arrange(
        self, endings: frozenset[str], query: str, order: Order, down: bool, hidden: bool, start: str = ""
    ) -> tuple[Item, ...]:
        """The items, sorted and filtered; cached while nothing changes."""
        arguments = (endings, query, order, down, hidden, start)
        if not self._arguments or self._arguments[0] is not self.items or self._arguments[1:] != arguments:
            self._shown = arrange_items(
                self.items, endings, query=query, order=order, down=down, hidden=hidden, start=start
            )
            self._arguments = (self.items, *arguments)
        return self._shown

    @property
    def busy(self) -> bool:
        """True until the folder has been read."""
        return self._reader is not None

    def show(self, folder: Path) -> None:
        """Read a folder; the list is empty meanwhile, unless it is the same one again."""
        if folder != self.folder:
            self.items = ()
        self.folder, self.fault = folder, ""
        self._reader = _FolderReader(folder)
        self._reader.start()

    def poll(self) -> bool:
        """Take over items that were read; True if there are new ones."""
        if self._reader is None or self._reader.is_alive():
            return False
        self.items, self.fault, self._reader = self._reader.items, self._reader.fault, None
        return True

    def wait(self) -> None:
        """Block until the folder has been read."""
        if self._reader is not None:
            self._reader.join()
        self.poll()


class _FolderReader(Thread):
    """Reads one folder in a thread; the window does not wait for it, however slow the disk is."""

    def __init__(self, folder: Path) -> None:
        super().__init__(name="folder", daemon=True)
        self.items: tuple[Item, ...] = ()
        self.fault = ""
        self._folder = folder

    def run(self) -> None:
        try:
            self.items = read_folder(self._folder)
        except InputError as fault:
            self.fault = str(fault)


def make_folder(parent: Path, name: str) -> Path:
    """Create a folder. Raises InputError."""
    name = name.strip()
    if not name or name in (".", "..") or set(name) & set('/\\:*?"<>|'):
        raise InputError(
            translate("'{name}' is not a valid name for a folder: use letters, digits and spaces", name=name)
        )
    try:
        (parent / name).mkdir()
    except OSError as error:
        raise InputError(f"{parent / name}: {_reason(error)}") from None
    return parent / name


def _item(entry: os.DirEntry[str]) -> Item | None:
    try:
        status = entry.stat()
    except OSError:
        return None
    marked = getattr(status, "st_file_attributes", 0) & getattr(stat, "FILE_ATTRIBUTE_HIDDEN", 0)
    hidden = entry.name.startswith(".") or bool(marked)
    return Item(entry.name, stat.S_ISDIR(status.st_mode), status.st_size, status.st_mtime, hidden)


def extension_of(name: str) -> str:
    """The ending of a file's name in lower case, with its dot."""
    return os.path.splitext(name)[1].lower()  # noqa: PTH122 - ten thousand times, so without a Path each


def _natural(name: str) -> tuple[tuple[bool, int, str], ...]:
    """A sort key in which numbers count as numbers: frame 2 before frame 10."""
    parts = re.split(r"(\d+)", name.casefold())
    return tuple((part.isdecimal(), int(part) if part.isdecimal() else 0, part) for part in parts)


def _reason(error: OSError) -> str:
    sentences = {
        PermissionError: translate("permission denied: ask its owner, or choose another folder"),
        FileNotFoundError: translate("there is no such folder"),
        NotADirectoryError: translate("this is a file, not a folder"),
        FileExistsError: translate("a file or folder of this name already exists: choose another name"),
    }
    return next(
        (sentence for kind, sentence in sentences.items() if isinstance(error, kind)), error.strerror or str(error)
    )
