"""What libraries written in C print by themselves.

libpng, libtiff and others report faults of a file on the standard error of C, beside the sentence that the user gets.
That stream is a variable of the C library, so it can be exchanged while a file is read. The descriptor stays, and with
it all that Python writes, on this thread and on others.
"""

from __future__ import annotations

import ctypes
import os
import sys
import threading
from collections.abc import Generator
from contextlib import contextmanager
from functools import cache

_STREAM_NAMES = {"linux": "stderr", "darwin": "__stderrp"}


class _ErrorStream:
    """The standard error of C, and an empty stream in its place while anyone wants quiet."""

    def __init__(self, stream: ctypes.c_void_p, sink: int) -> None:
        self._stream, self._usual, self._sink = stream, stream.value, sink
        self._lock, self._count = threading.Lock(), 0

    @contextmanager
    def replace(self) -> Generator[None]:
        """Exchange the stream until the last of those who want it has left."""
        self._change(1)
        try:
            yield
        finally:
            self._change(-1)

    def _change(self, step: int) -> None:
        with self._lock:
            self._count += step
            self._stream.value = self._sink if self._count else self._usual


@contextmanager
def quiet_libraries() -> Generator[None]:
    """Keep libraries from printing while a file is read; HALATION_DEBUG=1 lets them."""
    stream = _find_error_stream()
    if stream is None:
        yield
        return
    with stream.replace():
        yield


@cache
def _find_error_stream() -> _ErrorStream | None:
    """The error stream; None where the system keeps it elsewhere."""
    name = _STREAM_NAMES.get(sys.platform)
    if name is None or os.environ.get("HALATION_DEBUG"):
        return None
    try:
        library = ctypes.CDLL(None)
        stream = ctypes.c_void_p.in_dll(library, name)
        library.fopen.restype = ctypes.c_void_p
        sink = library.fopen(os.fsencode(os.devnull), b"w")
    except (OSError, ValueError, AttributeError):
        return None
    return _ErrorStream(stream, sink) if sink and stream.value else None
