"""Structs as lines of JSON: jobs, chunks of frames and reports on their way to other processes and into headers."""

from __future__ import annotations

import json
from typing import TypeVar

import msgspec

from ..errors import UsageError
from .typed_data import convert_data

T = TypeVar("T")


def write_struct(struct: msgspec.Struct) -> str:
    """A struct as one line of JSON in ASCII, which can hold names of files in any encoding."""
    return json.dumps(msgspec.to_builtins(struct))


def read_struct(text: str | bytes, type: type[T], *, strict: bool = True) -> T:
    """The struct in a line of `write_struct`. Not `strict`, a text stands for a number, as keys of objects must.

    Raises ValueError or RecursionError for any other text.
    """
    return convert_data(json.loads(text), type, strict=strict)


def parse_struct(text: str | bytes, type: type[T], refusal: str) -> T:
    """`read_struct` for a text from outside. Raises UsageError with the `refusal` and the reason."""
    try:
        return read_struct(text, type)
    except (ValueError, RecursionError) as fault:
        raise UsageError(f"{refusal}: {fault}") from None
