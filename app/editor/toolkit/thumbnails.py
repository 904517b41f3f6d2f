"""Thumbnails of picture files: decoded in a thread, kept in memory and on disk."""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING

from ...authoring.background.cache import BackgroundCache
from ...errors import HalationError
from ...language.translation import translate
from ...resources.sandbox import UNRESTRICTED, Sandbox

if TYPE_CHECKING:
    from ...color.transforms import Array

WIDTH, HEIGHT = 192, 108
_IN_MEMORY, _ON_DISK, _WAITING = 400, 2000, 48


class FileThumbnails:
    """Decodes the last requested file first. `folder` keeps thumbnails for the next start."""

    def __init__(self, folder: Path, sandbox: Sandbox) -> None:
        self._folder, self._sandbox = folder, sandbox
        self._decoded: BackgroundCache[tuple[Path, float], Array | str] = BackgroundCache(
            "thumbnails", self._load_or_make, _IN_MEMORY, _WAITING, self._tidy
        )

    def get(self, path: Path, time: float) -> Array | str | None:
        """The thumbnail, [h, w, 3] of uint8; a sentence if that is impossible, None if it is not ready: ask again.

        `time` is that of the file's last change.
        """
        return self._decoded.get((path, time))

    @property
    def busy(self) -> bool:
        """True while a requested thumbnail is not ready."""
        return self._decoded.is_busy

    def forget(self) -> None:
        """Drop all requests."""
        self._decoded.forget()

    def close(self) -> None:
        """End the thread."""
        self._decoded.close()

    def _load_or_make(self, key: tuple[Path, float]) -> Array | str:
        from ...media.pictures.thumbnail import load_thumbnail, read_thumbnail, save_thumbnail

        path, time = key
        name = hashlib.sha256(f"{path.absolute()}\n{time}".encode(errors="surrogatepass")).hexdigest()[:32]
        cached_file = self._folder / f"{name}.png"
        with contextlib.suppress(HalationError):
            return load_thumbnail(cached_file, sandbox=UNRESTRICTED)
        try:
            pixels = read_thumbnail(path, WIDTH, HEIGHT, sandbox=self._sandbox)
        except HalationError as fault:
            return str(fault)
        except Exception as fault:
            return translate("{path}: cannot be shown ({fault})", path=path, fault=fault)
        with contextlib.suppress(HalationError, OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            save_thumbnail(cached_file, pixels, sandbox=UNRESTRICTED)
        return pixels

    def _tidy(self) -> None:
        """Remove the oldest files if there are too many."""
        with contextlib.suppress(OSError):
            files = sorted(self._folder.glob("*.png"), key=lambda file: file.stat().st_mtime)
            for file in files[: max(len(files) - _ON_DISK, 0)]:
                os.remove(file)  # noqa: PTH107
