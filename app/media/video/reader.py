"""Frames of videos by number: exactly those that decoding from the first one on would give.

A frame is decoded from the key frame before it. What was decoded on the way stays for a while, and where reading goes
on in order, so does decoding: a video that is read from the first to the last frame is decoded once.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import ExitStack
from functools import lru_cache
from itertools import chain
from threading import Lock
from typing import Any

from ...errors import InputError
from .index import Index, Key, fault, frames, opened, packets, surveyed
from .library import library

_KEPT_BYTES = 128 << 20
_NEAR = 12
"""So many frames ahead it is not worth to look for a key frame."""


def raw_frame(path: str, mark: str, number: int) -> Any:
    """A frame of a video as PyAV has it; the first is 1.

    Raises:
        InputError: there is no such frame, or it is damaged.
    """
    facts, _ = surveyed(path, mark)
    if not 1 <= number <= facts.count:
        raise InputError(f"{path}: has no frame {number}, only 1-{facts.count}")
    return _reader(path, mark).frame(number)


class Reader:
    """One open video. `frame` may be called on any thread."""

    def __init__(self, path: str, mark: str) -> None:
        self.path, self._mark = path, mark
        self._lock = Lock()
        self._open = ExitStack()
        self._streams: tuple[Any, Any, Any] = (None, None, None)
        self._index: Index | None = None
        self._base = Key(0, 0)
        """Where decoding began."""
        self._coming: Iterator[Any] = iter(())
        self._at = 0
        """The number of the frame that was decoded last; 0 where the next one is unknown."""
        self._kept: OrderedDict[int, Any] = OrderedDict()
        self._bytes = 0

    def frame(self, number: int) -> Any:
        """A frame that there is. Raises InputError if it is damaged."""
        av = library()
        with self._lock:
            if number in self._kept:
                self._kept.move_to_end(number)
                return self._kept[number]
            try:
                if self._index is None:
                    self._index = surveyed(self.path, self._mark)[1]
                    self._restart()
                found = self._sought(self._index, number) if self._index.times else self._counted(number)
            except (av.FFmpegError, MemoryError) as error:
                self._restart()
                raise InputError(f"{self.path}: frame {number}: {fault(error)}") from error
            if found is None:
                self._at = 0
                raise InputError(f"{self.path}: frame {number} is missing or damaged: copy or render it again")
            return found

    # --- by the times of packets -------------------------------------------------------------------------------------

    def _sought(self, index: Index, number: int) -> Any:
        """A frame by the key frame before it; where it does not come out whole, by an earlier one."""
        if self._goes_on(index, number) and (found := self._until(index, number)) is not None:
            return found
        best = index.key(index.times[number - 1])
        for place in dict.fromkeys((best, max(best - 1, 0), 0)):
            self._base = index.keys[place]
            self._coming = self._from(index, self._base)
            if (found := self._until(index, number)) is not None:
                return found
        return None

    def _goes_on(self, index: Index, number: int) -> bool:
        """True if the frame comes soon, or no later than from the key frame before it."""
        if not 0 < self._at < number:
            return False
        key = index.keys[index.key(index.times[number - 1])]
        return number - self._at <= _NEAR or key.time <= index.times[self._at - 1]

    def _until(self, index: Index, number: int) -> Any:
        """Decode up to a frame; None if it does not come, or not whole."""
        wanted = index.times[number - 1]
        for frame in self._coming:
            if frame.pts is None or frame.pts > wanted:
                break
            whole = frame.pts >= self._base.time and not (frame.is_corrupt and self._base.place)
            at = bisect_left(index.times, frame.pts)
            if whole and index.times[at] == frame.pts:
                self._keep(at + 1, frame)
                if frame.pts == wanted:
                    return frame
        self._at = 0
        return None

    def _from(self, index: Index, key: Key) -> Iterator[Any]:
        """All frames from a key frame on; those before it in time, which some codecs put behind it, may be broken."""
        before = index.keys[max(index.key(key.time) - 1, 0)].time
        for time in dict.fromkeys((key.time, before)) if key.place else ():
            container, stream, decoder = self._streams
            container.seek(time, stream=stream, backward=True)
            coming = packets(container, stream)
            first = next(coming, None)
            if first is not None and index.places.get((first.pts, first.dts), key.place + 1) <= key.place:
                decoder.flush_buffers()
                coming = chain((first,), coming)
                break
        else:
            container, stream, decoder = self._restart()
            coming = packets(container, stream)
        for packet in coming:
            if index.places.get((packet.pts, packet.dts), key.place) >= key.place:
                yield from decoder.decode(packet)
        yield from decoder.decode(None)

    # --- by counting -------------------------------------------------------------------------------------------------

    def _counted(self, number: int) -> Any:
        if not 0 < self._at < number:
            self._coming = frames(*self._restart())
        for frame in self._coming:
            self._keep(self._at + 1, frame)
            if self._at == number:
                return frame
        return None

    # --- both --------------------------------------------------------------------------------------------------------

    def _keep(self, number: int, frame: Any) -> None:
        self._at = number
        if number not in self._kept:
            self._kept[number] = frame
            self._bytes += _size(frame)
        while self._bytes > _KEPT_BYTES and len(self._kept) > 1:
            self._bytes -= _size(self._kept.popitem(last=False)[1])

    def _restart(self) -> tuple[Any, Any, Any]:
        """Open it anew, at the beginning."""
        self._open.close()
        self._at = 0
        self._streams = self._open.enter_context(opened(self.path))
        return self._streams


def _size(frame: Any) -> int:
    return sum(plane.buffer_size for plane in frame.planes)


@lru_cache(maxsize=6)
def _reader(path: str, mark: str) -> Reader:
    return Reader(path, mark)
