"""How many findings are looked for: a file can hold 100,000 faults, and nobody reads more than the first of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol, TypeVar, get_args

from msgspec import Struct, field

from .rules import Severity

MAX_FINDINGS = 1000
"""Errors, and warnings, that are looked for in a graph. Chosen by judgement: more than a user corrects before the next
check."""
MAX_SEEN = 10 * MAX_FINDINGS
"""Findings that are looked at for those, also where the file allows most of them."""


class Graded(Protocol):
    """A finding that `Enough` counts."""

    @property
    def severity(self) -> Severity:
        """An error or a warning."""
        ...


G = TypeVar("G", bound=Graded)


class Enough(Struct):
    """Counts findings of a graph. What finds them asks whether more are wanted, and stops where none are."""

    listed: dict[Severity, int] = field(default_factory=lambda: dict.fromkeys(get_args(Severity), 0))
    seen: int = 0
    stopped: bool = False
    """True if some may not have been found."""

    def wants(self, severity: Severity) -> bool:
        """True if more findings of this severity are looked for. Errors are, however many warnings there are."""
        if self.listed[severity] < MAX_FINDINGS and (severity == "error" or self.seen < MAX_SEEN):
            return True
        self.stopped = True
        return False

    def count(self, severity: Severity) -> None:
        """Note that a finding is listed."""
        self.listed[severity] += 1

    def take(self, findings: Iterator[G]) -> Iterator[G]:
        """The findings that are wanted, which count as listed; no others are asked for after the last error of them."""
        for finding in findings:
            self.seen += 1
            if self.wants(finding.severity):
                self.count(finding.severity)
                yield finding
            if not self.wants("error"):
                return
