"""Edits of selected keys: each gives the new animation of every value, and which keys are selected then.

A gesture always edits the keys as they were when it began. So a key that is dragged over another one and back again
does not delete it.
Nothing here draws.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import Literal

from halation.nodes import Scalar
from msgspec import Struct, field
from msgspec.structs import replace

from ...graph import Animation, Extrapolation, Interpolation, Key, Keys, Port
from ...graph.keys import round_keys
from .rows import Spot
from .shapes import is_interpolated, read_key_channel

_NO_FRAMES = 1e-9
"""Frames of a handle that are 0 but for rounding: it has no slope."""

_UPRIGHT = 1e-6
"""Frames of a handle that is moved, below which it points straight up: the other one then keeps its slope."""

_ALIGNED = 1e-4
"""How far handles may be from one line, as a part of their size, and still count as lying on it: files may have
fewer digits than doubles. Chosen by judgement."""

Animations = Mapping[Port, Animation]
Limits = Callable[[Port], tuple[float, float]]
Side = Literal["left", "right"]
Ease = Literal["in", "out", "both"]

MIN_SCALE = 0.01
"""The smallest factor for scaling keys, so that they never all fall on one frame."""


class KeyEdit(Struct, frozen=True):
    """New keys by value, and the selected keys."""

    new_keys: Mapping[Port, Keys] = field(default_factory=dict[Port, Keys])
    spots: frozenset[Spot] = frozenset()


def allow_any_number(port: Port) -> tuple[float, float]:
    """The limits of a value without limits."""
    return float("-inf"), float("inf")


def group_spots(animation: Animations, spots: Collection[Spot]) -> dict[Port, dict[float, set[int]]]:
    """The channels of every selected key that exists, by value and frame."""
    groups: dict[Port, dict[float, set[int]]] = {}
    for port, frame, channel in spots:
        keys = animation.get(port)
        if isinstance(keys, Keys) and keys.key(frame):
            groups.setdefault(port, {}).setdefault(frame, set()).add(channel)
    return groups


def find_frame_range(spots: Collection[Spot]) -> tuple[float, float] | None:
    """The first and the last frame of the selected keys."""
    frames = [frame for _, frame, _ in spots]
    return (min(frames), max(frames)) if frames else None


def move_keys(
    animation: Animations, spots: Collection[Spot], by: float, lift: float = 0.0, limits: Limits = allow_any_number
) -> KeyEdit:
    """Move the selected keys by some frames, and raise the selected channels by `lift`."""
    new_keys: dict[Port, Keys] = {}
    for port, frames in group_spots(animation, spots).items():
        keys = _get_keys(animation, port)
        if lift:
            low, high = limits(port)
            keys = replace(
                keys,
                keys=tuple(
                    _lift_key(key, frames[key.frame], lift, low, high) if key.frame in frames else key
                    for key in keys.keys
                ),
            )
        new_keys[port] = keys.move(frames, by)
    return KeyEdit(new_keys, frozenset((port, round(frame + by, 6), channel) for port, frame, channel in spots))


def scale_keys(
    animation: Animations, spots: Collection[Spot], factor: float, about: float, whole: bool = True
) -> KeyEdit:
    """Scale the distance of the selected keys from the frame `about` by `factor`."""
    factor = max(factor, MIN_SCALE)

    def scale_frame(frame: float) -> float:
        at = about + (frame - about) * factor
        return float(round_keys(at)) if whole else round(at, 6)

    new_keys = {
        port: _get_keys(animation, port).scale(frames, factor, about, whole)
        for port, frames in group_spots(animation, spots).items()
    }
    return KeyEdit(new_keys, frozenset((port, scale_frame(frame), channel) for port, frame, channel in spots))


def remove_keys(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Remove the selected keys; an animation may end up without keys."""
    return {port: _get_keys(animation, port).remove(*frames) for port, frames in group_spots(animation, spots).items()}


def interpolate_keys(animation: Animations, spots: Collection[Spot], interpolation: Interpolation) -> dict[Port, Keys]:
    """Set the interpolation of the selected keys; switches always hold."""
    return {
        port: keys.with_interpolation(frames, interpolation)
        for port, frames in group_spots(animation, spots).items()
        if (keys := _get_keys(animation, port)).keys[0].channels
    }


def extrapolate_keys(animation: Animations, ports: Collection[Port], extrapolation: Extrapolation) -> dict[Port, Keys]:
    """Set what values do before the first and after the last key."""
    return {
        port: replace(keys, outside=extrapolation) for port in ports if isinstance(keys := animation.get(port), Keys)
    }


def ease_keys(animation: Animations, spots: Collection[Spot], ease: Ease) -> dict[Port, Keys]:
    """Ease the selected keys: flat handles before ("in"), after ("out") or on both sides."""
    new_keys: dict[Port, Keys] = {}
    for port, frames in group_spots(animation, spots).items():
        keys = _get_keys(animation, port)
        for frame in frames:
            place = keys.frames.index(frame)
            if ease != "out" and place > 0:
                keys = convert_to_bezier(keys, place - 1)
                keys = keys.with_handles(frame, left=_make_flat_handle(keys, place, -1))
            if ease != "in" and place + 1 < len(keys.keys):
                keys = convert_to_bezier(keys, place)
                keys = keys.with_handles(frame, right=_make_flat_handle(keys, place, 1))
        new_keys[port] = keys
    return new_keys


def convert_to_bezier(keys: Keys, place: int) -> Keys:
    """Give one segment handles without changing its curve; a segment that holds becomes smooth."""
    if place + 1 >= len(keys.keys) or not keys.keys[place].channels:
        return keys
    start, end = keys.keys[place : place + 2]
    if start.interpolation == "bezier":
        return keys
    if not is_interpolated(keys, place) or start.interpolation == "linear":
        third = (end.frame - start.frame) / 3.0
        rise = tuple((b - a) / 3.0 for a, b in zip(start.channels, end.channels, strict=False))
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
    return before >= 0 and is_interpolated(keys, before) and keys.keys[before].interpolation == "bezier"


def has_aligned_handles(keys: Keys, frame: float) -> bool:
    """True if both handles of a key lie on one line, in every channel."""
    left, right = keys.handles(frame)
    if not left or not right:
        return False
    size = max(map(abs, (*left[1:], *right[1:])), default=0.0) * max(abs(left[0]), abs(right[0]), _NO_FRAMES)
    return all(
        abs(a * right[0] - b * left[0]) <= _ALIGNED * size + 1e-12 for a, b in zip(left[1:], right[1:], strict=True)
    )


def pull_handle(keys: Keys, frame: float, channel: int, side: Side, to: tuple[float, float], both: bool) -> Keys:
    """Move the end of a handle to `to`: frames and value, relative to its key.

    All channels of a key share the frames of its handles, so the other channels get longer or shorter in proportion and
    keep their slope. With `both` the other handle turns with it and stays as long in frames.
    """
    old_handle, old_opposite = keys.handles(frame) if side == "left" else keys.handles(frame)[::-1]
    if not old_handle:
        return keys
    across = min(to[0], 0.0) if side == "left" else max(to[0], 0.0)
    ratio = across / old_handle[0] if abs(old_handle[0]) > _NO_FRAMES else 1.0
    handle = [across, *(part * ratio for part in old_handle[1:])]
    handle[1 + channel] = to[1]
    opposite = None
    if both and old_opposite:
        slope = -old_opposite[0] / across if abs(across) > _UPRIGHT else None
        opposite = [*old_opposite]
        for place in range(1, len(handle)):
            opposite[place] = -handle[place] * (slope if slope is not None else 1.0)
        if slope is None:
            opposite[0] = 0.0
    new_handle, new_opposite = tuple(handle), tuple(opposite) if opposite else None
    return (
        keys.with_handles(frame, new_handle, new_opposite)
        if side == "left"
        else keys.with_handles(frame, new_opposite, new_handle)
    )


def reset_handles(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Reset the handles of the selected keys to the smooth curve."""
    new_keys: dict[Port, Keys] = {}
    for port, frames in group_spots(animation, spots).items():
        keys = _get_keys(animation, port)
        for frame in frames:
            keys = keys.with_handles(frame, (), ())
        new_keys[port] = keys
    return new_keys


def align_handles(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Align both handles of the selected keys, on the mean of their slopes."""
    new_keys: dict[Port, Keys] = {}
    for port, frames in group_spots(animation, spots).items():
        keys = _get_keys(animation, port)
        for frame in frames:
            left, right = keys.handles(frame)
            if not left or not right:
                continue
            slopes = [0.5 * (_find_slope(left, place) + _find_slope(right, place)) for place in range(1, len(left))]
            keys = keys.with_handles(
                frame, (left[0], *(slope * left[0] for slope in slopes)), (right[0], *(s * right[0] for s in slopes))
            )
        new_keys[port] = keys
    return new_keys


def fix_handles(animation: Animations, spots: Collection[Spot]) -> dict[Port, Keys]:
    """Store the automatic handles of the selected keys, as if the user had placed them."""
    new_keys: dict[Port, Keys] = {}
    for port, frames in group_spots(animation, spots).items():
        keys = _get_keys(animation, port)
        for frame in frames:
            left, right = keys.handles(frame)
            keys = keys.with_handles(frame, left or None, right or None)
        new_keys[port] = keys
    return new_keys


def with_number(keys: Keys, frame: float, channel: int, number: float) -> Keys:
    """Set the number of one channel of a key."""
    return replace(
        keys,
        keys=tuple(
            replace(key, value=_change_value(key, {channel}, lambda _: number)) if key.frame == frame else key
            for key in keys.keys
        ),
    )


def _lift_key(key: Key, channels: Collection[int], lift: float, low: float, high: float) -> Key:
    return replace(key, value=_change_value(key, channels, lambda part: min(max(part + lift, low), high)))


def _change_value(key: Key, channels: Collection[int], change: Callable[[float], float]) -> Scalar:
    """The value of a key with other numbers in some channels; a switch is on from a half."""
    if isinstance(key.value, bool):
        return change(float(key.value)) >= 0.5
    if not key.channels:
        return key.value
    parts = tuple(change(part) if place in channels else part for place, part in enumerate(key.channels))
    if isinstance(key.value, tuple):
        return parts
    return round_keys(parts[0]) if isinstance(key.value, int) else parts[0]


def _make_flat_handle(keys: Keys, place: int, side: int) -> tuple[float, ...]:
    width = abs(keys.keys[place + side].frame - keys.keys[place].frame)
    return side * width / 3.0, *(0.0 for _ in keys.keys[place].channels)


def _find_slope(handle: tuple[float, ...], place: int) -> float:
    return handle[place] / handle[0] if abs(handle[0]) > _NO_FRAMES else 0.0


def _get_keys(animation: Animations, port: Port) -> Keys:
    keys = animation[port]
    assert isinstance(keys, Keys)
    return keys


__all__ = [
    "MIN_SCALE",
    "Animations",
    "Ease",
    "KeyEdit",
    "Limits",
    "Side",
    "align_handles",
    "allow_any_number",
    "convert_to_bezier",
    "ease_keys",
    "extrapolate_keys",
    "find_frame_range",
    "fix_handles",
    "group_spots",
    "has_aligned_handles",
    "has_handle",
    "interpolate_keys",
    "move_keys",
    "pull_handle",
    "read_key_channel",
    "remove_keys",
    "reset_handles",
    "scale_keys",
    "with_number",
]
