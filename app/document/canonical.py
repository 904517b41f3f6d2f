"""JSON tree -> text, in the one way that graphs are written."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any, cast

from ..errors import GraphError
from .limits import MAX_NESTING
from .syntax import member

WIDTH = 100
"""Columns within which an object or list stays on one line."""

_SPREAD = frozenset({"animation", "controls", "inputs", "links", "nodes", "outputs"})
"""Sections of a document that have a line for every entry, however short, so that a diff shows one entry."""

_ENCODER = json.JSONEncoder(ensure_ascii=False)


def pretty(document: Mapping[str, Any]) -> str:
    """Sorted keys, two spaces, one line for all that fits but code. Raises GraphError for what JSON cannot hold."""
    return _text(document, 0, 0, "", 1) + "\n"


def _text(item: Any, indent: int, column: int, path: str, depth: int) -> str:
    """`item` as text that starts at `column` of a line that is indented by `indent`."""
    if not isinstance(item, Mapping | list | tuple):
        return _scalar(item, path)
    if depth > MAX_NESTING:
        raise GraphError(f"{path}: the graph nests deeper than {MAX_NESTING} and cannot be saved; save groups as files")
    if isinstance(item, Mapping):
        known = cast("Mapping[str, Any]", item)
        if odd := next((key for key in known if type(key) is not str), None):
            raise GraphError(f"{path}: the key {odd!r} cannot be saved; JSON has only text as keys")
        parts = [(f"{_scalar(key, path)}: ", known[key], member(path, key)) for key in sorted(known)]
        opening, closing = "{", "}"
    else:
        parts = [("", part, member(path, place)) for place, part in enumerate(cast("list[Any]", item))]
        opening, closing = "[", "]"
    inner = indent + 2
    texts = [key + _text(part, inner, inner + len(key), where, depth + 1) for key, part, where in parts]
    flat = f"{opening}{', '.join(texts)}{closing}"
    fits = "\n" not in flat and column + len(flat) < WIDTH
    is_code = opening == "[" and path.endswith(".code") and len(texts) > 1
    if not texts or (fits and path and path not in _SPREAD and not is_code):
        return flat
    lines = ",\n".join(" " * inner + text for text in texts)
    return f"{opening}\n{lines}\n{' ' * indent}{closing}"


def _scalar(item: Any, path: str) -> str:
    if isinstance(item, float) and not math.isfinite(item):
        raise GraphError(f"{path}: {item} cannot be saved; set a finite number")
    if item is None or isinstance(item, bool | int | float | str):
        return _ENCODER.encode(item)
    raise GraphError(f"{path}: {item!r} cannot be saved; JSON has no {type(item).__name__}")
