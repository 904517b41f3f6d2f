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
    """Decodes `uploads`, given with the keys of their pixels, in order, a few ahead of what is taken.

    What was begun and is not wanted any more stays in `begun` for the next one, which may well want it.
    """

    def __init__(
        self, threads: Executor, load: Loader, uploads: Iterable[tuple[Upload, str]], begun: dict[str, Future[Array]]
    ) -> None:
        self._threads, self._load, self._begun = threads, load, begun
        self._uploads = {upload.surface: (upload, key) for upload, key in uploads}
        self._waiting = deque(self._uploads)
        self._started: dict[int, Future[Array]] = {}
        self._go_ahead()

    def __contains__(self, surface: int) -> bool:
        return surface in self._uploads

    def upload(self, surface: int) -> Upload:
        """What is decoded for a surface."""
        return self._uploads[surface][0]

    def ready(self, surface: int) -> bool:
        """True if `take` would not wait."""
        return self._start(surface).done()

    def take(self, surface: int) -> Array:
        """The pixels for a surface, once. Raises what the loader raised."""
        future = self._start(surface)
        del self._uploads[surface], self._started[surface]
        pixels = future.result()
        self._go_ahead()
        return pixels

    def skip(self, surface: int) -> None:
        """These pixels have come from elsewhere."""
        del self._uploads[surface]
        future = self._started.pop(surface, None)
        if future is not None:
            future.cancel()
        self._go_ahead()

    def cancel(self) -> None:
        """Nothing more is wanted."""
        left = {
            self._uploads[surface][1]: future for surface, future in self._started.items()
            if not future.cancel() and not (future.done() and future.exception())
        }
        self._begun.update(left)
        while len(self._begun) > AHEAD:
            self._begun.pop(next(iter(self._begun))).cancel()
        self._waiting.clear()
        self._uploads.clear()
        self._started.clear()

    def _start(self, surface: int) -> Future[Array]:
        if surface not in self._started:
            upload, key = self._uploads[surface]
            self._started[surface] = self._begun.pop(key, None) or self._threads.submit(self._load, upload.picture)
        return self._started[surface]

    def _go_ahead(self) -> None:
        while self._waiting and len(self._started) < AHEAD:
            surface = self._waiting.popleft()
            if surface in self._uploads:
                self._start(surface)
