"""Keys: what a value is at some frames, how it goes from each to the next, and the edits that a dope sheet needs.

- `constant` holds the value up to the next key, `linear` goes straight.
- `smooth` is the monotone cubic of Fritsch and Carlson (1980) with the slopes of Fritsch and Butland (1984), as scipy's
  PchipInterpolator: nothing overshoots a key. It eases in at the first key and out at the last. Frames that are held
  take no part.
- `bezier` is a cubic in (frame, value) through the handles of both keys. See `bezier.py`.

Booleans are always held; vectors and colors go channel by channel. Between whole numbers are numbers: whoever wants a
whole one rounds.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

from halation.nodes import Plain

from ..errors import GraphError
from . import bezier

Interpolation = Literal["constant", "linear", "smooth", "bezier"]
Outside = Literal["hold", "linear", "loop", "mirror"]

_DECIMALS = 6
"""Frames that were moved or scaled are rounded to that, so that keys meet where they look as if they did."""


@dataclass(frozen=True)
class Key:
    """A value at a frame. `interpolation` says how it goes from here to the next key.

    `left` and `right` are the handles of `bezier`: offsets from the key, in frames and then in every channel. An empty
    one is automatic: a third of the way along the slope of `smooth`. Raises GraphError unless the frame is finite.
    """

    frame: float
    value: Plain
    interpolation: Interpolation = "smooth"
    left: tuple[float, ...] = ()
    right: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not math.isfinite(self.frame):
            raise GraphError(f"a key cannot be at frame {self.frame}")

    @cached_property
    def parts(self) -> tuple[float, ...]:
        """The channels of the value; none of what can only be held."""
        if isinstance(self.value, bool | str):
            return ()
        return self.value if isinstance(self.value, tuple) else (float(self.value),)

    def handle(self, side: Literal["left", "right"]) -> tuple[float, ...]:
        """The handle of that side, if one was set that fits the value."""
        given = self.left if side == "left" else self.right
        return given if len(given) == 1 + len(self.parts) else ()


@dataclass(frozen=True)
class Keys:
    """Keys in the order of their frames, the later of two at one frame, and what comes before and after them.

    `outside` holds the ends, goes on straight, or repeats what lies between the ends: over and over, or to and fro.
    """

    keys: tuple[Key, ...] = field(default=())
    outside: Outside = "hold"

    def __post_init__(self) -> None:
        object.__setattr__(self, "keys", _sort_keys(self.keys))

    @cached_property
    def frames(self) -> tuple[float, ...]:
        """The frames of the keys."""
        return tuple(key.frame for key in self.keys)

    def key(self, frame: float) -> Key | None:
        """The key at exactly that frame."""
        place = bisect_right(self.frames, frame) - 1
        return self.keys[place] if place >= 0 and self.frames[place] == frame else None

    def at(self, frame: float) -> Plain:
        """The value at a frame. Raises GraphError if there are no keys."""
        if not self.keys:
            raise GraphError("there are no keys")
        first, last = self.frames[0], self.frames[-1]
        if first <= frame <= last or len(self.keys) == 1 or self.outside == "hold":
            return self._inside(frame)
        if self.outside == "linear":
            return self._beyond(frame)
        span = last - first
        if self.outside == "loop":
            return self._inside(first + (frame - first) % span)
        way = (frame - first) % (2.0 * span)
        return self._inside(first + min(way, 2.0 * span - way))

    def slopes(self, frame: float) -> tuple[float, ...]:
        """The slope of `smooth` in every channel at the key of that frame: where an automatic handle points."""
        place = self.frames.index(frame)
        return tuple(self._slope(place, channel) for channel in range(len(self.keys[place].parts)))

    def handles(self, frame: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The handles of the key at that frame as the curve uses them: automatic ones too, within their segments.

        The handle towards no other key is empty.
        """
        place = self.frames.index(frame)
        left = self._arms(place - 1)[1] if place > 0 else ()
        return left, self._arms(place)[0] if place + 1 < len(self.keys) else ()

    def set(self, frame: float, value: Plain, interpolation: Interpolation | None = None) -> Keys:
        """With that value at that frame.

        A key that is there keeps interpolation and handles; a new one takes the interpolation of the one before.
        """
        there = self.key(frame)
        if there is not None:
            key = replace(there, value=value, interpolation=interpolation or there.interpolation)
            return self._with((key,))
        place = max(bisect_right(self.frames, frame) - 1, 0)
        usual: Interpolation = "constant" if isinstance(value, bool | str) else "smooth"
        near = self.keys[place].interpolation if self.keys else usual
        return self._with((Key(frame, value, interpolation or near),))

    def insert(self, frame: float) -> Keys:
        """With a key on the curve at that frame. A `bezier` keeps its shape: all its handles are set for that."""
        place = bisect_right(self.frames, frame) - 1
        inner = 0 <= place < len(self.keys) - 1 and self.frames[place] < frame
        if not inner or self.keys[place].interpolation != "bezier" or not self._runs(place):
            return self if self.key(frame) else self.set(frame, self.at(frame))
        start, end = self.keys[place : place + 2]
        outer, left, middle, right, inward = bezier.split(*self._segment(place), frame)
        key = replace(start, frame=frame, value=self._plain(middle), left=left, right=right)
        return self._with((replace(start, right=outer), key, replace(end, left=inward)))

    def remove(self, *frames: float) -> Keys:
        """Without the keys at those frames."""
        return replace(self, keys=tuple(key for key in self.keys if key.frame not in frames))

    def move(self, frames: Iterable[float] | None, by: float, lift: Plain = 0.0) -> Keys:
        """With the keys at those frames (None: all) so many frames later, and so much higher.

        Keys that stay where one arrives are replaced. `lift` is one number or one for every channel.
        """

        def there(key: Key) -> Key:
            return replace(key, frame=round(key.frame + by, _DECIMALS), value=_lifted(key, lift))

        return self._changed(frames, there)

    def scale(self, frames: Iterable[float] | None, factor: float, about: float, whole: bool = False) -> Keys:
        """With the keys at those frames (None: all) `factor` times as far from the frame `about`, handles too.

        `whole` puts them on whole frames. Keys that stay where one arrives are replaced. Raises GraphError unless the
        factor is positive.
        """
        if not (factor > 0.0 and math.isfinite(factor)):
            raise GraphError(f"keys cannot be scaled by {factor:g}: the factor is above 0")

        def there(key: Key) -> Key:
            frame = about + (key.frame - about) * factor
            left, right = ((side[0] * factor, *side[1:]) if side else () for side in (key.left, key.right))
            place = float(round_keys(frame)) if whole else round(frame, _DECIMALS)
            return replace(key, frame=place, left=left, right=right)

        return self._changed(frames, there)

    def with_interpolation(self, frames: Iterable[float] | None, interpolation: Interpolation) -> Keys:
        """With the keys at those frames (None: all) going to the next in that way."""
        return self._changed(frames, lambda key: replace(key, interpolation=interpolation))

    def with_handles(
        self, frame: float, left: tuple[float, ...] | None = None, right: tuple[float, ...] | None = None
    ) -> Keys:
        """With other handles of the key at that frame: None leaves one, an empty one is automatic.

        Raises GraphError if there is no key or a handle has not one number for the frames and one for every channel.
        """
        key = self.key(frame)
        if key is None:
            raise GraphError(f"there is no key at frame {frame:g}")
        for given in (left, right):
            if given and not (len(given) == 1 + len(key.parts) and all(map(math.isfinite, given))):
                raise GraphError(f"the key at frame {frame:g} takes {1 + len(key.parts)} finite numbers for a handle")
        return self._with(
            (replace(key, left=key.left if left is None else left, right=key.right if right is None else right),)
        )

    def _with(self, keys: Iterable[Key]) -> Keys:
        return replace(self, keys=(*self.keys, *keys))

    def _changed(self, frames: Iterable[float] | None, change: Callable[[Key], Key]) -> Keys:
        chosen = set(self.frames if frames is None else frames)
        stay = [key for key in self.keys if key.frame not in chosen]
        return replace(self, keys=(*stay, *(change(key) for key in self.keys if key.frame in chosen)))

    def _inside(self, frame: float) -> Plain:
        """The value at a frame, that of the nearest end outside."""
        place = bisect_right(self.frames, frame) - 1
        if place < 0:
            return self._held(0)
        if place + 1 == len(self.keys) or self.frames[place] == frame or not self._runs(place):
            return self._held(place)
        start, end = self.keys[place], self.keys[place + 1]
        if start.interpolation == "bezier":
            return self._plain(bezier.at(*self._segment(place), frame))
        width = end.frame - start.frame
        u = (frame - start.frame) / width
        if start.interpolation == "linear":
            return self._plain(tuple(a + (b - a) * u for a, b in zip(start.parts, end.parts, strict=True)))
        return self._plain(
            tuple(
                _hermite(u, a, b, width * self._slope(place, channel), width * self._slope(place + 1, channel))
                for channel, (a, b) in enumerate(zip(start.parts, end.parts, strict=True))
            )
        )

    def _beyond(self, frame: float) -> Plain:
        """The value outside, along the slope of the nearest end."""
        after = frame > self.frames[-1]
        place, segment = (len(self.keys) - 1, len(self.keys) - 2) if after else (0, 0)
        if not self._runs(segment):
            return self._held(place)
        start, end = self.keys[segment : segment + 2]
        if start.interpolation == "bezier":
            slopes = bezier.end_slopes(*self._segment(segment), last_end=after)
        elif start.interpolation == "linear":
            slopes = tuple((b - a) / (end.frame - start.frame) for a, b in zip(start.parts, end.parts, strict=True))
        else:
            slopes = self.slopes(self.frames[place])
        way = frame - self.frames[place]
        return self._plain(tuple(a + slope * way for a, slope in zip(self.keys[place].parts, slopes, strict=True)))

    def _runs(self, place: int) -> bool:
        """True if the value goes from the key of that place to the next one, rather than being held."""
        key = self.keys[place]
        return key.interpolation != "constant" and 0 < len(key.parts) == len(self.keys[place + 1].parts)

    def _segment(self, place: int) -> bezier.Segment:
        """The four points (frame, channels) from the key of that place to the next."""
        start, end = self.keys[place], self.keys[place + 1]
        first, last = (start.frame, *start.parts), (end.frame, *end.parts)
        return bezier.limit_handles(first, last, *self._arms(place, limit=False))

    def _arms(self, place: int, limit: bool = True) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The handles that lie in the segment after the key of that place."""
        start, end = self.keys[place], self.keys[place + 1]
        third = (end.frame - start.frame) / 3.0
        right = start.handle("right") or (third, *(third * slope for slope in self.slopes(start.frame)))
        left = end.handle("left") or (-third, *(-third * slope for slope in self.slopes(end.frame)))
        if limit and len(right) == len(left):
            _, one, two, _ = bezier.limit_handles((start.frame, *start.parts), (end.frame, *end.parts), right, left)
            return (
                tuple(b - a for a, b in zip((start.frame, *start.parts), one, strict=True)),
                tuple(b - a for a, b in zip((end.frame, *end.parts), two, strict=True)),
            )
        return right, left

    def _slope(self, place: int, channel: int) -> float:
        """The slope of `smooth` at a key: that of its neighbors, as far as the value runs to them."""
        back = place > 0 and self._runs(place - 1)
        ahead = place + 1 < len(self.keys) and self._runs(place)
        return _between(*self._rise(place - 1, channel), *self._rise(place, channel)) if back and ahead else 0.0

    def _rise(self, place: int, channel: int) -> tuple[float, float]:
        """The frames from a key to the next, and the straight slope between them."""
        start, end = self.keys[place], self.keys[place + 1]
        width = end.frame - start.frame
        return width, (end.parts[channel] - start.parts[channel]) / width

    def _held(self, place: int) -> Plain:
        key = self.keys[place]
        return self._plain(key.parts) if key.parts else key.value

    def _plain(self, parts: tuple[float, ...]) -> Plain:
        """Channels as the value that they make up."""
        return parts if isinstance(self.keys[0].value, tuple) else parts[0]


def round_keys(number: float) -> int:
    """The nearest whole number; halves go away from zero."""
    down = math.floor(abs(number))
    away = down + (abs(number) - down >= 0.5)
    return -away if number < 0 else away


def _sort_keys(keys: Iterable[Key]) -> tuple[Key, ...]:
    found = {key.frame: key for key in keys}
    return tuple(found[frame] for frame in sorted(found))


def _lifted(key: Key, lift: Plain) -> Plain:
    if not key.parts or isinstance(lift, bool | str):
        return key.value
    lifts = lift if isinstance(lift, tuple) else (lift,) * len(key.parts)
    if len(lifts) != len(key.parts):
        raise GraphError(f"{len(lifts)} numbers cannot lift a value of {len(key.parts)}")
    parts = tuple(part + more for part, more in zip(key.parts, lifts, strict=True))
    if isinstance(key.value, tuple):
        return parts
    return round_keys(parts[0]) if isinstance(key.value, int) else parts[0]


def _hermite(u: float, start: float, end: float, rise: float, fall: float) -> float:
    """The cubic from `start` to `end` with those slopes per unit of `u`."""
    v = 1.0 - u
    return start * v * v * (1.0 + 2.0 * u) + end * u * u * (1.0 + 2.0 * v) + rise * u * v * v - fall * u * u * v


def _between(width: float, slope: float, next_width: float, next_slope: float) -> float:
    """Fritsch and Butland's slope at a key: the weighted harmonic mean of those beside it, 0 at a peak."""
    if slope == 0.0 or next_slope == 0.0 or (slope > 0.0) != (next_slope > 0.0):
        return 0.0
    one, two = 2.0 * next_width + width, next_width + 2.0 * width
    return (one + two) / (one / slope + two / next_slope)
