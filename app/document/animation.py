"""Values that change over time <-> JSON."""

from __future__ import annotations

from typing import Any, cast

from halation.nodes import ROWS, SPLINE_ROWS, RowLayout, Scalar, Value

from ..errors import DocumentError
from ..graph import Animation, Expression, Key, Keys
from ..graph.scalars import coerce_scalar, describe_scalar
from . import records
from .records import Section, convert
from .syntax import member, word


def read_animation(raw: Any, file: str, path: str, value: Value | None = None) -> Animation:
    """The entry of `animation` of a declared value, at JSON path `path`; None if nobody knows it.

    Whether it makes sense is for `problems`. Raises DocumentError.
    """
    record = convert(raw, records.AnimationRecord, file, path)
    if (record.expression is None) == (record.keys is None):
        raise DocumentError(file, path, 'it needs either "keys" or an "expression"')
    if record.expression is not None:
        return Expression(record.expression)
    where = member(path, "keys")
    keys = tuple(_key(key, file, f"{where}[{place}]", value) for place, key in enumerate(record.keys or ()))
    frames = [key.frame for key in keys]
    if frames != sorted(set(frames)):
        raise DocumentError(file, where, "list the keys by frame, one for each")
    return Keys(keys, record.outside)


def describe_animation(animation: Animation, value: Value | None) -> Section:
    """What `read_animation` reads, for an animation of a declared value."""
    if isinstance(animation, Expression):
        return {"expression": animation.text}
    outside = {"outside": animation.outside} if animation.outside != "hold" else {}
    return {"keys": [_describe_key(key, value) for key in animation.keys]} | outside


def _key(raw: Any, file: str, path: str, declared: Value | None) -> Key:
    record = convert(raw, records.KeyRecord, file, path)
    value = _plain(record.value, ROWS.get(declared.type, SPLINE_ROWS) if declared else SPLINE_ROWS)
    if declared and declared.type == "point":  # it may be written without the zeros at its end
        value = coerce_scalar(declared, value) or value
    if value is None:
        fault = f"expected a number, true, false, a list of numbers or a list of points, got {word(record.value)}"
        raise DocumentError(file, member(path, "value"), fault)
    length = 1 + (len(value) if isinstance(value, tuple) else 1)
    for side in ("left", "right"):
        handle = getattr(record, side)
        if handle and len(handle) != length:
            raise DocumentError(file, member(path, side), f"expected a list of {length} numbers, got {len(handle)}")
    return Key(record.frame, value, record.interpolation, record.left, record.right)


def _plain(raw: object, rows: RowLayout) -> Scalar | None:
    if isinstance(raw, bool | int | float):
        return raw
    if not isinstance(raw, list):
        return None
    parts = cast("list[object]", raw)
    if parts and isinstance(parts[0], list):
        return rows.read(parts)
    numbers = tuple(float(part) for part in parts if isinstance(part, int | float) and not isinstance(part, bool))
    return numbers if numbers and len(numbers) == len(parts) else None


def _describe_key(key: Key, value: Value | None) -> Section:
    frame = int(key.frame) if key.frame == int(key.frame) else key.frame
    section: Section = {"frame": frame, "value": describe_scalar(value, key.value) if value else key.value}
    if key.interpolation != "smooth":
        section["interpolation"] = key.interpolation
    return section | {side: handle for side, handle in (("left", key.left), ("right", key.right)) if handle}
