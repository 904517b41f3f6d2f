"""Keys as text on the clipboard. Nothing here draws."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, get_args

from ...errors import UsageError
from ...graph import Animation, Graph, Interpolation, Key, Keys, Port
from .editing import KeyEdit, chosen
from .rows import Spot, spots_of

_NAME = "halation keys"


@dataclass(frozen=True)
class Copied:
    """Keys by value, frames counted from the first of all."""

    keys: Mapping[Port, tuple[Key, ...]]


def copied(animation: Mapping[Port, Animation], spots: Collection[Spot]) -> str:
    """Chosen keys as text. Raises UsageError if there are none."""
    found = chosen(animation, spots)
    if not found:
        raise UsageError("no keys are selected: select what to copy")
    first = min(frame for frames in found.values() for frame in frames)
    values = {
        str(port): [_written(key, first) for key in keys.keys if key.frame in frames]
        for port, frames in found.items()
        if isinstance(keys := animation[port], Keys)
    }
    return json.dumps({_NAME: values}, indent=1)


def read(text: str) -> Copied:
    """What was copied. Raises UsageError."""
    try:
        values = json.loads(text)[_NAME]
        return Copied({Port.parse(name): tuple(map(_read, keys)) for name, keys in values.items()})
    except Exception:
        raise UsageError("the clipboard holds no keys: copy some first") from None


def pasted(graph: Graph, given: Copied, frame: float, rows: Collection[Port] = ()) -> KeyEdit:
    """With copied keys from `frame` on, in the values that they come from; those of one value go into the chosen rows.

    Raises UsageError if nothing takes them.
    """
    targets = {port: keys for port, keys in given.keys.items() if port.node in graph.nodes}
    if len(given.keys) == 1 and rows:
        targets = dict.fromkeys(rows, next(iter(given.keys.values())))
    made: dict[Port, Keys] = {}
    spots: set[Spot] = set()
    for port, keys in targets.items():
        before = graph.animation.get(port, Keys())
        if not isinstance(before, Keys):
            continue
        put = tuple(Key(round(frame + key.frame, 6), key.value, key.interpolation, key.left, key.right) for key in keys)
        made[port] = Keys((*before.keys, *put), before.outside)
        spots |= spots_of(port, made[port], (key.frame for key in put))
    if not made:
        raise UsageError("the values of these keys are not in this graph: select a row to paste into")
    return KeyEdit(made, frozenset(spots))


def _written(key: Key, first: float) -> dict[str, Any]:
    found: dict[str, Any] = {
        "frame": round(key.frame - first, 6),
        "value": key.value,
        "interpolation": key.interpolation,
    }
    return found | {side: part for side, part in (("left", key.left), ("right", key.right)) if part}


def _read(item: dict[str, Any]) -> Key:
    value, how = item["value"], item["interpolation"]
    if how not in get_args(Interpolation):
        raise ValueError(how)
    left, right = (tuple(map(float, item.get(side, ()))) for side in ("left", "right"))
    return Key(float(item["frame"]), tuple(map(float, value)) if isinstance(value, list) else value, how, left, right)
