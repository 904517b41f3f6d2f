"""The plane of frames and values: the visible part, its place on the screen, and ticks. Nothing here draws."""

from __future__ import annotations

import math

from msgspec import Struct
from msgspec.structs import replace

_NO_SPAN = 1e-9
"""A span of values that is 0 but for rounding: it has no share."""

Rect = tuple[float, float, float, float]
"""Left, top, right, bottom in pixels."""

_FRAMES = 0.5, 1e6
_VALUES = 1e-6, 1e9
"""The least and the largest span of a view: half a frame to the longest list of frames; what floats of 32 bits tell."""

_BESIDE, _ABOVE = 0.05, 0.14
"""The margins around what is fitted into view, as fractions of it."""


class View(Struct, frozen=True):
    """The frames and values at the borders of the panel."""

    first: float = 0.0
    last: float = 25.0
    low: float = -0.1
    high: float = 1.1

    def pan(self, frames: float, values: float) -> View:
        """The view, moved by some frames and values."""
        return View(self.first + frames, self.last + frames, self.low + values, self.high + values)

    def zoom(self, frame: float, value: float, across: float, up: float) -> View:
        """The view, zoomed about a place."""
        first, last = _spread(self.first, self.last, frame, across, _FRAMES)
        low, high = _spread(self.low, self.high, value, up, _VALUES)
        return View(first, last, low, high)

    def fit(self, frames: tuple[float, float] | None, values: tuple[float, float] | None) -> View:
        """The view that shows these frames and values with a margin; None leaves an axis as it is."""
        view = self
        if frames:
            first, last = _roomy(*frames, _BESIDE, 1.0)
            view = replace(view, first=first, last=last)
        if values:
            low, high = _roomy(*values, _ABOVE, max(abs(values[0]), 1.0) * 0.5)
            view = replace(view, low=low, high=high)
        return view


class Plane(Struct, frozen=True):
    """A view on a rectangle of the screen; values grow upwards."""

    view: View
    rect: Rect

    @property
    def across(self) -> float:
        """Pixels per frame."""
        return max(self.rect[2] - self.rect[0], 1.0) / (self.view.last - self.view.first)

    @property
    def up(self) -> float:
        """Pixels per unit of a value."""
        return max(self.rect[3] - self.rect[1], 1.0) / (self.view.high - self.view.low)

    def x(self, frame: float) -> float:
        """Where a frame is on the screen."""
        return self.rect[0] + (frame - self.view.first) * self.across

    def y(self, value: float) -> float:
        """Where a value is on the screen."""
        return self.rect[3] - (value - self.view.low) * self.up

    def frame(self, x: float) -> float:
        """The frame at a place of the screen."""
        return self.view.first + (x - self.rect[0]) / self.across

    def value(self, y: float) -> float:
        """The value at a place of the screen."""
        return self.view.low + (self.rect[3] - y) / self.up


class Tick(Struct, frozen=True):
    """A line of a grid; a small one has no label."""

    at: float
    label: str = ""


def step(scale: float, apart: float, whole: bool = False) -> float:
    """The least of 1, 2, 5, 10, ... (or 0.1, 0.2, ...) that is at least `apart` pixels, at `scale` pixels per unit."""
    least = max(apart / scale, 1.0 if whole else 0.0)
    power = 10.0 ** math.floor(math.log10(least))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= least * (1.0 - 1e-9))


def ticks(low: float, high: float, scale: float, apart: float, whole: bool = False) -> list[Tick]:
    """Labelled lines at least `apart` pixels from each other, and small ones between where there is room."""
    large = step(scale, apart, whole)
    digits = max(0, -math.floor(math.log10(large) + 1e-9))
    small = large / (2.0 if round(large / 10.0 ** math.floor(math.log10(large) + 1e-9)) == 2 else 5.0)
    if small * scale < 8.0 or (whole and small < 1.0):
        small = large
    parts = round(large / small)
    marks: list[Tick] = []
    for place in range(math.ceil(low / small - 1e-9), math.floor(high / small + 1e-9) + 1):
        at = place * small
        text = "" if place % parts else f"{at:.{digits}f}" if abs(at) < 1e7 else f"{at:g}"
        marks.append(Tick(at, text.removeprefix("-") if at == 0.0 else text))
    return marks


def _spread(low: float, high: float, about: float, factor: float, limits: tuple[float, float]) -> tuple[float, float]:
    if factor == 1.0:
        return low, high
    width = min(max((high - low) / factor, limits[0]), limits[1])
    ratio = width / (high - low)
    return about + (low - about) * ratio, about + (high - about) * ratio


def _roomy(low: float, high: float, share: float, least: float) -> tuple[float, float]:
    room = (high - low) * share if high - low > _NO_SPAN else least
    return low - room, high + room
