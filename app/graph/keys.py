"""Animation keys: values at frames, the interpolation between them, and their edits.

- `constant` holds the value until the next key; `linear` is a straight line.
- `smooth` is the monotone cubic of Fritsch and Carlson (1980) with the slopes of Fritsch and Butland (1984), as scipy's
  PchipInterpolator: the curve never overshoots a key. Its slope is 0 at the first and the last key, and at a key next
  to a constant segment.
- `bezier` is a cubic in (frame, value) with the handles of both keys. See `bezier.py`.

Booleans are always held. Vectors and colors are interpolated channel by channel. Integers are interpolated as floats:
the caller rounds.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Literal

from halation.nodes import Scalar
from msgspec import Struct
from msgspec.structs import force_setattr, replace

from ..errors import GraphError
from . import bezier

Interpolation = Literal["constant", "linear", "smooth", "bezier"]
Extrapolation = Literal["hold", "linear", "loop", "mirror"]

_DECIMALS = 6
"""Moved and scaled frames are rounded to these decimals, so that keys that look equal are equal."""


class Key(Struct, frozen=True, dict=True):
    """A value at a frame. `interpolation` is that of the segment from this key to the next.

    `left` and `right` are the handles of `bezier`: offsets from the key, in frames and then in each channel. An empty
    handle is automatic: a third of the segment long, along the slope of `smooth`. Raises GraphError unless the frame is
    finite.
    """

    frame: float
    value: Scalar
    interpolation: Interpolation = "smooth"
    left: tuple[float, ...] = ()
    right: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not math.isfinite(self.frame):
            raise GraphError(f"a key cannot be at frame {self.frame}")

    @cached_property
    def channels(self) -> tuple[float, ...]:
        """The channels of the value; empty for a value that cannot be interpolated."""
        if isinstance(self.value, bool | str):
            return ()
        return self.value if isinstance(self.value, tuple) else (float(self.value),)

    def handle(self, side: Literal["left", "right"]) -> tuple[float, ...]:
        """The handle of a side, if it is set and fits the value; else empty."""
        handle = self.left if side == "left" else self.right
        return handle if len(handle) == 1 + len(self.channels) else ()


class Keys(Struct, frozen=True, dict=True):
    """Keys in the order of their frames; of two keys at one frame the later one is kept.

    `outside` is the extrapolation before the first and after the last key: hold the value, continue in a line, loop the
    curve, or mirror it.
    """

    keys: tuple[Key, ...] = ()
    outside: Extrapolation = "hold"

    def __post_init__(self) -> None:
        force_setattr(self, "keys", _sort_keys(self.keys))

    @cached_property
    def frames(self) -> tuple[float, ...]:
        """The frames of the keys."""
        return tuple(key.frame for key in self.keys)

    def key(self, frame: float) -> Key | None:
        """The key at exactly this frame, or None."""
        place = bisect_right(self.frames, frame) - 1
        return self.keys[place] if place >= 0 and self.frames[place] == frame else None

    def evaluate(self, frame: float) -> Scalar:
        """The value at a frame. Raises GraphError if there are no keys."""
        if not self.keys:
            raise GraphError("there are no keys")
        first, last = self.frames[0], self.frames[-1]
        if first <= frame <= last or len(self.keys) == 1 or self.outside == "hold":
            return self._interpolate(frame)
        if self.outside == "linear":
            return self._extrapolate_linearly(frame)
        span = last - first
        if self.outside == "loop":
            return self._interpolate(first + (frame - first) % span)
        offset = (frame - first) % (2.0 * span)
        return self._interpolate(first + min(offset, 2.0 * span - offset))

    def slopes(self, frame: float) -> tuple[float, ...]:
        """The slopes of `smooth` in each channel at the key of a frame, which are those of automatic handles."""
        place = self.frames.index(frame)
        return tuple(self._slope(place, channel) for channel in range(len(self.keys[place].channels)))

    def handles(self, frame: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The handles of the key at a frame as the curve uses them: automatic ones too, limited to their segments.

        The left handle of the first key and the right one of the last are empty.
        """
        place = self.frames.index(frame)
        left = self._segment_handles(place - 1)[1] if place > 0 else ()
        return left, self._segment_handles(place)[0] if place + 1 < len(self.keys) else ()

    def set(self, frame: float, value: Scalar, interpolation: Interpolation | None = None) -> Keys:
        """The keys with a value set at a frame.

        An existing key keeps its interpolation and handles; a new one takes the interpolation of the key before it.
        """
        existing_key = self.key(frame)
        if existing_key is not None:
            key = replace(existing_key, value=value, interpolation=interpolation or existing_key.interpolation)
            return self._with((key,))
        place = max(bisect_right(self.frames, frame) - 1, 0)
        default_interpolation: Interpolation = "constant" if isinstance(value, bool | str) else "smooth"
        interpolation_before = self.keys[place].interpolation if self.keys else default_interpolation
        return self._with((Key(frame, value, interpolation or interpolation_before),))

    def insert(self, frame: float) -> Keys:
        """The keys with a new key on the curve at a frame. A `bezier` segment is split, so that its shape stays."""
        place = bisect_right(self.frames, frame) - 1
        is_between_keys = 0 <= place < len(self.keys) - 1 and self.frames[place] < frame
        if not is_between_keys or self.keys[place].interpolation != "bezier" or not self._is_interpolated(place):
            return self if self.key(frame) else self.set(frame, self.evaluate(frame))
        start, end = self.keys[place : place + 2]
        outer, left, middle, right, inward = bezier.split(*self._segment(place), frame)
        key = replace(start, frame=frame, value=self._join_channels(middle), left=left, right=right)
        return self._with((replace(start, right=outer), key, replace(end, left=inward)))

    def remove(self, *frames: float) -> Keys:
        """The keys without those at some frames."""
        return replace(self, keys=tuple(key for key in self.keys if key.frame not in frames))

    def move(self, frames: Iterable[float] | None, by: float, lift: Scalar = 0.0) -> Keys:
        """The keys with those at `frames` (None: all) moved by `by` frames and `lift` added to their values.

        A moved key replaces another at its new frame. `lift` is one number, or one per channel.
        """

        def move_key(key: Key) -> Key:
            return replace(key, frame=round(key.frame + by, _DECIMALS), value=_lift_value(key, lift))

        return self._change_keys(frames, move_key)

    def scale(self, frames: Iterable[float] | None, factor: float, about: float, whole: bool = False) -> Keys:
        """The keys with those at `frames` (None: all) and their handles scaled in time around the frame `about`.

        `whole` rounds to whole frames. A moved key replaces another at its new frame. Raises GraphError unless the
        factor is positive.
        """
        if not (factor > 0.0 and math.isfinite(factor)):
            raise GraphError(f"keys cannot be scaled by {factor:g}: give a factor above 0")

        def scale_key(key: Key) -> Key:
            frame = about + (key.frame - about) * factor
            left, right = ((side[0] * factor, *side[1:]) if side else () for side in (key.left, key.right))
            place = float(round_keys(frame)) if whole else round(frame, _DECIMALS)
            return replace(key, frame=place, left=left, right=right)

        return self._change_keys(frames, scale_key)

    def with_interpolation(self, frames: Iterable[float] | None, interpolation: Interpolation) -> Keys:
        """The keys with another interpolation of those at `frames` (None: all)."""
        return self._change_keys(frames, lambda key: replace(key, interpolation=interpolation))

    def with_handles(
        self, frame: float, left: tuple[float, ...] | None = None, right: tuple[float, ...] | None = None
    ) -> Keys:
        """The keys with other handles of the key at a frame: None keeps a handle, an empty one makes it automatic.

        Raises GraphError if there is no key, or unless a handle has one number for the frames and one per channel.
        """
        key = self.key(frame)
        if key is None:
            raise GraphError(f"there is no key at frame {frame:g}")
        for handle in (left, right):
            if handle and not (len(handle) == 1 + len(key.channels) and all(map(math.isfinite, handle))):
                raise GraphError(
                    f"the key at frame {frame:g} takes {1 + len(key.channels)} finite numbers for a handle"
                )
        return self._with(
            (replace(key, left=key.left if left is None else left, right=key.right if right is None else right),)
        )

    def _with(self, keys: Iterable[Key]) -> Keys:
        return replace(self, keys=(*self.keys, *keys))

    def _change_keys(self, frames: Iterable[float] | None, change: Callable[[Key], Key]) -> Keys:
        chosen = set(self.frames if frames is None else frames)
        other_keys = [key for key in self.keys if key.frame not in chosen]
        return replace(self, keys=(*other_keys, *(change(key) for key in self.keys if key.frame in chosen)))

    def _interpolate(self, frame: float) -> Scalar:
        """The value at a frame; outside of the keys that of the nearest key."""
        place = bisect_right(self.frames, frame) - 1
        if place < 0:
            return self._key_value(0)
        if place + 1 == len(self.keys) or self.frames[place] == frame or not self._is_interpolated(place):
            return self._key_value(place)
        start, end = self.keys[place], self.keys[place + 1]
        if start.interpolation == "bezier":
            return self._join_channels(bezier.evaluate(*self._segment(place), frame))
        width = end.frame - start.frame
        u = (frame - start.frame) / width
        if start.interpolation == "linear":
            return self._join_channels(
                tuple(a + (b - a) * u for a, b in zip(start.channels, end.channels, strict=True))
            )
        return self._join_channels(
            tuple(
                _hermite(u, a, b, width * self._slope(place, channel), width * self._slope(place + 1, channel))
                for channel, (a, b) in enumerate(zip(start.channels, end.channels, strict=True))
            )
        )

    def _extrapolate_linearly(self, frame: float) -> Scalar:
        """The value outside of the keys, in a line along the slope of the nearest end."""
        after = frame > self.frames[-1]
        place, segment = (len(self.keys) - 1, len(self.keys) - 2) if after else (0, 0)
        if not self._is_interpolated(segment):
            return self._key_value(place)
        start, end = self.keys[segment : segment + 2]
        if start.interpolation == "bezier":
            slopes = bezier.end_slopes(*self._segment(segment), last_end=after)
        elif start.interpolation == "linear":
            slopes = tuple(
                (b - a) / (end.frame - start.frame) for a, b in zip(start.channels, end.channels, strict=True)
            )
        else:
            slopes = self.slopes(self.frames[place])
        distance = frame - self.frames[place]
        return self._join_channels(
            tuple(a + slope * distance for a, slope in zip(self.keys[place].channels, slopes, strict=True))
        )

    def _is_interpolated(self, place: int) -> bool:
        """True if the segment after the key at an index is interpolated, not held."""
        key = self.keys[place]
        return key.interpolation != "constant" and 0 < len(key.channels) == len(self.keys[place + 1].channels)

    def _segment(self, place: int) -> bezier.Segment:
        """The four points (frame, channels) of the Bezier segment after the key at an index."""
        start, end = self.keys[place], self.keys[place + 1]
        first, last = (start.frame, *start.channels), (end.frame, *end.channels)
        return bezier.limit_handles(first, last, *self._segment_handles(place, limit=False))

    def _segment_handles(self, place: int, limit: bool = True) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The right handle of the key at an index and the left handle of the next key."""
        start, end = self.keys[place], self.keys[place + 1]
        third = (end.frame - start.frame) / 3.0
        right = start.handle("right") or (third, *(third * slope for slope in self.slopes(start.frame)))
        left = end.handle("left") or (-third, *(-third * slope for slope in self.slopes(end.frame)))
        if limit and len(right) == len(left):
            _, right_point, left_point, _ = bezier.limit_handles(
                (start.frame, *start.channels), (end.frame, *end.channels), right, left
            )
            return (
                tuple(b - a for a, b in zip((start.frame, *start.channels), right_point, strict=True)),
                tuple(b - a for a, b in zip((end.frame, *end.channels), left_point, strict=True)),
            )
        return right, left

    def _slope(self, place: int, channel: int) -> float:
        """The slope of `smooth` at a key; 0 unless the segments on both sides are interpolated."""
        back = place > 0 and self._is_interpolated(place - 1)
        ahead = place + 1 < len(self.keys) and self._is_interpolated(place)
        return (
            _limit_slope(*self._straight_slope(place - 1, channel), *self._straight_slope(place, channel))
            if back and ahead
            else 0.0
        )

    def _straight_slope(self, place: int, channel: int) -> tuple[float, float]:
        """The frames from a key to the next, and the slope of the straight line between them."""
        start, end = self.keys[place], self.keys[place + 1]
        width = end.frame - start.frame
        return width, (end.channels[channel] - start.channels[channel]) / width

    def _key_value(self, place: int) -> Scalar:
        key = self.keys[place]
        return self._join_channels(key.channels) if key.channels else key.value

    def _join_channels(self, parts: tuple[float, ...]) -> Scalar:
        """The value that has these channels: a tuple, or a single number."""
        return parts if isinstance(self.keys[0].value, tuple) else parts[0]


def round_keys(number: float) -> int:
    """The nearest integer; halves are rounded away from zero."""
    down = math.floor(abs(number))
    away = down + (abs(number) - down >= 0.5)
    return -away if number < 0 else away


def _sort_keys(keys: Iterable[Key]) -> tuple[Key, ...]:
    keys_by_frame = {key.frame: key for key in keys}
    return tuple(keys_by_frame[frame] for frame in sorted(keys_by_frame))


def _lift_value(key: Key, lift: Scalar) -> Scalar:
    if not key.channels or isinstance(lift, bool | str):
        return key.value
    lifts = lift if isinstance(lift, tuple) else (lift,) * len(key.channels)
    if len(lifts) != len(key.channels):
        raise GraphError(f"{len(lifts)} numbers cannot be added to a value of {len(key.channels)}")
    parts = tuple(part + more for part, more in zip(key.channels, lifts, strict=True))
    if isinstance(key.value, tuple):
        return parts
    return round_keys(parts[0]) if isinstance(key.value, int) else parts[0]


def _hermite(u: float, start: float, end: float, rise: float, fall: float) -> float:
    """The Hermite cubic from `start` to `end` with slopes `rise` and `fall`, at `u` from 0 to 1."""
    v = 1.0 - u
    return start * v * v * (1.0 + 2.0 * u) + end * u * u * (1.0 + 2.0 * v) + rise * u * v * v - fall * u * u * v


def _limit_slope(width: float, slope: float, next_width: float, next_slope: float) -> float:
    """The slope of Fritsch and Butland at a key: the weighted harmonic mean of those beside it, 0 at an extremum."""
    if slope == 0.0 or next_slope == 0.0 or (slope > 0.0) != (next_slope > 0.0):
        return 0.0
    weight, next_weight = 2.0 * next_width + width, next_width + 2.0 * width
    return (weight + next_weight) / (weight / slope + next_weight / next_slope)
