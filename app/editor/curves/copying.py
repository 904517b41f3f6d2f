"""Keys as text on the clipboard. Nothing here draws."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from typing import Any, get_args

from msgspec import Struct

from ...errors import UsageError
from ...graph import Animation, Graph, Interpolation, Key, Keys, Port
from ...language.translation import translate
from .editing import KeyEdit, group_spots
from .rows import Spot, list_spots

_NAME = "halation keys"


class CopiedKeys(Struct, frozen=True):
    """Keys by value, frames counted from the first of all."""

    keys: Mapping[Port, tuple[Key, ...]]


def encode_keys(animation: Mapping[Port, Animation], spots: Collection[Spot]) -> str:
    """The selected keys as text. Raises UsageError if there are none."""
    frames_by_port = group_spots(animation, spots)
    if not frames_by_port:
        raise UsageError(translate("no keys are selected: select what to copy"))
    first = min(frame for frames in frames_by_port.values() for frame in frames)
    values = {
        str(port): [_encode_key(key, first) for key in keys.keys if key.frame in frames]
        for port, frames in frames_by_port.items()
        if isinstance(keys := animation[port], Keys)
    }
    return json.dumps({_NAME: values}, indent=1)


def decode_keys(text: str) -> CopiedKeys:
    """The keys in a copied text. Raises UsageError."""
    try:
        values = json.loads(text)[_NAME]
        return CopiedKeys({Port.parse(name): tuple(map(_decode_key, keys)) for name, keys in values.items()})
    except Exception:
        raise UsageError(translate("the clipboard holds no keys: copy some first")) from None


def paste_keys(graph: Graph, copied: CopiedKeys, frame: float, rows: Collection[Port] = ()) -> KeyEdit:
    """Insert copied keys at `frame` into the values that they come from; keys of one value go into the selected rows.

    Raises UsageError if no value takes them.
    """
    targets = {port: keys for port, keys in copied.keys.items() if port.node in graph.nodes}
    if len(copied.keys) == 1 and rows:
        targets = dict.fromkeys(rows, next(iter(copied.keys.values())))
    new_keys: dict[Port, Keys] = {}
    spots: set[Spot] = set()
    for port, keys in targets.items():
        before = graph.animation.get(port, Keys())
        if not isinstance(before, Keys):
            continue
        pasted = tuple(
            Key(round(frame + key.frame, 6), key.value, key.interpolation, key.left, key.right) for key in keys
        )
        new_keys[port] = Keys((*before.keys, *pasted), before.outside)
        spots |= list_spots(port, new_keys[port], (key.frame for key in pasted))
    if not new_keys:
        raise UsageError(translate("the values of these keys are not in this graph: select a row to paste into"))
    return KeyEdit(new_keys, frozenset(spots))


def _encode_key(key: Key, first: float) -> dict[str, Any]:
    fields: dict[str, Any] = {
        "frame": round(key.frame - first, 6),
        "value": key.value,
        "interpolation": key.interpolation,
    }
    return fields | {side: part for side, part in (("left", key.left), ("right", key.right)) if part}


def _decode_key(fields: dict[str, Any]) -> Key:
    value, how = fields["value"], fields["interpolation"]
    if how not in get_args(Interpolation):
        raise ValueError(how)
    left, right = (tuple(map(float, fields.get(side, ()))) for side in ("left", "right"))
    return Key(float(fields["frame"]), tuple(map(float, value)) if isinstance(value, list) else value, how, left, right)
