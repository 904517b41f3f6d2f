"""Which documents are open in which editors: each editor writes down what it has open, beside its recovery file."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path

from .file_locks import is_held

LOOK_AGAIN = 1.0
"""Seconds between two looks at the folder: a choice, as the answer is asked for in every frame."""


class DocumentClaim:
    """The document that one editor has open, in a file that is locked while the editor runs."""

    def __init__(self, file: Path) -> None:
        self._file = file.with_suffix(".open")
        self._path: Path | None = None
        self._looked_at = float("-inf")
        self._is_shared = False

    def set_path(self, path: Path | None) -> None:
        """Set the file that this editor has open."""
        if path == self._path:
            return
        self._path, self._looked_at = path, float("-inf")
        with suppress(OSError):
            if path is None:
                self._file.unlink(missing_ok=True)
            else:
                self._file.write_bytes(os.fsencode(path.resolve()))

    def is_shared(self) -> bool:
        """True if another editor that runs has the same file open."""
        if self._path is None:
            return False
        if time.monotonic() - self._looked_at >= LOOK_AGAIN:
            self._looked_at, self._is_shared = time.monotonic(), self._find_other(os.fsencode(self._path.resolve()))
        return self._is_shared

    def close(self) -> None:
        """Remove the claim of this editor."""
        self.set_path(None)

    def _find_other(self, path: bytes) -> bool:
        with suppress(OSError):
            for file in self._file.parent.glob("*.open"):
                if file != self._file and is_held(file.with_suffix(".lock")) and file.read_bytes() == path:
                    return True
        return False
