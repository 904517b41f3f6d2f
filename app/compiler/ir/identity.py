"""What identifies an operation: every field that can change a pixel, found from the declaration of its class.

A fingerprint that misses a field leaves stale pixels on the screen, so no code lists fields by hand. All fields of an
operation, and of the values in it, count, except:

- `owner` and other fields in `compare_exclude`: operations that differ in them are equal.
- Fields in `identity_exclude`, a class attribute that maps a field to the reason why no pixel depends on it.
- Refs: which pictures an operation reads is said by the places of these pictures in their pass, and by their keys.

`tests/compiler/test_identity.py` changes each field of each operation and expects another key.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from hashlib import blake2b
from typing import Any, cast

from msgspec import Struct

from ...resources.record import Record
from .values import Ref, UniformConstant

_PLAIN = frozenset({str, int, bool, type(None)})


def describe(item: Any) -> object:
    """Everything about an operation, or a value in one, that can change a pixel: nested tuples with a plain repr.

    Values that are equal have one description: 1 and 1.0 as constants, 0.0 and -0.0 anywhere.
    """
    kind = cast("type[Any]", type(item))
    if kind in _PLAIN:
        return item
    if kind is float:
        return item + 0.0
    if kind is tuple:
        return tuple(map(describe, item))
    if kind is Ref:
        return "ref"
    if kind is UniformConstant:
        return tuple(map(float, item.value)) if isinstance(item.value, tuple) else float(item.value)
    if issubclass(kind, Struct):
        return (kind.__name__, *(describe(getattr(item, name)) for name in identity_fields(kind)))
    return item


@cache
def identity_fields(kind: type[Struct]) -> tuple[str, ...]:
    """The fields of a class that can change a pixel."""
    excluded: Mapping[str, str] = getattr(kind, "identity_exclude", {})
    uncompared = kind.compare_exclude if issubclass(kind, Record) else frozenset[str]()
    return tuple(name for name in kind.__struct_fields__ if name not in excluded and name not in uncompared)


def hash_parts(*parts: object) -> str:
    """A hash of the texts of some values."""
    return blake2b("\0".join(str(part) for part in parts).encode(), digest_size=16).hexdigest()
