"""The state of the timeline. Nothing here changes the document."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct, field

from .playback import LOOPS, Course, Loop, Playback

if TYPE_CHECKING:
    from ...authoring.session import Session

LEAST_VIEW = 4.0
"""The least number of visible frames."""


class TimelineState(Struct):
    """Playback, the playback range, and the visible range."""

    playback: Playback = field(default_factory=Playback)
    loop: Loop = "loop"
    every: bool = False
    """True drops no frame."""
    part: tuple[int, int] | None = None
    """The frames that are played; None for all."""
    view: tuple[float, float] | None = None
    """The frames at the borders of the ruler; None for all."""
    scrubbing: bool = False
    hovered: bool = False
    tapped: bool = False
    """True while Space is held and nothing else was pressed."""
    report: str = ""
    """The speed of the last playback, as text."""

    @property
    def playing(self) -> bool:
        """True while frames are played."""
        return self.playback.playing

    def span(self, session: Session) -> tuple[int, int]:
        """The first and last frame that are played: the chosen part within the range."""
        first, last = session.time.frames
        if self.part is None:
            return first, last
        low, high = max(self.part[0], first), min(self.part[1], last)
        return (low, high) if low <= high else (first, last)

    def set_part(self, session: Session, low: int, high: int) -> None:
        """Set the playback range; all frames clear it."""
        first, last = session.time.frames
        low, high = min(max(low, first), last), max(min(high, last), first)
        self.part = None if (min(low, high), max(low, high)) == (first, last) else (min(low, high), max(low, high))

    def course(self, session: Session, every: bool) -> Course:
        """The course to play; graphs with a history cannot drop frames."""
        first, last = self.span(session)
        return Course(first, last, session.root.settings.rate, self.loop, self.every or every)

    def play(self, session: Session, time_now: float, every: bool = False) -> None:
        """Start playback, or stop it."""
        if self.playback.playing:
            self.stop()
        else:
            self.playback.start(self.course(session, every), session.time.frame, time_now)
            session.time.seek(self.playback.frame)

    def stop(self) -> None:
        """Stop at the current frame, and report the speed."""
        self.report = self.playback.words
        self.playback.stop()

    def next_loop(self) -> None:
        """Switch to the next loop mode."""
        self.loop = LOOPS[(LOOPS.index(self.loop) + 1) % len(LOOPS)]

    def visible_range(self, session: Session) -> tuple[float, float]:
        """The frames at the borders of the ruler."""
        first, last = session.time.frames
        if self.view is None:
            return first - 0.5, max(last, first + 1) + 0.5
        return self.view

    def zoom(self, session: Session, frame: float, factor: float) -> None:
        """Zoom about a frame; at most the whole range is visible."""
        low, high = self.visible_range(session)
        first, last = session.time.frames
        widest = max(last - first + 1.0, LEAST_VIEW) * 1.5
        wide = min(max((high - low) / factor, LEAST_VIEW), widest)
        ratio = wide / (high - low)
        self.view = frame + (low - frame) * ratio, frame + (high - frame) * ratio
        if wide >= last - first + 1 and factor < 1.0 and wide >= widest:
            self.view = None

    def pan(self, session: Session, frames: float) -> None:
        """Scroll by some frames; a part of the range always stays visible."""
        if self.view is None:
            return
        low, high = self.view
        first, last = session.time.frames
        by = min(max(frames, first - high + 1.0), last - low - 1.0)
        self.view = low + by, high + by
