"""Small pictures of documents, as the viewer showed them when they were saved."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Iterable
from pathlib import Path

from ..color.transforms import Array
from ..errors import HalationError
from ..media.pictures.thumbnail import save_thumbnail
from ..resources.sandbox import UNRESTRICTED


class DocumentPictures:
    """Pictures of documents by their paths, in a folder of the editor. What cannot be written is left out."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def find(self, path: str | Path) -> Path:
        """The file of the picture of a document, which may not be there."""
        full = os.path.abspath(path)  # noqa: PTH100 - links stay as they were named
        return self._folder / f"{hashlib.sha256(full.encode(errors='surrogatepass')).hexdigest()[:32]}.jpg"

    def save(self, path: Path, pixels: Array) -> None:
        """Keep a picture [h, w, 3] of uint8 of a document."""
        with contextlib.suppress(HalationError, OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            save_thumbnail(self.find(path), pixels, sandbox=UNRESTRICTED)

    def tidy(self, paths: Iterable[str | Path]) -> None:
        """Remove the pictures of all documents but these."""
        files = {self.find(path) for path in paths}
        with contextlib.suppress(OSError):
            for file in self._folder.glob("*.jpg"):
                if file not in files:
                    os.remove(file)  # noqa: PTH107
