"""Tells another process which code of a user runs on the device right now."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

BEACON_FILE = "HALATION_HEARTBEAT"
"""The environment variable with the path of the file."""


class ProgressBeacon:
    """Writes to a file when code of a user begins to run, and when it has ended; nothing if no process watches.

    A device that hangs cannot be asked, and takes its process with it: only another process can notice.
    """

    def __init__(self) -> None:
        self._path = os.environ.get(BEACON_FILE, "")
        self._count = 0

    @property
    def is_watched(self) -> bool:
        """True if a process watches the file."""
        return bool(self._path)

    @contextmanager
    def announce(self, nodes: Sequence[str]) -> Iterator[None]:
        """Say that these nodes run, for as long as the block takes."""
        self._count += 1
        self._write(f"{self._count} {', '.join(nodes)}")
        try:
            yield
        finally:
            self._write("")

    def _write(self, text: str) -> None:
        with contextlib.suppress(OSError):  # the process that watched may have ended, and its file with it
            Path(self._path).write_text(text, encoding="utf-8")
