"""What has come of the frames of a job, and who is told."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Protocol

from msgspec import Struct, field

from .chunk import EntryOutcome


class CampaignListener(Protocol):
    """Is told how far the frames are."""

    def report_progress(self, report: CampaignReport, workers: int) -> None:
        """What has come of the frames so far; so many workers render."""
        ...

    def report_note(self, sentence: str) -> None:
        """Something that the user should know."""
        ...


class CampaignReport(Struct):
    """What came of the frames: seconds of each that is finished, and why each other one cannot be rendered.

    Where a job has many files, their numbers stand for frames, and `entries` say more about them.
    """

    seconds: dict[int, float] = field(default_factory=dict[int, float])
    kept: set[int] = field(default_factory=set[int])
    faults: dict[int, Mapping[str, Any]] = field(default_factory=dict[int, Mapping[str, Any]])
    costs: list[Mapping[str, Any]] = field(default_factory=list[Mapping[str, Any]])
    workers: set[str] = field(default_factory=set[str])
    chunks: int = 0
    stages: Mapping[str, int] = field(default_factory=dict[str, int])
    """How many frames were rendered by each stage that comes before the frames."""
    entries: dict[int, EntryOutcome] = field(default_factory=dict[int, EntryOutcome])

    def list_missing(self, parts: Iterable[int]) -> tuple[int, ...]:
        """Those of these frames or files of which nothing is known yet."""
        return tuple(part for part in parts if part not in self.seconds and part not in self.faults)
