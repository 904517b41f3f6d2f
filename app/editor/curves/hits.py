"""Where keys and handles are on the screen, and which of them the mouse is at. Nothing here draws."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from ...graph import Animation, Interpolation, Keys, Port
from ..toolkit.plane import Plane, Rect
from .editing import Side, has_handle
from .rows import CurveRow, Lane, Spot, spots_of
from .shapes import Line, level

REACH = 7.0
"""Pixels (at UI scale 1) from the middle of a key at which it can be grabbed."""

SIDES: tuple[Side, Side] = ("left", "right")
_BEYOND = 12.0


class Mark(NamedTuple):
    """A key on the screen, or all keys of a node at a frame. `look` is its shape: none for several."""

    x: float
    y: float
    spots: frozenset[Spot]
    look: Interpolation | None = None
    channel: int = 0


class Tip(NamedTuple):
    """The end of a handle of a key, which is at `root`."""

    x: float
    y: float
    port: Port
    frame: float
    channel: int
    side: Side
    root: tuple[float, float]


M = TypeVar("M", Mark, Tip)
K = TypeVar("K")

Entry = tuple[float, frozenset[Spot], Interpolation | None]
"""A frame, the keys there, and their shape: none for several."""


class Entries:
    """The keys of rows, made once for each animation."""

    def __init__(self) -> None:
        self._known: dict[Port | str, tuple[tuple[Animation | None, ...], tuple[Entry, ...]]] = {}

    def of(self, row: CurveRow, animation: Mapping[Port, Animation]) -> tuple[Entry, ...]:
        """The keys of a value, or of all values of a node."""
        name = row.port or row.node
        made_of = tuple(animation.get(port) for port in row.ports)
        before, found = self._known.get(name, ((), ()))
        if len(before) != len(made_of) or any(a is not b for a, b in zip(before, made_of, strict=True)):
            found = _of_value(row.port, made_of[0]) if row.port else _of_node(row.ports, made_of)
            self._known[name] = made_of, found
        return found


def sheet_marks(
    rows: Sequence[CurveRow],
    animation: Mapping[Port, Animation],
    entries: Entries,
    plane: Plane,
    top: float,
    high: float,
) -> list[list[Mark]]:
    """What is seen of the keys of every row; the first row begins at `top`, each is `high` pixels high."""
    found: list[list[Mark]] = []
    first, last = plane.frame(plane.rect[0] - _BEYOND), plane.frame(plane.rect[2] + _BEYOND)
    start, across = plane.x(0.0), plane.across
    for place, row in enumerate(rows):
        y = top + (place + 0.5) * high
        found.append(
            []
            if y < plane.rect[1] - high or y > plane.rect[3] + high
            else [
                Mark(start + frame * across, y, spots, look)
                for frame, spots, look in entries.of(row, animation)
                if first <= frame <= last
            ]
        )
    return found


def tips(
    animation: Mapping[Port, Animation], spots: Iterable[Spot], hidden: Collection[Lane], plane: Plane
) -> list[Tip]:
    """The handles of chosen keys, where the curve has some."""
    found: list[Tip] = []
    for port, frame, channel in spots:
        keys = animation.get(port)
        if not isinstance(keys, Keys) or (port, channel) in hidden or keys.key(frame) is None:
            continue
        place = keys.frames.index(frame)
        value = level(keys.keys[place], channel)
        for side, handle in zip(SIDES, keys.handles(frame), strict=True):
            if handle and has_handle(keys, place, side):
                found.append(
                    Tip(
                        plane.x(frame + handle[0]),
                        plane.y(value + handle[1 + channel]),
                        port,
                        frame,
                        channel,
                        side,
                        (plane.x(frame), plane.y(value)),
                    )
                )
    return found


def nearest(found: Iterable[M], x: float, y: float, reach: float) -> M | None:
    """The mark or tip that is closest to a point and within reach; of equal ones the last, which is on top."""
    best: M | None = None
    least = reach * reach
    for one in found:
        away = (one.x - x) ** 2 + (one.y - y) ** 2
        if away <= least:
            best, least = one, away
    return best


def boxed(found: Iterable[Mark], box: Rect) -> frozenset[Spot]:
    """All keys with their middle in a rectangle."""
    left, top, right, bottom = min(box[0], box[2]), min(box[1], box[3]), max(box[0], box[2]), max(box[1], box[3])
    spots: set[Spot] = set()
    for mark in found:
        if left <= mark.x <= right and top <= mark.y <= bottom:
            spots |= mark.spots
    return frozenset(spots)


def line_at(lines: Iterable[tuple[K, Line]], x: float, y: float, reach: float) -> K | None:
    """The name of the line on the screen that passes closest to a point, within reach."""
    best: K | None = None
    for name, line in lines:
        if len(line) < 2 or x < line[0, 0] - reach or x > line[-1, 0] + reach:
            continue
        place = int(np.clip(np.searchsorted(line[:, 0], x), 1, len(line) - 1))
        low, high = max(place - 2, 0), min(place + 2, len(line) - 1)
        starts, along = line[low:high], np.diff(line[low : high + 1], axis=0)
        to = np.array((x, y)) - starts
        part = np.clip((to * along).sum(axis=1) / np.maximum((along * along).sum(axis=1), 1e-12), 0.0, 1.0)
        away = float(np.hypot(*(to - along * part[:, None]).T).min())
        if away <= reach:
            best, reach = name, away
    return best


def _of_value(port: Port, animation: Animation | None) -> tuple[Entry, ...]:
    if not isinstance(animation, Keys):
        return ()
    return tuple((key.frame, spots_of(port, animation, (key.frame,)), key.interpolation) for key in animation.keys)


def _of_node(ports: Sequence[Port], animations: Sequence[Animation | None]) -> tuple[Entry, ...]:
    found: dict[float, set[Spot]] = {}
    for port, animation in zip(ports, animations, strict=True):
        for frame, spots, _ in _of_value(port, animation):
            found.setdefault(frame, set()).update(spots)
    return tuple((frame, frozenset(found[frame]), None) for frame in sorted(found))
