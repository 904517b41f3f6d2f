"""The log: sentences that the Log panel lists and toasts show."""

from __future__ import annotations

import traceback
from collections import deque
from collections.abc import Callable
from time import time
from typing import Literal, TypeVar

from msgspec import Struct, field

from ..errors import HalationError
from ..language.translation import translate

T = TypeVar("T")
Level = Literal["info", "warning", "error"]

KEPT = 500
"""Messages that are kept. A choice: more than a user reads."""

TOAST_SECONDS = 6.0
"""Seconds for which a message stays over the window. A choice: long enough for two lines."""


class LogEntry(Struct, frozen=True):
    """One message; `detail` (such as a traceback) is shown on demand. `at` is in seconds since 1970."""

    sentence: str
    level: Level
    at: float
    detail: str = ""


class Log(Struct):
    """The last messages, oldest first."""

    entries: deque[LogEntry] = field(default_factory=lambda: deque[LogEntry](maxlen=KEPT))
    clock: Callable[[], float] = time

    def add(self, sentence: str, level: Level = "info", detail: str = "") -> None:
        """Add a message; the same one twice in a row is added once."""
        newest = self.entries[-1] if self.entries else None
        if newest and (newest.sentence, newest.level, newest.detail) == (sentence, level, detail):
            self.entries.pop()
        self.entries.append(LogEntry(sentence, level, self.clock(), detail))

    def attempt(self, act: Callable[[], T], default: T | None = None) -> T | None:
        """Run an action of the user; an error becomes a message, and `default` is returned.

        A HalationError is a mistake that its sentence explains. Any other exception is a fault of the program.
        """
        try:
            return act()
        except HalationError as error:
            self.add(str(error), "error")
        except Exception as error:
            self.add(
                translate(
                    "this did not work because of a fault in Halation ({kind}: {error}); the document is as it was "
                    "before",
                    kind=type(error).__name__,
                    error=error,
                ),
                "error",
                traceback.format_exc(),
            )
        return default

    def toasts(self) -> tuple[LogEntry, ...]:
        """The messages that are new enough for a toast."""
        since = self.clock() - TOAST_SECONDS
        return tuple(entry for entry in self.entries if entry.at > since)

    def age(self, entry: LogEntry) -> float:
        """Seconds since an entry was added."""
        return self.clock() - entry.at
