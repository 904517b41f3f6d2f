"""What happened: sentences that panels show and toasts repeat."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from time import time
from typing import Literal

Level = Literal["info", "warning", "error"]

KEPT = 500
TOAST_SECONDS = 6.0


@dataclass(frozen=True)
class Entry:
    """One sentence; `detail` (a traceback, say) is shown on demand. `at` is seconds since the epoch."""

    sentence: str
    level: Level
    detail: str = ""
    at: float = field(default_factory=time)


@dataclass
class Log:
    """The newest sentences, oldest first."""

    entries: deque[Entry] = field(default_factory=lambda: deque[Entry](maxlen=KEPT))
    dismissed: float = 0.0
    """Entries up to this time are not repeated as toasts any more."""

    def add(self, sentence: str, level: Level = "info", detail: str = "") -> None:
        """Note a sentence; the same one twice in a row is noted once."""
        newest = self.entries[-1] if self.entries else None
        if newest and (newest.sentence, newest.level, newest.detail) == (sentence, level, detail):
            self.entries.pop()
        self.entries.append(Entry(sentence, level, detail))

    def toasts(self) -> tuple[Entry, ...]:
        """What was said just now."""
        since = max(time() - TOAST_SECONDS, self.dismissed)
        return tuple(entry for entry in self.entries if entry.at > since)

    def dismiss(self) -> None:
        """No toast for what was said so far."""
        self.dismissed = time()
