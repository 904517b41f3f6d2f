"""Drags in the Animation panel: the edit that follows from their start and the mouse. Nothing here draws."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct

from ...graph import Animation, Keys, Port
from ...graph.keys import round_keys
from ..toolkit.plane import View
from .editing import KeyEdit, Limits, Side, move_keys, pull_handle, scale_keys
from .rows import Spot

Animations = Mapping[Port, Animation]
At = tuple[float, float]
"""A frame and a value."""


class PlotPan(Struct, frozen=True):
    """The view follows the mouse: where that was on the screen, and the view and scrolling then."""

    start: tuple[float, float]
    view: View
    scroll: float


class Seek(Struct, frozen=True):
    """The current frame follows the mouse."""


class KeyBox(Struct, frozen=True):
    """A rectangle from a place (frame, and value or pixels down the rows) to the mouse."""

    start: At
    how: str


class KeyMove(Struct, frozen=True):
    """The selected keys follow the mouse. `grabbed` is the frame of the one that it holds."""

    base: Animations
    spots: frozenset[Spot]
    grabbed: float
    start: At
    merge: str
    started: bool = False
    clicked: frozenset[Spot] | None = None
    """The new selection if the mouse button is released without a move."""

    def change(self, at: At, snap: bool, limits: Limits, *, across: bool = True, up: bool = True) -> KeyEdit:
        """The keys after the gesture; on whole frames if `snap`."""
        by = at[0] - self.start[0] if across else 0.0
        if snap and across:
            by = round_keys(self.grabbed + by) - self.grabbed
        return move_keys(self.base, self.spots, by, at[1] - self.start[1] if up else 0.0, limits)


class KeyScale(Struct, frozen=True):
    """The selected keys are scaled about the frame `about`; the mouse drags the frame `grabbed`."""

    base: Animations
    spots: frozenset[Spot]
    about: float
    grabbed: float
    start: float
    merge: str

    def change(self, frame: float, snap: bool) -> KeyEdit:
        """The keys after the gesture; on whole frames if `snap`."""
        reach = self.grabbed - self.about
        to = self.grabbed + frame - self.start
        if snap:
            to = float(round_keys(to))
        factor = (to - self.about) / reach if abs(reach) > 1e-9 else 1.0
        return scale_keys(self.base, self.spots, factor, self.about, snap)


class HandleDrag(Struct, frozen=True):
    """The end of a handle follows the mouse; `offset` is the distance from it to the mouse at the start."""

    base: Keys
    port: Port
    frame: float
    channel: int
    side: Side
    value: float
    offset: At
    turns_both: bool
    merge: str

    def change(self, at: At, both: bool, flat: bool = False) -> Keys:
        """The keys with that handle; `flat` keeps it level."""
        to = at[0] - self.offset[0] - self.frame, at[1] - self.offset[1] - self.value
        return pull_handle(self.base, self.frame, self.channel, self.side, (to[0], 0.0) if flat else to, both)


Gesture = PlotPan | Seek | KeyBox | KeyMove | KeyScale | HandleDrag
