"""Which files of a folder are opened, as the system saw it (inotify, Linux)."""

from __future__ import annotations

import ctypes
import os
import struct
from pathlib import Path

IN_ACCESS, IN_OPEN, IN_ISDIR = 0x01, 0x20, 0x40000000


class OpenWatch:
    """Tells whether a file of a folder was opened or read meanwhile (Linux)."""

    def __init__(self, folder: Path) -> None:
        libc = ctypes.CDLL(None, use_errno=True)
        self._handle = libc.inotify_init1(os.O_NONBLOCK)
        assert self._handle >= 0, os.strerror(ctypes.get_errno())
        assert libc.inotify_add_watch(self._handle, os.fsencode(folder), IN_OPEN | IN_ACCESS) >= 0

    def names(self) -> set[str]:
        """The files that were opened since it was asked last."""
        names: set[str] = set()
        try:
            events = os.read(self._handle, 1 << 16)
        except BlockingIOError:
            return names
        at = 0
        while at < len(events):
            _, mask, _, length = struct.unpack_from("iIII", events, at)
            name = events[at + 16 : at + 16 + length].rstrip(b"\0").decode()
            if not mask & IN_ISDIR:
                names.add(name)
            at += 16 + length
        return names

    def close(self) -> None:
        """Stop watching."""
        os.close(self._handle)
