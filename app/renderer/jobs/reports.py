"""What jobs report: while they run to a `JobProgress`, and at their end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Protocol

from msgspec import Struct, field

from ...errors import HalationError


class FrameReport(Struct, frozen=True):
    """The result of a frame. `passes` were executed for it; none if its files were up to date and are kept.

    A video is not among the files `written`: it is complete when all frames are.
    """

    frame: int
    written: tuple[Path, ...]
    passes: int
    is_kept: bool = False


class ItemReport(Struct, frozen=True):
    """The result of one item of a job: its finished frames in order, and the error that ended it, if any."""

    name: str
    frames: tuple[FrameReport, ...]
    videos: tuple[Path, ...] = ()
    views: Mapping[str, str] = field(default_factory=dict[str, str])
    data_outputs: tuple[str, ...] = ()
    fault: HalationError | None = None

    @property
    def written(self) -> tuple[Path, ...]:
        """All files, in the order of the frames, then the videos, which hold all of them."""
        return (*(path for frame in self.frames for path in frame.written), *self.videos)


class JobProgress(Protocol):
    """Is told how far a job is."""

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """A pass of a frame, or of a frame of its history, is finished; it computed these nodes."""
        ...

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """The files of a frame are written; `frames_done` of `total` frames are finished."""
        ...


class JobReport(Struct, frozen=True):
    """What a job did. `seconds` are by stage; stages of different frames overlap."""

    frames: tuple[FrameReport, ...]
    passes: int
    programs: int
    peak_bytes: int
    repaired: Mapping[str, int]
    videos: tuple[Path, ...] = ()
    seconds: Mapping[str, float] = field(default_factory=dict[str, float])
    warnings: Mapping[str, str] = field(default_factory=dict[str, str])
    views: Mapping[str, str] = field(default_factory=dict[str, str])
    """The views that were chosen for outputs because nobody named one and their pictures are made for a screen."""
    data_outputs: tuple[str, ...] = ()
    """The outputs that are data and whose numbers were written without a view into a format for a screen."""

    @property
    def written(self) -> tuple[Path, ...]:
        """All files, in the order of the frames, then the videos, which hold all of them."""
        return (*(path for frame in self.frames for path in frame.written), *self.videos)
