"""JSON tree -> text, in the one way that graphs are written."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
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

_MAPPINGS = (dict, MappingProxyType, Mapping)
"""The first two are known sooner than by the questions that the third one asks."""

_PLAIN: Mapping[type, Callable[[Any], str]] = MappingProxyType(
    {str: encode_basestring, int: int.__repr__, bool: lambda item: "true" if item else "false"}
)
"""The functions that write scalars, by type. JSON can hold each value of these types, but not each float."""


def pretty(document: Mapping[str, Any]) -> str:
    """Sorted keys, two spaces, one line for all that fits but code. Raises GraphError for what JSON cannot hold."""
    return "".join(write_parts(document))


def write_parts(document: Mapping[str, Any]) -> Iterator[str]:
    """The text of `pretty` in parts: a comparison with another text needs only those up to the first difference."""
    before = "{\n  "
    for key in _sort_keys(document, None):
        section, trail = document[key], Trail(None, key)
        if key in _SPREAD and section and isinstance(section, _MAPPINGS):
            entries = cast("Mapping[str, Any]", section)
            yield f"{before}{encode_basestring(key)}: "
            inner_before = "{\n    "
            for name in _sort_keys(entries, trail):
                yield inner_before + _entry(name, entries[name], 4, trail, 2)
                inner_before = ",\n    "
            yield "\n  }"
        else:
            yield before + _entry(key, section, 2, None, 1)
        before = ",\n  "
    yield "\n}\n" if document else "{}\n"


def _text(item: Any, indent: int, column: int, trail: Trail, depth: int) -> str:
    """`item` as text that starts at `column` of a line with this `indent`."""
    if type(item) in _SCALARS or not isinstance(item, (*_MAPPINGS, list, tuple)):
        return _scalar(item, trail)
    if not item:
        return "[]" if isinstance(item, list | tuple) else "{}"
    if depth > MAX_NESTING:
        where = spell_path(trail)
        raise GraphError(
            f"{where}: the graph nests deeper than {MAX_NESTING} and cannot be saved; save groups as files"
        )
    inner, is_code = indent + 2, False
    if isinstance(item, list | tuple):
        opening, closing = "[", "]"
        parts = enumerate(cast("list[Any]", item))
        texts = [_text(part, inner, inner, Trail(trail, place), depth + 1) for place, part in parts]
        is_code = trail.outer is not None and trail.key == "code" and len(texts) > 1
        # Rows of a spline, which alone are tuples of tuples: a diff shows the points that moved.
        is_code = is_code or (isinstance(item, tuple) and isinstance(item[0], tuple))
    else:
        opening, closing = "{", "}"
        mapping = cast("Mapping[str, Any]", item)
        texts = [_entry(key, mapping[key], inner, trail, depth) for key in _sort_keys(mapping, trail)]
    # The first test is for speed: most long items need not be written to see that they do not fit.
    if column + sum(map(len, texts)) + 2 * len(texts) < WIDTH and not is_code:
        flat = f"{opening}{', '.join(texts)}{closing}"
        if "\n" not in flat:
            return flat
    lines = ",\n".join(" " * inner + text for text in texts)
    return f"{opening}\n{lines}\n{' ' * indent}{closing}"


def _entry(key: str, part: object, indent: int, trail: Trail | None, depth: int) -> str:
    """A key and what it stands for, within an object at this depth."""
    start = f"{encode_basestring(key)}: "
    plain = _PLAIN.get(type(part))  # most parts are such, and need no trail
    return start + (plain(part) if plain else _text(part, indent, indent + len(start), Trail(trail, key), depth + 1))


def _sort_keys(mapping: Mapping[str, Any], trail: Trail | None) -> list[str]:
    if not _TEXT.issuperset(map(type, mapping)):
        odd = next(key for key in mapping if type(key) is not str)
        raise GraphError(f"{spell_path(trail)}: the key {odd!r} cannot be saved; JSON has only text as keys")
    return sorted(mapping)


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
