"""Thumbnails of picture files: decoded in a thread, kept in memory and on disk."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections import OrderedDict
from pathlib import Path
from threading import Condition, Thread
from typing import TYPE_CHECKING

from ...errors import HalationError

if TYPE_CHECKING:
    from ...media.color import Array

WIDTH, HEIGHT = 192, 108
_IN_MEMORY, _ON_DISK, _WAITING = 400, 2000, 48


class Pictures:
    """What was asked for last is decoded first. `folder` keeps what was decoded, for the next time."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._known: OrderedDict[tuple[Path, float], Array | str] = OrderedDict()
        self._wanted: OrderedDict[tuple[Path, float], None] = OrderedDict()
        self._changed = Condition()
        self._thread: Thread | None = None
        self._closed = False

    def get(self, path: Path, time: float) -> Array | str | None:
        """[h, w, 3] of uint8, a sentence if the file is no picture, None if it is not ready; ask again.

        `time` is when the file was changed: another time is another picture.
        """
        key = (path, time)
        with self._changed:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key]
            self._wanted[key] = None
            self._wanted.move_to_end(key)
            while len(self._wanted) > _WAITING:
                self._wanted.popitem(last=False)
            self._changed.notify()
        if self._thread is None:
            self._thread = Thread(target=self._work, name="thumbnails", daemon=True)
            self._thread.start()
        return None

    @property
    def busy(self) -> bool:
        """True while something that was asked for is not ready."""
        return bool(self._wanted)

    def forget(self) -> None:
        """Nothing that was asked for is wanted any more."""
        with self._changed:
            self._wanted.clear()

    def close(self) -> None:
        """End the thread."""
        with self._changed:
            self._closed = True
            self._wanted.clear()
            self._changed.notify()
        if self._thread is not None:
            self._thread.join()

    def _work(self) -> None:
        self._tidy()
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._wanted or self._closed)
                if self._closed:
                    return
                key = next(reversed(self._wanted))
            made = self._made(*key)
            with self._changed:
                self._known[key] = made
                self._wanted.pop(key, None)
                while len(self._known) > _IN_MEMORY:
                    self._known.popitem(last=False)

    def _made(self, path: Path, time: float) -> Array | str:
        from ...media.thumbnail import load_thumbnail, save_thumbnail, thumbnail

        name = hashlib.sha256(f"{path.absolute()}\n{time}".encode(errors="surrogatepass")).hexdigest()[:32]
        kept = self._folder / f"{name}.png"
        with contextlib.suppress(HalationError):
            return load_thumbnail(kept)
        try:
            made = thumbnail(path, WIDTH, HEIGHT)
        except HalationError as fault:
            return str(fault)
        except Exception as fault:
            return f"{path}: cannot be shown ({fault})"
        with contextlib.suppress(HalationError, OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            save_thumbnail(kept, made)
        return made

    def _tidy(self) -> None:
        """Remove the oldest files if there are too many."""
        with contextlib.suppress(OSError):
            files = sorted(self._folder.glob("*.png"), key=lambda file: file.stat().st_mtime)
            for file in files[: max(len(files) - _ON_DISK, 0)]:
                os.remove(file)  # noqa: PTH107
