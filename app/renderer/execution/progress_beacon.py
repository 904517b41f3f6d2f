"""Tells a watching process which code of the user runs on the device right now."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from ...resources.heartbeat import BEACON_FILE, BEACON_TRIALS


class ProgressBeacon:
    """Writes to a file when code of the user begins to run, and when it has ended; nothing if no process watches.

    A device that hangs blocks its own process, so only another process can notice it.
    """

    def __init__(self) -> None:
        self._path = os.environ.get(BEACON_FILE, "")
        self._count = 0

    @property
    def is_watched(self) -> bool:
        """True if a process watches the file."""
        return bool(self._path)

    @property
    def replaces_trials(self) -> bool:
        """True if little is lost when the process that watches ends this one: then nothing is tried before."""
        return self.is_watched and not os.environ.get(BEACON_TRIALS)

    @contextmanager
    def announce(self, nodes: Sequence[str]) -> Iterator[None]:
        """Say that these nodes run until the end of the block."""
        self._count += 1
        self._write(f"{self._count} {', '.join(nodes)}")
        try:
            yield
        finally:
            self._write("")

    def _write(self, text: str) -> None:
        with contextlib.suppress(OSError):  # the process that watched may have ended, and its file with it
            Path(self._path).write_text(text, encoding="utf-8")
