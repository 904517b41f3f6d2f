"""Decodes pictures on other threads, while shaders compile and earlier passes run."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future

import numpy as np
from msgspec import Struct

from ...compiler import Surface, Upload
from ...resources.picture import Picture

Array = np.ndarray
PictureLoader = Callable[[Picture], Array]
"""Reads a picture as [height, width, channels] of float16 or float32. Called on worker threads."""

MAX_LOOKAHEAD = 4
"""Pictures decoded before their turn: two for each decoding thread, so that a thread always has the next one. More
would only take memory, because pictures are uploaded in order."""

MAX_LOOKAHEAD_BYTES = 2**28
"""Bytes of pictures decoded before their turn; one picture may be larger. Two pictures of 3840x2160 in RGBA floats have
253 MiB. Chosen by judgement: with more, a frame of many large layers would fill the memory of a small machine."""

DecodeRequest = tuple[Upload, Surface]
"""A picture to be decoded, and the surface that it is uploaded to."""


class DecodedPicture(Struct, frozen=True):
    """Pixels, and the seconds that it took to get them."""

    pixels: Array
    seconds: float


def decode_picture(load: PictureLoader, picture: Picture) -> DecodedPicture:
    """Load a picture and measure how long that took."""
    started = time.perf_counter()
    pixels = load(picture)
    return DecodedPicture(pixels, time.perf_counter() - started)


def limit_lookahead(requests: Iterable[DecodeRequest]) -> Iterator[DecodeRequest]:
    """The first requests, as many as may be decoded before their turn."""
    nbytes = 0
    for number, (upload, surface) in enumerate(requests):
        nbytes += surface.nbytes
        if number and (number >= MAX_LOOKAHEAD or nbytes > MAX_LOOKAHEAD_BYTES):
            return
        yield upload, surface


class DecodeQueue:
    """Decodes pictures in the order of the requests, a few ahead of what is taken.

    Pictures that were begun and not taken go to `leftovers` by key, where the next queue finds them.
    """

    def __init__(
        self,
        threads: Executor,
        load: PictureLoader,
        requests: Iterable[DecodeRequest],
        leftovers: dict[str, Future[DecodedPicture]],
    ) -> None:
        self._threads, self._load, self._leftovers = threads, load, leftovers
        self._requests = {upload.surface: (upload, surface) for upload, surface in requests}
        self._futures: dict[int, Future[DecodedPicture]] = {}
        self._start_next()

    def __contains__(self, surface: int) -> bool:
        return surface in self._requests

    def find_upload(self, surface: int) -> Upload:
        """The upload of a surface."""
        return self._requests[surface][0]

    def is_ready(self, surface: int) -> bool:
        """True if `take` would not wait."""
        return self._start(surface).done()

    def take(self, surface: int) -> DecodedPicture:
        """The pixels for a surface, once. Raises what the loader raised."""
        future = self._start(surface)
        del self._requests[surface], self._futures[surface]
        decoded = future.result()
        self._start_next()
        return decoded

    def skip(self, surface: int) -> None:
        """Do not decode a picture: its pixels are on the device already."""
        del self._requests[surface]
        future = self._futures.pop(surface, None)
        if future is not None:
            future.cancel()
        self._start_next()

    def cancel(self) -> None:
        """Stop decoding; what was begun is left for the next queue."""
        unfinished = {
            self._requests[surface][1].key: future
            for surface, future in self._futures.items()
            if not future.cancel() and not (future.done() and future.exception())
        }
        self._leftovers.update(unfinished)
        while len(self._leftovers) > MAX_LOOKAHEAD:
            self._leftovers.pop(next(iter(self._leftovers))).cancel()
        self._requests.clear()
        self._futures.clear()

    def _start(self, number: int) -> Future[DecodedPicture]:
        if number not in self._futures:
            upload, surface = self._requests[number]
            leftover = self._leftovers.pop(surface.key, None)
            self._futures[number] = leftover or self._threads.submit(decode_picture, self._load, upload.picture)
        return self._futures[number]

    def _start_next(self) -> None:
        for upload, _ in limit_lookahead(self._requests.values()):
            self._start(upload.surface)
