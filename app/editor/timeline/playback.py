"""Playback: which frame is due, and how well the machine keeps up. Nothing here draws or renders."""

from __future__ import annotations

import math
from collections import deque
from typing import Literal

from msgspec import Struct, field

Loop = Literal["loop", "once", "ping-pong"]
LOOPS: tuple[Loop, ...] = ("loop", "once", "ping-pong")

WINDOW = 1.5
"""Seconds over which the rate is measured: long enough for a steady number."""

FURTHEST = 12
"""The most frames that are skipped to find one that can be ready in time: half a second at 24 fps."""


class Course(Struct, frozen=True):
    """The frames to play, how they loop, and the frame rate."""

    first: int
    last: int
    rate: float = 24.0
    loop: Loop = "loop"
    every: bool = False
    """True shows every frame, even if playback is slower."""

    @property
    def length(self) -> int:
        """The number of frames."""
        return self.last - self.first + 1

    def at(self, place: int) -> int:
        """The frame at a step of the course; steps go on beyond the end."""
        if self.loop == "once" or self.length == 1:
            return min(max(self.first + place, self.first), self.last)
        if self.loop == "loop":
            return self.first + place % self.length
        step = place % (2 * self.length - 2)
        return self.first + min(step, 2 * self.length - 2 - step)

    def place(self, frame: int) -> int:
        """The first step that shows a frame; 0 for a frame outside of the course."""
        return frame - self.first if self.first <= frame <= self.last else 0

    def ends(self, place: int) -> bool:
        """True if the course is over at a step."""
        return self.loop == "once" and place >= self.length - 1


class Playback(Struct):
    """The state of playback. Times are passed in, so that tests need no clock."""

    course: Course | None = None
    dropped: int = 0
    """The frames that were dropped since the start, because others were late."""
    _place: int = 0
    _origin: tuple[float, int] = (0.0, 0)
    """A time in seconds, and the step that was due then."""
    _shown: deque[float] = field(default_factory=deque[float])
    _seen: int | None = None

    @property
    def playing(self) -> bool:
        """True while playing."""
        return self.course is not None

    @property
    def frame(self) -> int:
        """The frame that is shown, or will be as soon as it is ready."""
        return self.course.at(self._place) if self.course else 0

    def start(self, course: Course, frame: int, time_now: float) -> None:
        """Start to play at a frame; at the last frame of a course that plays once, from its start."""
        self.course, self.dropped = course, 0
        self._shown.clear()
        self._seen = None
        place = course.place(frame)
        self._go(0 if course.ends(place) else place, time_now)

    def stop(self) -> None:
        """Stop at the current frame."""
        self.course = None

    def keep(self, course: Course, frame: int, time_now: float) -> None:
        """Continue with a changed course, or from another frame."""
        if self.course is None:
            return
        if course != self.course or frame != self.frame:
            self.course = course
            self._go(course.place(frame), time_now)

    def tick(self, time_now: float, busy: bool, under_way: int | None = None) -> int | None:
        """The frame to show now, None if playback has ended.

        A frame that is being computed is waited for: for now if `busy`, else `under_way` for later. If every frame is
        shown, a late one moves the start of the clock, so that the next ones are not hurried; else frames that are late
        are dropped and counted.
        """
        course = self.course
        if course is None:
            return None
        if busy:
            return self.frame
        if course.ends(self._place):
            self.stop()
            return None
        due = self._origin[1] + math.floor((time_now - self._origin[0]) * course.rate + 1e-6)
        if due <= self._place:
            return self.frame
        place = self._place + 1 if course.every else due
        if under_way is not None:
            near = range(self._place + 1, self._place + 1 + FURTHEST)
            coming = next((at for at in near if course.at(at) == under_way), place)
            if coming > due:
                return self.frame
            place = coming if not course.every else place
        if course.loop == "once":
            place = min(place, course.length - 1)
        self.dropped += place - self._place - 1
        if course.every and due > place:
            self._go(place, time_now)
        self._place = place
        return self.frame

    def note(self, time_now: float) -> None:
        """Note that a frame was shown."""
        if self._seen != self._place:
            self._seen = self._place
            self._shown.append(time_now)
        while self._shown and time_now - self._shown[0] > WINDOW:
            self._shown.popleft()

    def ahead(self, seconds: float) -> int | None:
        """The next frame that can be ready when it is due, if one takes `seconds`; None if there is none."""
        course = self.course
        if course is None or course.ends(self._place):
            return None
        stride = 1 if course.every else min(max(1, math.ceil(seconds * course.rate)), FURTHEST)
        return course.at(self._place + stride)

    @property
    def rate(self) -> float:
        """The measured frames per second."""
        if len(self._shown) < 2:
            return 0.0
        took = self._shown[-1] - self._shown[0]
        return (len(self._shown) - 1) / took if took > 0.0 else 0.0

    @property
    def words(self) -> str:
        """The speed of playback as text: `12.4 of 24 fps, 31 dropped`."""
        if self.course is None:
            return ""
        text = f"{self.rate:.1f} of {self.course.rate:g} fps"
        return f"{text}, {self.dropped} dropped" if self.dropped else text

    def _go(self, place: int, time_now: float) -> None:
        self._place, self._origin = place, (time_now, place)
