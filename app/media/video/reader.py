"""Reads frames of videos by number: exactly those that decoding from the first one would give.

A frame is decoded from the key frame before it. Frames decoded on the way are kept for a while, and reading in order
continues decoding: a video that is read from start to end is decoded once.
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
from ...resources.sandbox import Sandbox
from .index import FrameIndex, KeyFrame, decode_frames, demux_packets, describe_video_fault, open_video, survey_video
from .library import load_pyav

_CACHE_BYTES = 128 << 20
"""Bytes of decoded frames that are kept: 40 frames of 1920x1080 in 4:2:0, about a second and a half. Chosen by
judgement."""
_NEAR = 12
"""A frame at most this far ahead is reached by decoding on, without a search for a key frame: key frames in codecs for
editing and broadcast are usually 12 to 15 frames apart."""


def read_frame(path: str, mark: str, number: int, sandbox: Sandbox) -> Any:
    """A frame of a video as PyAV has it; the first is 1.

    Raises:
        InputError: there is no such frame, or it is damaged.
    """
    facts, _ = survey_video(path, mark, sandbox=sandbox)
    if not 1 <= number <= facts.count:
        raise InputError(f"{path}: has no frame {number}, only 1-{facts.count}")
    return _open_reader(path, mark, sandbox=sandbox).read_frame(number)


class VideoReader:
    """One open video. `frame` may be called on any thread."""

    def __init__(self, path: str, mark: str, sandbox: Sandbox) -> None:
        self.path, self._mark, self._sandbox = path, mark, sandbox
        self._lock = Lock()
        self._resources = ExitStack()
        self._streams: tuple[Any, Any, Any] = (None, None, None)
        self._index: FrameIndex | None = None
        self._start = KeyFrame(0, 0)
        """The place where decoding began."""
        self._decoding: Iterator[Any] = iter(())
        self._position = 0
        """The number of the frame that was decoded last; 0 if the next one is unknown."""
        self._cache: OrderedDict[int, Any] = OrderedDict()
        self._cached_bytes = 0

    def read_frame(self, number: int) -> Any:
        """An existing frame. Raises InputError if it is damaged."""
        av = load_pyav()
        with self._lock:
            if number in self._cache:
                self._cache.move_to_end(number)
                return self._cache[number]
            try:
                if self._index is None:
                    self._index = survey_video(self.path, self._mark, sandbox=self._sandbox)[1]
                    self._reopen()
                frame = self._seek_frame(self._index, number) if self._index.times else self._count_to(number)
            except (av.FFmpegError, MemoryError) as error:
                self._reopen()
                raise InputError(f"{self.path}: frame {number}: {describe_video_fault(error)}") from error
            if frame is None:
                self._position = 0
                raise InputError(f"{self.path}: frame {number} is missing or damaged: copy or render it again")
            return frame

    # --- by the times of packets -------------------------------------------------------------------------------------

    def _seek_frame(self, index: FrameIndex, number: int) -> Any:
        """A frame, decoded from the key frame before it; if it is incomplete, from an earlier key frame."""
        if self._is_reached_by_decoding_on(index, number) and (frame := self._decode_until(index, number)) is not None:
            return frame
        nearest_key = index.last_key_before(index.times[number - 1])
        for place in dict.fromkeys((nearest_key, max(nearest_key - 1, 0), 0)):
            self._start = index.keys[place]
            self._decoding = self._decode_from(index, self._start)
            if (frame := self._decode_until(index, number)) is not None:
                return frame
        return None

    def _is_reached_by_decoding_on(self, index: FrameIndex, number: int) -> bool:
        """True if decoding on reaches the frame soon, or no later than from its key frame."""
        if not 0 < self._position < number:
            return False
        key = index.keys[index.last_key_before(index.times[number - 1])]
        return number - self._position <= _NEAR or key.time <= index.times[self._position - 1]

    def _decode_until(self, index: FrameIndex, number: int) -> Any:
        """Decode up to a frame; None if it does not come, or is incomplete."""
        time = index.times[number - 1]
        for frame in self._decoding:
            if frame.pts is None or frame.pts > time:
                break
            is_whole = frame.pts >= self._start.time and not (frame.is_corrupt and self._start.place)
            place = bisect_left(index.times, frame.pts)
            if is_whole and index.times[place] == frame.pts:
                self._cache_frame(place + 1, frame)
                if frame.pts == time:
                    return frame
        self._position = 0
        return None

    def _decode_from(self, index: FrameIndex, key: KeyFrame) -> Iterator[Any]:
        """All frames from a key frame on. Frames that are shown before it but stored after it may be broken."""
        before = index.keys[max(index.last_key_before(key.time) - 1, 0)].time
        for time in dict.fromkeys((key.time, before)) if key.place else ():
            container, stream, decoder = self._streams
            container.seek(time, stream=stream, backward=True)
            coming = demux_packets(container, stream)
            first = next(coming, None)
            if first is not None and index.places.get((first.pts, first.dts), key.place + 1) <= key.place:
                decoder.flush_buffers()
                coming = chain((first,), coming)
                break
        else:
            container, stream, decoder = self._reopen()
            coming = demux_packets(container, stream)
        for packet in coming:
            if index.places.get((packet.pts, packet.dts), key.place) >= key.place:
                yield from decoder.decode(packet)
        yield from decoder.decode(None)

    # --- by counting -------------------------------------------------------------------------------------------------

    def _count_to(self, number: int) -> Any:
        if not 0 < self._position < number:
            self._decoding = decode_frames(*self._reopen())
        for frame in self._decoding:
            self._cache_frame(self._position + 1, frame)
            if self._position == number:
                return frame
        return None

    # --- both --------------------------------------------------------------------------------------------------------

    def _cache_frame(self, number: int, frame: Any) -> None:
        self._position = number
        if number not in self._cache:
            self._cache[number] = frame
            self._cached_bytes += _frame_bytes(frame)
        while self._cached_bytes > _CACHE_BYTES and len(self._cache) > 1:
            self._cached_bytes -= _frame_bytes(self._cache.popitem(last=False)[1])

    def _reopen(self) -> tuple[Any, Any, Any]:
        """Open the video again, at its beginning."""
        self._resources.close()
        self._position = 0
        self._streams = self._resources.enter_context(open_video(self.path, sandbox=self._sandbox))
        return self._streams


def _frame_bytes(frame: Any) -> int:
    return sum(plane.buffer_size for plane in frame.planes)


@lru_cache(maxsize=6)  # chosen by judgement: an open video has a decoder and the frames of a group
def _open_reader(path: str, mark: str, sandbox: Sandbox) -> VideoReader:
    return VideoReader(path, mark, sandbox=sandbox)
