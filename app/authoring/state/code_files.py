"""Files that hold code of nodes: what the disk has, and drafts that differ from it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from ...document.disk import read_text
from ...errors import DocumentError
from ...graph import Graph
from ...resources.sandbox import Sandbox
from ..edits import coding
from .memo import Memo


class CodeFiles:
    """What the files of code hold, as far as it was read.

    Code in a file may differ from the file until that is saved: then it is a draft. All nodes of a document that have
    their code in one file have the same text.
    """

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox = sandbox
        self._on_disk: dict[Path, str] = {}
        self._version = object()
        """Another object whenever something else is known of the disk."""
        self._memo = Memo()

    def drafts(self, root: Graph) -> Mapping[Path, str]:
        """Code of a document that differs from the file that it belongs to, by file."""
        return self._memo.get("drafts", (root, self._version), lambda: self._find_drafts(root))

    def note(self, path: Path, text: str) -> None:
        """Remember what a file holds."""
        self._on_disk[path], self._version = text, object()

    def read_missing(self, root: Graph) -> None:
        """Read the files of code of a document that were not read yet."""
        for path in coding.file_texts(root):
            if path not in self._on_disk:
                try:
                    self.note(path, read_text(path, sandbox=self._sandbox))
                except DocumentError:
                    self.note(path, "")

    def differs(self, path: Path, text: str) -> bool:
        """True if a file holds something else than that text now, or cannot be read."""
        try:
            return read_text(path, sandbox=self._sandbox) != text
        except DocumentError:
            return True

    def forget(self, path: Path) -> None:
        """Read a file again the next time."""
        self._on_disk.pop(path, None)

    def clear(self) -> None:
        """Read all files again the next time."""
        self._on_disk, self._version = {}, object()

    def _find_drafts(self, root: Graph) -> Mapping[Path, str]:
        texts = coding.file_texts(root).items()
        return MappingProxyType({path: text for path, text in texts if self._on_disk.get(path, text) != text})
