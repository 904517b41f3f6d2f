"""Where keys and handles are on the screen, and which of them the mouse is at. Nothing here draws."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from ...graph import Animation, Interpolation, Keys, Port
from ..toolkit.plane import Plane, Rect
from .editing import Side, has_handle
from .rows import CurveRow, Lane, Spot, list_spots
from .shapes import Line, read_key_channel

REACH = 7.0
"""Pixels (at UI scale 1) from the middle of a key at which it can be grabbed."""

SIDES: tuple[Side, Side] = ("left", "right")
KEYS_BEYOND = 36.0
"""Pixels beyond the view in which keys are still drawn and hit: their marks are 12 wide, and three times that on the
largest interface."""


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


class EntryCache:
    """The keys of rows, cached until their animation changes."""

    def __init__(self) -> None:
        self._entries: dict[Port | str, tuple[tuple[Animation | None, ...], tuple[Entry, ...]]] = {}

    def list_entries(self, row: CurveRow, animation: Mapping[Port, Animation]) -> tuple[Entry, ...]:
        """The keys of a value, or of all values of a node."""
        name = row.port or row.node
        animations = tuple(animation.get(port) for port in row.ports)
        old_animations, entries = self._entries.get(name, ((), ()))
        if len(old_animations) != len(animations) or any(
            a is not b for a, b in zip(old_animations, animations, strict=True)
        ):
            entries = (
                _list_value_entries(row.port, animations[0]) if row.port else _list_node_entries(row.ports, animations)
            )
            self._entries[name] = animations, entries
        return entries


def find_sheet_marks(
    rows: Sequence[CurveRow],
    animation: Mapping[Port, Animation],
    entries: EntryCache,
    plane: Plane,
    top: float,
    high: float,
) -> list[list[Mark]]:
    """The visible keys of every row; the first row begins at `top`, each is `high` pixels high."""
    marks_by_row: list[list[Mark]] = []
    first, last = plane.frame(plane.rect[0] - KEYS_BEYOND), plane.frame(plane.rect[2] + KEYS_BEYOND)
    start, across = plane.x(0.0), plane.across
    for place, row in enumerate(rows):
        y = top + (place + 0.5) * high
        marks_by_row.append(
            []
            if y < plane.rect[1] - high or y > plane.rect[3] + high
            else [
                Mark(start + frame * across, y, spots, look)
                for frame, spots, look in entries.list_entries(row, animation)
                if first <= frame <= last
            ]
        )
    return marks_by_row


def find_tips(
    animation: Mapping[Port, Animation], spots: Iterable[Spot], hidden: Collection[Lane], plane: Plane
) -> list[Tip]:
    """The handles of the selected keys, where the curve has handles."""
    handle_tips: list[Tip] = []
    for port, frame, channel in spots:
        keys = animation.get(port)
        if not isinstance(keys, Keys) or (port, channel) in hidden or keys.key(frame) is None:
            continue
        place = keys.frames.index(frame)
        value = read_key_channel(keys.keys[place], channel)
        for side, handle in zip(SIDES, keys.handles(frame), strict=True):
            if handle and has_handle(keys, place, side):
                handle_tips.append(
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
    return handle_tips


def find_nearest(candidates: Iterable[M], x: float, y: float, reach: float) -> M | None:
    """The mark or tip that is closest to a point and within reach; of equal ones the last, which is on top."""
    best: M | None = None
    min_distance = reach * reach
    for candidate in candidates:
        distance = (candidate.x - x) ** 2 + (candidate.y - y) ** 2
        if distance <= min_distance:
            best, min_distance = candidate, distance
    return best


def find_spots_in_box(marks: Iterable[Mark], box: Rect) -> frozenset[Spot]:
    """All keys with their middle in a rectangle."""
    left, top, right, bottom = min(box[0], box[2]), min(box[1], box[3]), max(box[0], box[2]), max(box[1], box[3])
    spots: set[Spot] = set()
    for mark in marks:
        if left <= mark.x <= right and top <= mark.y <= bottom:
            spots |= mark.spots
    return frozenset(spots)


def find_line(lines: Iterable[tuple[K, Line]], x: float, y: float, reach: float) -> K | None:
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
        distance = float(np.hypot(*(to - along * part[:, None]).T).min())
        if distance <= reach:
            best, reach = name, distance
    return best


def _list_value_entries(port: Port, animation: Animation | None) -> tuple[Entry, ...]:
    if not isinstance(animation, Keys):
        return ()
    return tuple((key.frame, list_spots(port, animation, (key.frame,)), key.interpolation) for key in animation.keys)


def _list_node_entries(ports: Sequence[Port], animations: Sequence[Animation | None]) -> tuple[Entry, ...]:
    spots_by_frame: dict[float, set[Spot]] = {}
    for port, animation in zip(ports, animations, strict=True):
        for frame, spots, _ in _list_value_entries(port, animation):
            spots_by_frame.setdefault(frame, set()).update(spots)
    return tuple((frame, frozenset(spots_by_frame[frame]), None) for frame in sorted(spots_by_frame))
