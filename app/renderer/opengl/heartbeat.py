"""A sign of life for whoever watches this process: which code of a user is running on the device right now."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

HEARTBEAT = "HALATION_HEARTBEAT"
"""The environment variable with the file where it is said."""


class Heartbeat:
    """Says in a file when code begins to run, and when it has ended; nothing if nobody watches.

    A device that is stuck cannot be asked, and takes the process with it: only another process can tell.
    """

    def __init__(self) -> None:
        self._path = os.environ.get(HEARTBEAT, "")
        self._count = 0

    @property
    def watched(self) -> bool:
        """True if somebody looks at it."""
        return bool(self._path)

    @contextmanager
    def running(self, nodes: Sequence[str]) -> Iterator[None]:
        """Around work on the device that may never end."""
        self._count += 1
        self._say(f"{self._count} {', '.join(nodes)}")
        try:
            yield
        finally:
            self._say("")

    def _say(self, text: str) -> None:
        with contextlib.suppress(OSError):  # who has gone does not watch any more
            Path(self._path).write_text(text, encoding="utf-8")
