"""Shaders in the Interactive Shader Format that lie in folders of this machine, read in a thread."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ...custom_nodes import CodeFault
from ...custom_nodes.isf.header import read_header
from ...document.disk import read_text
from ...errors import DocumentError
from .background import Background

CUSTOMARY = ("/Library/Graphics/ISF", "~/Library/Graphics/ISF", "/ProgramData/ISF")
"""Where programs that know the format look for shaders."""

MOST = 5000
"""Files of one folder that are looked at."""

_Key = tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class ShaderFile:
    """One shader; `takes` is True if it works on a picture, else it makes one out of nothing."""

    path: Path
    category: str
    doc: str
    takes: bool


def _made() -> Background[_Key, tuple[ShaderFile, ...]]:
    return Background("shaders", _scanned, kept=2, waiting=1)


@dataclass
class ShaderFiles:
    """What there is to be added; nothing is read before somebody asks."""

    _known: Background[_Key, tuple[ShaderFile, ...]] = field(default_factory=_made)

    def find(self, folders: Iterable[str]) -> tuple[ShaderFile, ...] | None:
        """The shaders in these folders and the customary ones; None while they are being looked for."""
        wanted = dict.fromkeys(str(Path(folder).expanduser()) for folder in (*CUSTOMARY, *folders))
        key = tuple((folder, _stamp(folder)) for folder in wanted if _stamp(folder))
        return self._known.get(key) if key else ()

    def close(self) -> None:
        """End the thread."""
        self._known.close()


def _stamp(folder: str) -> int:
    """When something was added to a folder; 0 if there is none."""
    try:
        return Path(folder).stat().st_mtime_ns or 1
    except (OSError, ValueError):
        return 0


def _scanned(key: _Key) -> tuple[ShaderFile, ...]:
    found: dict[Path, ShaderFile] = {}
    for folder, _ in key:
        for path in _files(Path(folder)):
            try:
                head = read_header(read_text(path))
            except (DocumentError, CodeFault):
                continue
            inside = path.parent.name if path.parent != Path(folder) else Path(folder).name
            takes = any(one.type == "image" for one in head.inputs)
            found[path] = ShaderFile(path, (head.categories or (inside,))[0], head.doc.partition("\n")[0], takes)
    return tuple(sorted(found.values(), key=lambda one: (one.category.lower(), one.path.stem.lower())))


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
