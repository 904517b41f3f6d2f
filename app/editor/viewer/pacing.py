"""Chooses the proxy while the user drags a value, so that pictures keep up with the mouse."""

from __future__ import annotations

from msgspec import Struct

SLOW = 0.060
"""Seconds per picture above which the next one is coarser: below 15 pictures a second a drag feels slow."""

EASY = 0.035
"""Seconds per picture that a finer scale must promise before it is used again."""

COARSEST = 0.25
"""The coarsest scale, as a fraction of the chosen proxy."""

OVERDUE = 0.5
"""Seconds after which a picture counts as slow even if it is not there yet."""


def coarsen_scale(finest: float, scale: float, seconds: float) -> float:
    """The scale for the next picture of a drag, when one at `scale` took `seconds`; `finest` is what was asked for."""
    while seconds > SLOW and scale > finest * COARSEST:
        scale, seconds = scale / 2.0, seconds / 4.0
    return scale


def choose_start_scale(finest: float, scale: float, seconds: float) -> float:
    """The scale for a new drag, when the last one ended at `scale` and pictures of the chosen proxy take `seconds`."""
    part = scale / finest
    while part < 1.0 and seconds * (2.0 * part) ** 2 <= EASY:
        part *= 2.0
    return coarsen_scale(finest, finest * part, seconds * part * part)


class Pace(Struct):
    """The scale of pictures over time: coarser while dragging is slow, the chosen one as soon as it is over.

    Within one drag it only falls, so that the picture does not flicker between scales.
    """

    scale: float = 1.0
    """The scale of the drag, now or last."""
    seconds: float = 0.0
    """How long all of a picture of the chosen proxy takes, as measured or guessed last."""
    _finest: float = 1.0
    _dragging: bool = False

    def at(self, finest: float, dragging: bool, share: float = 1.0) -> float:
        """The scale to render at now; `share` is the part of the picture that will be waited for."""
        if finest != self._finest:
            self.seconds *= (finest / self._finest) ** 2
            self.scale *= finest / self._finest
            self._finest = finest
        if dragging and not self._dragging:
            self.scale = choose_start_scale(finest, self.scale, self.seconds * share)
        self._dragging = dragging
        return self.scale if dragging else finest

    def took(self, scale: float, seconds: float, share: float = 1.0) -> None:
        """Note that a picture at `scale`, or a part of it, took `seconds`."""
        self.seconds = seconds * (self._finest / scale) ** 2 / share
        if self._dragging and scale == self.scale:
            self.scale = coarsen_scale(self._finest, scale, seconds)


class PictureTimer(Struct):
    """Measures how long pictures take, from what is shown in each frame of the window."""

    _started: float | None = None
    _key: str = ""

    def lap(self, busy: bool, key: str, time_now: float) -> float | None:
        """The seconds of the last picture, once it is shown, complete or overdue."""
        if self._started is None:
            self._started, self._key = (time_now if busy else None), key
            return None
        seconds = time_now - self._started
        if busy and key == self._key and seconds < OVERDUE:
            return None
        self._started, self._key = (time_now if busy else None), key
        return seconds
