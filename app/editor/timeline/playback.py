"""Which frame is due while frames are played, and how well the machine keeps up. Nothing here draws or computes."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from typing import Literal

Loop = Literal["loop", "once", "ping-pong"]
LOOPS: tuple[Loop, ...] = ("loop", "once", "ping-pong")

WINDOW = 1.5
"""Seconds over which the rate is measured."""

FURTHEST = 12
"""Frames that are skipped at most to find one that can be ready in time."""


@dataclass(frozen=True)
class Course:
    """The frames that are played, in which way, and at which rate."""

    first: int
    last: int
    rate: float = 24.0
    loop: Loop = "loop"
    every: bool = False
    """True shows every frame, however long that takes."""

    @property
    def length(self) -> int:
        """How many frames there are."""
        return self.last - self.first + 1

    def at(self, place: int) -> int:
        """The frame at a place of the course, which may be far beyond its end."""
        if self.loop == "once" or self.length == 1:
            return min(max(self.first + place, self.first), self.last)
        if self.loop == "loop":
            return self.first + place % self.length
        way = place % (2 * self.length - 2)
        return self.first + min(way, 2 * self.length - 2 - way)

    def place(self, frame: int) -> int:
        """Where a frame comes first; one outside counts as the first one."""
        return frame - self.first if self.first <= frame <= self.last else 0

    def ends(self, place: int) -> bool:
        """True if nothing comes after."""
        return self.loop == "once" and place >= self.length - 1


@dataclass
class Playback:
    """Playing, or not. Seconds come from outside, so that time can be made up."""

    course: Course | None = None
    dropped: int = 0
    """Frames since the beginning that were not shown because others were late."""
    _place: int = 0
    _origin: tuple[float, int] = (0.0, 0)
    """A second, and the place that was due then."""
    _shown: deque[float] = field(default_factory=deque[float])
    _seen: int | None = None

    @property
    def playing(self) -> bool:
        """True while frames go on by themselves."""
        return self.course is not None

    @property
    def frame(self) -> int:
        """The frame that is shown, or is to be shown as soon as it is ready."""
        return self.course.at(self._place) if self.course else 0

    def start(self, course: Course, frame: int, time_now: float) -> None:
        """Play from a frame on; at the end of what is played once, from its beginning."""
        self.course, self.dropped = course, 0
        self._shown.clear()
        self._seen = None
        place = course.place(frame)
        self._go(0 if course.ends(place) else place, time_now)

    def stop(self) -> None:
        """Stay where it is."""
        self.course = None

    def keep(self, course: Course, frame: int, time_now: float) -> None:
        """Go on with another course, or from another frame, if either has changed."""
        if self.course is None:
            return
        if course != self.course or frame != self.frame:
            self.course = course
            self._go(course.place(frame), time_now)

    def tick(self, time_now: float, busy: bool, under_way: int | None = None) -> int | None:
        """The frame to show now, None if playing has come to its end.

        A frame that is being computed is waited for: for now if `busy`, else `under_way` for later.
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
        """The frame has been shown."""
        if self._seen != self._place:
            self._seen = self._place
            self._shown.append(time_now)
        while self._shown and time_now - self._shown[0] > WINDOW:
            self._shown.popleft()

    def ahead(self, seconds: float) -> int | None:
        """The frame that can be ready when it is due, if one takes so many seconds; None if none is to come."""
        course = self.course
        if course is None or course.ends(self._place):
            return None
        stride = 1 if course.every else min(max(1, math.ceil(seconds * course.rate)), FURTHEST)
        return course.at(self._place + stride)

    @property
    def rate(self) -> float:
        """Frames per second that were really shown, as measured last."""
        if len(self._shown) < 2:
            return 0.0
        took = self._shown[-1] - self._shown[0]
        return (len(self._shown) - 1) / took if took > 0.0 else 0.0

    @property
    def words(self) -> str:
        """How well it goes: `12.4 of 24 fps, 31 dropped`."""
        if self.course is None:
            return ""
        text = f"{self.rate:.1f} of {self.course.rate:g} fps"
        return f"{text}, {self.dropped} dropped" if self.dropped else text

    def _go(self, place: int, time_now: float) -> None:
        self._place, self._origin = place, (time_now, place)
