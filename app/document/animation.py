"""Values that change over time <-> JSON."""

from __future__ import annotations

from typing import Any, cast

from halation.nodes import Plain

from ..errors import DocumentError
from ..graph import Animation, Expression, Key, Keys
from . import records
from .records import Section, convert
from .syntax import member, word


def read_animation(raw: Any, file: str, path: str) -> Animation:
    """The entry of `animation` at JSON path `path`. Whether it makes sense is for `problems`. Raises DocumentError."""
    found = convert(raw, records.AnimationRecord, file, path)
    if (found.expression is None) == (found.keys is None):
        raise DocumentError(file, path, 'it needs either "keys" or an "expression"')
    if found.expression is not None:
        return Expression(found.expression)
    where = member(path, "keys")
    keys = tuple(_key(key, file, f"{where}[{place}]") for place, key in enumerate(found.keys or ()))
    frames = [key.frame for key in keys]
    if frames != sorted(set(frames)):
        raise DocumentError(file, where, "list the keys by frame, one for each")
    return Keys(keys, found.outside)


def written_animation(animation: Animation) -> Section:
    """What `read_animation` reads."""
    if isinstance(animation, Expression):
        return {"expression": animation.text}
    outside = {"outside": animation.outside} if animation.outside != "hold" else {}
    return {"keys": [_written_key(key) for key in animation.keys]} | outside


def _key(raw: Any, file: str, path: str) -> Key:
    found = convert(raw, records.KeyRecord, file, path)
    value = _plain(found.value)
    if value is None:
        said = f"expected a number, true, false or a list of numbers, got {word(found.value)}"
        raise DocumentError(file, member(path, "value"), said)
    wanted = 1 + (len(value) if isinstance(value, tuple) else 1)
    for side in ("left", "right"):
        given = getattr(found, side)
        if given and len(given) != wanted:
            raise DocumentError(file, member(path, side), f"expected a list of {wanted} numbers, got {len(given)}")
    return Key(found.frame, value, found.interpolation, found.left, found.right)


def _plain(raw: object) -> Plain | None:
    if isinstance(raw, bool | int | float):
        return raw
    if not isinstance(raw, list):
        return None
    parts = cast("list[object]", raw)
    numbers = tuple(float(part) for part in parts if isinstance(part, int | float) and not isinstance(part, bool))
    return numbers if numbers and len(numbers) == len(parts) else None


def _written_key(key: Key) -> Section:
    frame = int(key.frame) if key.frame == int(key.frame) else key.frame
    found: Section = {"frame": frame, "value": key.value}
    if key.interpolation != "smooth":
        found["interpolation"] = key.interpolation
    return found | {side: handle for side, handle in (("left", key.left), ("right", key.right)) if handle}
