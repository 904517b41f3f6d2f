"""JSON tree -> text, in the one way that graphs are written."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from json.encoder import encode_basestring
from types import MappingProxyType
from typing import Any, cast

from ..errors import GraphError
from .limits import MAX_NESTING
from .syntax import Trail, spell_path

WIDTH = 100
"""Columns within which an object or list stays on one line."""

_SPREAD = frozenset({"animation", "controls", "inputs", "links", "nodes", "outputs"})
"""Sections of a document that have a line for every entry, however short, so that a diff shows one entry."""

_TEXT = frozenset({str})
_SCALARS = frozenset({str, int, float, bool, type(None)})
"""Types that hold no others. Most parts of a file have one, which is known sooner than by `isinstance`."""


_PLAIN: Mapping[type, Callable[[Any], str]] = MappingProxyType(
    {str: encode_basestring, int: int.__repr__, bool: lambda item: "true" if item else "false"}
)
"""What writes a scalar that JSON can hold whatever it is."""


def pretty(document: Mapping[str, Any]) -> str:
    """Sorted keys, two spaces, one line for all that fits but code. Raises GraphError for what JSON cannot hold."""
    return _text(document, 0, 0, None, 1) + "\n"


def _text(item: Any, indent: int, column: int, trail: Trail | None, depth: int) -> str:
    """`item` as text that starts at `column` of a line with this `indent`."""
    if type(item) in _SCALARS or not isinstance(item, (dict, MappingProxyType, list, tuple, Mapping)):
        return _scalar(item, trail)
    if not item:
        return "[]" if isinstance(item, list | tuple) else "{}"
    if depth > MAX_NESTING:
        where = spell_path(trail)
        raise GraphError(
            f"{where}: the graph nests deeper than {MAX_NESTING} and cannot be saved; save groups as files"
        )
    inner, texts = indent + 2, list[str]()
    if not isinstance(item, list | tuple):
        mapping = cast("Mapping[str, Any]", item)
        if not _TEXT.issuperset(map(type, mapping)):
            odd = next(key for key in mapping if type(key) is not str)
            raise GraphError(f"{spell_path(trail)}: the key {odd!r} cannot be saved; JSON has only text as keys")
        opening, closing = "{", "}"
        for key in sorted(mapping):
            start, part = f"{encode_basestring(key)}: ", mapping[key]
            plain = _PLAIN.get(type(cast("object", part)))  # most parts are such, and need no trail
            texts.append(
                start + (plain(part) if plain else _text(part, inner, inner + len(start), Trail(trail, key), depth + 1))
            )
    else:
        opening, closing = "[", "]"
        texts += [
            _text(part, inner, inner, Trail(trail, place), depth + 1)
            for place, part in enumerate(cast("list[Any]", item))
        ]
    # The first test is for speed: most long items need not be written to see that they do not fit.
    length = sum(map(len, texts)) + 2 * len(texts)
    section = trail is not None and trail.outer is None and trail.key in _SPREAD
    is_code = opening == "[" and trail is not None and trail.outer and trail.key == "code" and len(texts) > 1
    if column + length < WIDTH and trail is not None and not section and not is_code:
        flat = f"{opening}{', '.join(texts)}{closing}"
        if "\n" not in flat:
            return flat
    lines = ",\n".join(" " * inner + text for text in texts)
    return f"{opening}\n{lines}\n{' ' * indent}{closing}"


def _scalar(item: Any, trail: Trail | None) -> str:
    if isinstance(item, str):
        return encode_basestring(item)
    if item is None:
        return "null"
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, int):
        return int.__repr__(item)
    if not isinstance(item, float):
        raise GraphError(f"{spell_path(trail)}: {item!r} cannot be saved; JSON has no {type(item).__name__}")
    if not math.isfinite(item):
        raise GraphError(f"{spell_path(trail)}: {item} cannot be saved; set a finite number")
    return float.__repr__(item)
