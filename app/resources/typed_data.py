"""Plain data as values of a type, on any thread.

When msgspec meets a class of structs for the first time, it reads the annotations of its fields. Another thread that
converts to the same class meanwhile finds them half read, which ends the process (seen with msgspec 0.22). So threads
take turns here, and nothing else of the program converts.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import RLock
from typing import Any, TypeVar

import msgspec

T = TypeVar("T")

_TURN = RLock()
"""Whose turn it is; the hook of a conversion may convert as well."""


def convert_data(raw: Any, kind: type[T], *, strict: bool = True, hook: Callable[[type, Any], Any] | None = None) -> T:
    """`raw`, as JSON gives it, as a value of `kind`; `hook` makes the types that msgspec does not know.

    Not `strict`, a text may stand for a number. Raises msgspec.ValidationError, which is a ValueError.
    """
    with _TURN:
        return msgspec.convert(raw, kind, strict=strict, dec_hook=hook)


def decode_data(text: str | bytes, kind: type[T]) -> T:
    """The value of `kind` in a JSON text. Raises msgspec.DecodeError, which is a ValueError."""
    with _TURN:
        return msgspec.json.decode(text, type=kind)
