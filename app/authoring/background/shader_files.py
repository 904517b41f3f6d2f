"""Finds the ISF shaders (Interactive Shader Format) in folders of this machine, in a thread."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from msgspec import Struct, field

from ...custom_nodes import CodeFault
from ...custom_nodes.isf.header import read_header
from ...document.disk import read_text
from ...errors import DocumentError
from ...resources.sandbox import UNRESTRICTED
from .cache import BackgroundCache

CUSTOMARY = ("/Library/Graphics/ISF", "~/Library/Graphics/ISF", "/ProgramData/ISF")
"""The folders of ISF shaders that programs on macOS share."""

MOST = 5000
"""The most files of one folder that are read: a choice, so that a huge folder does not take minutes."""

_Key = tuple[tuple[str, int], ...]


class ShaderFile(Struct, frozen=True):
    """One shader; `takes` is True if it works on a picture, else it makes one out of nothing."""

    path: Path
    category: str
    doc: str
    has_image_input: bool


def _make_cache() -> BackgroundCache[_Key, tuple[ShaderFile, ...]]:
    return BackgroundCache("shaders", _scan_folders, capacity=2, max_waiting=1)


class ShaderFiles(Struct):
    """The ISF shaders of some folders; nothing is read before `find` is called."""

    _known: BackgroundCache[_Key, tuple[ShaderFile, ...]] = field(default_factory=_make_cache)

    def find(self, folders: Iterable[str]) -> tuple[ShaderFile, ...] | None:
        """The shaders in these folders and the customary ones; None while they are being read."""
        searched = dict.fromkeys(str(Path(folder).expanduser()) for folder in (*CUSTOMARY, *folders))
        key = tuple((folder, _folder_time(folder)) for folder in searched if _folder_time(folder))
        return self._known.get(key) if key else ()

    def close(self) -> None:
        """End the thread."""
        self._known.close()


def _folder_time(folder: str) -> int:
    """When a file was last added to a folder; 0 if there is no such folder."""
    try:
        return Path(folder).stat().st_mtime_ns or 1
    except (OSError, ValueError):
        return 0


def _scan_folders(key: _Key) -> tuple[ShaderFile, ...]:
    shaders: dict[Path, ShaderFile] = {}
    for folder, _ in key:
        for path in _files(Path(folder)):
            try:
                head = read_header(read_text(path, sandbox=UNRESTRICTED))
            except (DocumentError, CodeFault):
                continue
            inside = path.parent.name if path.parent != Path(folder) else Path(folder).name
            takes = any(header_input.type == "image" for header_input in head.inputs)
            shaders[path] = ShaderFile(path, (head.categories or (inside,))[0], head.doc.partition("\n")[0], takes)
    return tuple(sorted(shaders.values(), key=lambda shader: (shader.category.lower(), shader.path.stem.lower())))


def _files(folder: Path) -> Iterator[Path]:
    count = 0
    for top, inner, names in os.walk(folder):
        inner.sort()
        for name in sorted(names):
            if name.lower().endswith(".fs"):
                count += 1
                if count > MOST:
                    return
                yield Path(top, name)
