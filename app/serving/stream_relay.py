"""Stands between the client of a stream and the process that answers, which may be stopped and replaced."""

from __future__ import annotations

import contextlib
import os
import select
import sys
from collections.abc import Generator
from contextlib import contextmanager
from typing import IO

from ..resources.struct_json import write_struct
from .listening import make_line_writer, make_sender, queue_line, refuse_long_line
from .request_queue import RequestQueue, ServiceClient
from .service_requests import MAX_LINE_BYTES, ServiceRequest, describe_failure

_CHUNK = 1 << 20
"""Bytes that are read at a time."""


def _widen_pipe(end: int) -> None:
    """Let a pipe hold as much as is read at a time, where the system can: each time it is full costs a change of
    processes.
    """
    if sys.platform == "linux":
        import fcntl

        with contextlib.suppress(OSError):  # a user may have only so much in pipes
            fcntl.fcntl(end, fcntl.F_SETPIPE_SZ, _CHUNK)


class _Pipe:
    """A pipe of which this process uses one end, without waiting, and a copy of it the other."""

    def __init__(self, own_end: int) -> None:
        ends = os.pipe()
        self.own, self.other = ends[own_end], ends[1 - own_end]
        self._open_ends = {*ends}
        os.set_blocking(self.own, False)
        _widen_pipe(self.own)

    def close(self, *ends: int) -> None:
        """Close these ends, or both, if they are open."""
        for end in self._open_ends.intersection(ends or self._open_ends):
            self._open_ends.discard(end)
            os.close(end)


class _LineBuffer:
    """Divides what comes in pieces of any size into lines."""

    def __init__(self) -> None:
        self.size = 0
        """Bytes of the line that has no end yet."""
        self._pieces: list[bytes] = []

    def split(self, piece: bytes) -> list[bytes]:
        """The lines that end in the next piece."""
        *ends, rest = piece.split(b"\n")
        lines = [b"".join([*self._pieces, end]) if not place else end for place, end in enumerate(ends)]
        if ends:
            self._pieces, self.size = [], 0
        self._pieces.append(rest)
        self.size += len(rest)
        return lines


class StreamRelay:
    """Hands the requests of a stream to another process, one at a time, and its replies back.

    The requests that wait are kept here, so that only one is lost with that process. All is done by `wait`, on one
    thread: a process with several cannot be copied.
    """

    _requests: _Pipe
    _replies: _Pipe

    def __init__(self, requests: int, replies: IO[bytes]) -> None:
        self._source, self._has_ended = requests, False
        self._queue, self._request_lines = RequestQueue(), _LineBuffer()
        self._write_line = make_line_writer(replies, lambda: self._queue.remove_client(self._client))
        self._client = ServiceClient(make_sender(self._write_line))
        self._current: ServiceRequest | None = None
        """The request that the other process answers."""
        self._unsent, self._reply_lines = memoryview(b""), _LineBuffer()

    @contextmanager
    def open_pipes(self) -> Generator[None]:
        """Lead to a process that is started in this block."""
        self._requests, self._replies = _Pipe(1), _Pipe(0)
        self._unsent, self._reply_lines = memoryview(b""), _LineBuffer()
        try:
            yield
        finally:
            self._requests.close()
            self._replies.close()

    def enter(self) -> None:
        """Take the pipes for standard input and output: called in the process that answers."""
        os.dup2(self._requests.other, 0)
        os.dup2(self._replies.other, 1)
        self._requests.close()
        self._replies.close()

    def fail_request(self, fault: Exception) -> bool:
        """Answer the request with which the process was stopped; False if there was none."""
        if self._current is None:
            return False
        self._client.send({"id": self._current.id, "error": describe_failure(fault)})
        self._current = None
        return True

    def wait(self, handle: int, seconds: float) -> bool:
        """Pass on what comes in that time; True if the process behind the handle has ended."""
        self._hand_over_request()
        sources = [handle, self._replies.own, *(() if self._has_ended else (self._source,))]
        ready, writable, _ = select.select(sources, [self._requests.own] if self._unsent else [], [], seconds)
        if writable:
            self._send_rest()
        if self._replies.own in ready:
            self._pass_replies()
        if handle in ready:
            while self._pass_replies():  # what it has written before it ended
                pass
            return True
        if self._source in ready:
            self._read_requests()
        return False

    def _hand_over_request(self) -> None:
        """Send the next request, or the end of all, to a process that has answered the last one."""
        if self._current is not None or self._unsent:
            return
        if turn := self._queue.take_waiting_request():
            self._current = turn[1]
            self._send(write_struct(self._current).encode() + b"\n")
        elif self._has_ended:
            self._requests.close(self._requests.own)

    def _send(self, line: bytes) -> None:
        self._unsent = memoryview(bytes(self._unsent) + line)  # a view is cut without being copied
        self._send_rest()

    def _send_rest(self) -> None:
        with contextlib.suppress(BlockingIOError):
            self._unsent = self._unsent[os.write(self._requests.own, self._unsent) :]

    def _pass_replies(self) -> bool:
        """Pass on the lines that the process has written; False if there is nothing to read."""
        try:
            piece = os.read(self._replies.own, _CHUNK)
        except BlockingIOError:
            return False
        for line in self._reply_lines.split(piece):
            self._current = None
            self._write_line(line + b"\n")
        return bool(piece)

    def _read_requests(self) -> None:
        try:
            piece = os.read(self._source, _CHUNK)
        except OSError:
            piece = b""
        lines = self._request_lines.split(piece if piece else b"\n")
        for line in lines:
            if line.strip():
                queue_line(self._queue, self._client, line)
        self._has_ended = not piece or self._client.is_gone
        if self._request_lines.size > MAX_LINE_BYTES:
            refuse_long_line(self._client)
            self._has_ended = True
        if self._current is not None and (self._client.is_gone or self._current.id in self._client.cancelled_ids):
            self._send(write_struct(ServiceRequest("cancel", request=self._current.id)).encode() + b"\n")
        self._client.cancelled_ids.clear()
