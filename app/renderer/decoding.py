"""Pictures are decoded on other threads while shaders compile and earlier passes run."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, Future

import numpy as np

from ..compiler import Picture, Upload

Array = np.ndarray
Loader = Callable[[Picture], Array]
"""Reads a picture as [height, width, channels] of float16 or float32. Called on worker threads."""

AHEAD = 4
"""Pictures decoded before their turn: enough to keep the threads busy, few enough to fit into memory."""


class Decoding:
    """Decodes `uploads` in order, a few ahead of what is taken."""

    def __init__(self, threads: Executor, load: Loader, uploads: Iterable[Upload]) -> None:
        self._threads, self._load = threads, load
        self._waiting = deque(uploads)
        self._uploads = {upload.surface: upload for upload in self._waiting}
        self._started: dict[int, Future[Array]] = {}
        self._go_ahead()

    def __contains__(self, surface: int) -> bool:
        return surface in self._uploads

    def take(self, surface: int) -> tuple[Upload, Array]:
        """The pixels for a surface, once. Raises what the loader raised."""
        upload = self._uploads.pop(surface)
        future = self._started.pop(surface, None) or self._threads.submit(self._load, upload.picture)
        pixels = future.result()
        self._go_ahead()
        return upload, pixels

    def skip(self, surface: int) -> None:
        """These pixels have come from elsewhere."""
        del self._uploads[surface]
        future = self._started.pop(surface, None)
        if future is not None:
            future.cancel()
        self._go_ahead()

    def cancel(self) -> None:
        """Nothing more is wanted."""
        for future in self._started.values():
            future.cancel()
        self._waiting.clear()
        self._uploads.clear()
        self._started.clear()

    def _go_ahead(self) -> None:
        while self._waiting and len(self._started) < AHEAD:
            upload = self._waiting.popleft()
            if upload.surface in self._uploads:
                self._started[upload.surface] = self._threads.submit(self._load, upload.picture)
