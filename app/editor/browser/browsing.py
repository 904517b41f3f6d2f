"""The state of the file browser: its folder, the chosen item, the resulting file. Draws nothing."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from time import localtime, strftime
from types import MappingProxyType
from typing import TYPE_CHECKING

from msgspec import Struct, field

from ...color.gpu_programs import list_table_endings
from ...graph.frames import VIDEO_ENDINGS
from ...media.lettering import FONT_ENDINGS
from ...media.meshes.load import MESH_ENDINGS
from ...media.pictures.file_endings import list_readable_endings
from ...resources.user_folders import first_folder
from ..shared.dialogs import Browse
from .listing import Item, Listing, Order
from .places import Place, complete_path, is_path, last_name, names_folder, places, split_path

if TYPE_CHECKING:
    from .context import BrowserContext


class Browsing(Struct):
    """The state of one open request for a file."""

    browse: Browse
    folder: Path
    endings: frozenset[str]
    offered: tuple[Place, ...]
    name: str = ""
    query: str = ""
    order: Order = "name"
    down: bool = False
    hidden: bool = False
    chosen: int = -1
    """The index of the chosen item in `items`; -1 for none, as while a new name is typed."""
    listing: Listing = field(default_factory=Listing)
    _back: str = ""

    def go(self, folder: Path) -> None:
        """Show another folder; the folder that was left is chosen if it is in there."""
        self._back = self.folder.name if self.folder.parent == folder else ""
        self.folder, self.query, self.chosen = folder, "", self.first
        self.listing.show(folder)
        if is_path(self.name):
            self.name = Path(self.browse.name).name

    def up(self) -> None:
        """Show the parent folder."""
        self.go(self.folder.parent)

    def poll(self) -> None:
        """Take over files that were read in the meantime."""
        if self.listing.poll() and self._back:
            names = [item.name for item in self.items]
            self.chosen = names.index(self._back) if self._back in names else self.first
            self._back = ""
        self.chosen = min(max(self.chosen, self.first), max(len(self.items) - 1, 0))

    @property
    def first(self) -> int:
        """The index that is chosen at first: none while saving, so that Enter takes the typed name."""
        return -1 if self.browse.saving else 0

    @property
    def items(self) -> tuple[Item, ...]:
        """The items that are listed: of a path that is being typed those of its folder that begin like its last name,
        as Tab would complete it.
        """
        if self.browse.saving or not is_path(self.query):
            return self.listing.arrange(self.endings, self.query, self.order, self.down, self.hidden)
        stem = last_name(self.query)
        hidden = self.hidden or stem.startswith(".")
        return self.listing.arrange(self.endings, "", self.order, self.down, hidden, stem)

    @property
    def item(self) -> Item | None:
        """The chosen item."""
        items = self.items
        return items[self.chosen] if 0 <= self.chosen < len(items) else None

    def search(self, query: str) -> None:
        """Filter by name; the best match is chosen."""
        self.query, self.chosen = query, self.first
        self._list_typed_folder(query)

    def rename(self, name: str) -> None:
        """Save under another name or path, as typed."""
        self.name, self.chosen = name, -1
        self._list_typed_folder(name)

    def _list_typed_folder(self, text: str) -> None:
        """List the folder of a path that is being typed; of a name, that of the dialog."""
        folder = self.folder
        if is_path(text):
            folder = complete_path(split_path(text)[0], self.folder)
        if folder != self.listing.folder:
            self.listing.show(folder)

    def choose(self, index: int) -> None:
        """Choose an item; while saving, a file gives its name."""
        self.chosen = index
        item = self.item
        if self.browse.saving and item and not item.is_folder:
            here = self.listing.folder
            self.name = item.name if here == self.folder else str(here / item.name)

    @property
    def target(self) -> Path | None:
        """The file that the dialog would return now, with the requested ending.

        While a file is saved, the user may type a path instead of a name; a path that ends with a folder is no answer.
        """
        if not self.browse.saving:
            return self.listing.folder / self.item.name if self.item and not self.item.is_folder else None
        if names_folder(self.name):
            return None
        path = complete_path(self.name, self.folder)
        return path if path.suffix else path.with_name(path.name + (Path(self.browse.name).suffix or ".json"))

    @property
    def typed_folder(self) -> Path | None:
        """The folder whose path is in the name field, which Enter shows; None for anything else."""
        text = self.name if self.browse.saving else self.query
        if not text.strip() or not (self.browse.saving or is_path(text)):
            return None
        path = complete_path(text, self.folder)
        return path if names_folder(text) or os.path.isdir(path) else None  # noqa: PTH112 - False for an invalid path

    @property
    def typed_file(self) -> Path | None:
        """The existing file whose path, not only its name, stands in the field of a dialog that opens files."""
        if self.browse.saving or not is_path(self.query):
            return None
        path = complete_path(self.query, self.folder)
        return path if os.path.isfile(path) else None  # noqa: PTH113 - False for an invalid path


FolderMemory = dict[tuple[Path | None, str], Path]
"""The folder that was used last, by the folder of the document and the purpose."""

_NO_MEMORY: Mapping[tuple[Path | None, str], Path] = MappingProxyType({})


def begin_browsing(
    context: BrowserContext, browse: Browse, memory: Mapping[tuple[Path | None, str], Path] = _NO_MEMORY
) -> Browsing:
    """Start where a file was chosen last for this beside the same document, else where the document is.

    A document without a file has the folder that was used last for this purpose, then that of the newest recent file;
    only the first one of all begins where the editor was started.
    """
    own, recent_files = find_own_folder(context), context.store.current.recent
    newest = Path(recent_files[0].path).parent if recent_files else first_folder()
    untitled = Path(context.store.folder(browse.purpose) or newest)
    start = memory.get((own, browse.purpose)) or own or untitled
    start = start if os.path.isdir(start) else first_folder()  # noqa: PTH112 - False for an invalid path
    recent = tuple(dict.fromkeys(Path(recent_file.path).parent for recent_file in context.store.current.recent))[:4]
    used = tuple(Path(folder) for folder in context.store.current.folders.values())
    browsing = Browsing(browse, start, endings(browse), places(own, recent, used), browse.name)
    browsing.listing.show(start)
    return browsing


def find_own_folder(context: BrowserContext) -> Path | None:
    """The folder of the document; None if it has no file yet."""
    return context.session.path.absolute().parent if context.session.path else None


def endings(browse: Browse) -> frozenset[str]:
    """The endings of the files that are listed."""
    if browse.purpose == "image" or browse.has_pictures:
        pictures = list_readable_endings() | VIDEO_ENDINGS
        return pictures | {".json"} if browse.has_pictures else pictures
    if browse.purpose == "table":
        return list_table_endings()
    if browse.purpose == "scene":
        return MESH_ENDINGS
    if browse.purpose == "font":
        return FONT_ENDINGS
    if browse.purpose == "config":
        return frozenset({".ocio", ".ocioz"})
    return frozenset({".json" if browse.purpose == "graph" else Path(browse.name).suffix.lower() or ".exr"})


def size_text(size: int) -> str:
    """A size in bytes as text: `4.71 MB`."""
    if size < 1000:
        return f"{size} B"
    value, unit = float(size), 0
    while value >= 999.5:
        value, unit = value / 1000, unit + 1
    return f"{value:.3g} {('kB', 'MB', 'GB', 'TB', 'PB')[unit - 1]}"


def time_text(time: float) -> str:
    """The time of the last change of a file, as text."""
    return strftime("%Y-%m-%d %H:%M", localtime(time))
