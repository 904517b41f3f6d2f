"""What is done to chosen keys: which animation every value has afterwards, and which keys are chosen then.

All of it is made from the keys as they were when a gesture began, so that keys pushed over others come back from them.
Nothing here draws.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from halation.nodes import Plain

from ...graph import Animation, Interpolation, Key, Keys, Outside, Port
from ...graph.keys import round_keys
from .rows import Spot
from .shapes import level, runs

Animations = Mapping[Port, Animation]
Limits = Callable[[Port], tuple[float, float]]
Side = Literal["left", "right"]
Ease = Literal["in", "out", "both"]

LEAST = 0.01
"""Keys are never drawn together more than that."""


@dataclass(frozen=True)
class KeyEdit:
    """New animations by value, and the chosen keys."""

    made: Mapping[Port, Keys] = field(default_factory=dict[Port, Keys])
    spots: frozenset[Spot] = frozenset()


def unlimited(port: Port) -> tuple[float, float]:
    """For values that may be anything."""
    return float("-inf"), float("inf")


def chosen(animation: Animations, spots: Collection[Spot]) -> dict[Port, dict[float, set[int]]]:
    """The channels of every chosen key that there is, by value and frame."""
    found: dict[Port, dict[float, set[int]]] = {}
    for port, frame, channel in spots:
        keys = animation.get(port)
        if isinstance(keys, Keys) and keys.key(frame):
            found.setdefault(port, {}).setdefault(frame, set()).add(channel)
    return found


def extent(spots: Collection[Spot]) -> tuple[float, float] | None:
    """The first and the last frame of chosen keys."""
    frames = [frame for _, frame, _ in spots]
    return (min(frames), max(frames)) if frames else None


def moved(
    animation: Animations, spots: Collection[Spot], by: float, lift: float = 0.0, limits: Limits = unlimited
) -> KeyEdit:
    """Chosen keys so many frames later, chosen channels so much higher."""
    made: dict[Port, Keys] = {}
    for port, frames in chosen(animation, spots).items():
        keys = _keys(animation, port)
        if lift:
            low, high = limits(port)
            keys = replace(
                keys,
                keys=tuple(
                    _lifted(key, frames[key.frame], lift, low, high) if key.frame in frames else key
                    for key in keys.keys
                ),
            )
        made[port] = keys.move(frames, by)
    return KeyEdit(made, frozenset((port, round(frame + by, 6), channel) for port, frame, channel in spots))


def scaled(animation: Animations, spots: Collection[Spot], factor: float, about: float, whole: bool = True) -> KeyEdit:
    """Chosen keys `factor` times as far from the frame `about`."""
    factor = max(factor, LEAST)

    def there(frame: float) -> float:
        at = about + (frame - about) * factor
        return float(round_keys(at)) if whole else round(at, 6)

    made = {
        port: _keys(animation, port).scale(frames, factor, about, whole)
        for port, frames in chosen(animation, spots).items()
    }
    return KeyEdit(made, frozenset((port, there(frame), channel) for port, frame, channel in spots))


def removed(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Without the chosen keys; where none is left, the animation has no keys."""
    return {port: _keys(animation, port).remove(*frames) for port, frames in chosen(animation, spots).items()}


def interpolated(animation: Animations, spots: Collection[Spot], how: Interpolation) -> dict[Port, Keys]:
    """Chosen keys going to the next in that way; switches stay held."""
    return {
        port: keys.with_interpolation(frames, how)
        for port, frames in chosen(animation, spots).items()
        if (keys := _keys(animation, port)).keys[0].parts
    }


def going_on(animation: Animations, ports: Collection[Port], how: Outside) -> dict[Port, Keys]:
    """Values that are held, go on or repeat before the first and after the last key."""
    return {port: replace(keys, outside=how) for port in ports if isinstance(keys := animation.get(port), Keys)}


def eased(animation: Animations, spots: Collection[Spot], how: Ease) -> dict[Port, Keys]:
    """Chosen keys that are come to gently ("in"), left gently ("out"), or both: handles that lie flat."""
    made: dict[Port, Keys] = {}
    for port, frames in chosen(animation, spots).items():
        keys = _keys(animation, port)
        for frame in frames:
            place = keys.frames.index(frame)
            if how != "out" and place > 0:
                keys = as_bezier(keys, place - 1)
                keys = keys.with_handles(frame, left=_flat(keys, place, -1))
            if how != "in" and place + 1 < len(keys.keys):
                keys = as_bezier(keys, place)
                keys = keys.with_handles(frame, right=_flat(keys, place, 1))
        made[port] = keys
    return made


def as_bezier(keys: Keys, place: int) -> Keys:
    """The same curve from the key of that place to the next, with handles; what is held goes smoothly."""
    if place + 1 >= len(keys.keys) or not keys.keys[place].parts:
        return keys
    start, end = keys.keys[place : place + 2]
    if start.interpolation == "bezier":
        return keys
    if not runs(keys, place) or start.interpolation == "linear":
        third = (end.frame - start.frame) / 3.0
        rise = tuple((b - a) / 3.0 for a, b in zip(start.parts, end.parts, strict=False))
        if start.interpolation == "constant":
            rise = (0.0,) * len(rise)
        right, left = (third, *rise), (-third, *(-part for part in rise))
        keys = keys.with_interpolation((start.frame,), "bezier")
        return keys.with_handles(start.frame, right=right).with_handles(end.frame, left=left)
    plain = keys.with_handles(start.frame, right=()).with_handles(end.frame, left=())
    right, left = plain.handles(start.frame)[1], plain.handles(end.frame)[0]
    keys = keys.with_interpolation((start.frame,), "bezier")
    return keys.with_handles(start.frame, right=right).with_handles(end.frame, left=left)


def has_handle(keys: Keys, place: int, side: Side) -> bool:
    """True if the curve has a handle on that side of the key of that place."""
    before = place - 1 if side == "left" else place
    return before >= 0 and runs(keys, before) and keys.keys[before].interpolation == "bezier"


def aligned(keys: Keys, frame: float) -> bool:
    """True if both handles of a key lie on one line, in every channel."""
    left, right = keys.handles(frame)
    if not left or not right:
        return False
    size = max(map(abs, (*left[1:], *right[1:])), default=0.0) * max(abs(left[0]), abs(right[0]), 1e-9)
    return all(abs(a * right[0] - b * left[0]) <= 1e-4 * size + 1e-12 for a, b in zip(left[1:], right[1:], strict=True))


def pulled(keys: Keys, frame: float, channel: int, side: Side, to: tuple[float, float], both: bool) -> Keys:
    """With the end of a handle at `to`, frames and value from its key.

    The other channels keep their slope. With `both` the other handle turns with it and stays as long in frames.
    """
    here, there = keys.handles(frame) if side == "left" else keys.handles(frame)[::-1]
    if not here:
        return keys
    across = min(to[0], 0.0) if side == "left" else max(to[0], 0.0)
    ratio = across / here[0] if abs(here[0]) > 1e-9 else 1.0
    handle = [across, *(part * ratio for part in here[1:])]
    handle[1 + channel] = to[1]
    other = None
    if both and there:
        slope = -there[0] / across if abs(across) > 1e-6 else None
        other = [*there]
        for place in range(1, len(handle)):
            other[place] = -handle[place] * (slope if slope is not None else 1.0)
        if slope is None:
            other[0] = 0.0
    mine, others = tuple(handle), tuple(other) if other else None
    return keys.with_handles(frame, mine, others) if side == "left" else keys.with_handles(frame, others, mine)


def automatic(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Chosen keys whose handles go along the smooth curve."""
    made: dict[Port, Keys] = {}
    for port, frames in chosen(animation, spots).items():
        keys = _keys(animation, port)
        for frame in frames:
            keys = keys.with_handles(frame, (), ())
        made[port] = keys
    return made


def straightened(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Chosen keys whose two handles lie on one line, half way between where they point now."""
    made: dict[Port, Keys] = {}
    for port, frames in chosen(animation, spots).items():
        keys = _keys(animation, port)
        for frame in frames:
            left, right = keys.handles(frame)
            if not left or not right:
                continue
            slopes = [0.5 * (_slope(left, place) + _slope(right, place)) for place in range(1, len(left))]
            keys = keys.with_handles(
                frame, (left[0], *(slope * left[0] for slope in slopes)), (right[0], *(s * right[0] for s in slopes))
            )
        made[port] = keys
    return made


def fixed(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Chosen keys with the handles that they have now, as if the user had placed them."""
    made: dict[Port, Keys] = {}
    for port, frames in chosen(animation, spots).items():
        keys = _keys(animation, port)
        for frame in frames:
            left, right = keys.handles(frame)
            keys = keys.with_handles(frame, left or None, right or None)
        made[port] = keys
    return made


def with_number(keys: Keys, frame: float, channel: int, number: float) -> Keys:
    """With another number in a channel of a key."""
    return replace(
        keys,
        keys=tuple(
            replace(key, value=_changed(key, {channel}, lambda _: number)) if key.frame == frame else key
            for key in keys.keys
        ),
    )


def _lifted(key: Key, which: Collection[int], lift: float, low: float, high: float) -> Key:
    return replace(key, value=_changed(key, which, lambda part: min(max(part + lift, low), high)))


def _changed(key: Key, which: Collection[int], change: Callable[[float], float]) -> Plain:
    """The value of a key with other numbers in some channels; a switch is on from a half."""
    if isinstance(key.value, bool):
        return change(float(key.value)) >= 0.5
    if not key.parts:
        return key.value
    parts = tuple(change(part) if place in which else part for place, part in enumerate(key.parts))
    if isinstance(key.value, tuple):
        return parts
    return round_keys(parts[0]) if isinstance(key.value, int) else parts[0]


def _flat(keys: Keys, place: int, side: int) -> tuple[float, ...]:
    width = abs(keys.keys[place + side].frame - keys.keys[place].frame)
    return side * width / 3.0, *(0.0 for _ in keys.keys[place].parts)


def _slope(handle: tuple[float, ...], place: int) -> float:
    return handle[place] / handle[0] if abs(handle[0]) > 1e-9 else 0.0


def _keys(animation: Animations, port: Port) -> Keys:
    found = animation[port]
    assert isinstance(found, Keys)
    return found


__all__ = [
    "LEAST",
    "Animations",
    "Ease",
    "KeyEdit",
    "Limits",
    "Side",
    "aligned",
    "as_bezier",
    "automatic",
    "chosen",
    "eased",
    "extent",
    "fixed",
    "going_on",
    "has_handle",
    "interpolated",
    "level",
    "moved",
    "pulled",
    "removed",
    "scaled",
    "straightened",
    "unlimited",
    "with_number",
]
