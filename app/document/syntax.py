"""Text -> JSON tree, stricter than JSON: no key twice, no NaN, limited depth; every fault has its JSON path."""

from __future__ import annotations

import json
import sys
from functools import reduce
from typing import Any, NamedTuple, cast

from ..errors import DocumentError
from .limits import MAX_NESTING, size_fault


class _Trail(NamedTuple):
    """Where a part is, from the inside out. Most trails are never spelled as a path, which would take the time."""

    outer: _Trail | None
    key: str | int


class _Twice(dict[str, Any]):
    """An object of the text that has one key more than once."""

    key = ""


def parse(text: str, file: str) -> dict[str, Any]:
    """The object that `text` holds. Raises DocumentError."""
    if fault := size_fault(len(text.strip())):
        raise DocumentError(file, "", fault, rule="unreadable-graph")
    try:
        tree: Any = json.loads(text, object_pairs_hook=_object)
    except json.JSONDecodeError as error:
        said = error.msg[:1].lower() + error.msg[1:].removesuffix(" at")
        fault = f"not valid JSON: {said} (line {error.lineno}, column {error.colno})"
        raise DocumentError(file, "", fault, rule="syntax", line=error.lineno) from None
    except RecursionError:
        raise DocumentError(file, "", _too_deep()) from None
    except ValueError:
        raise DocumentError(file, "", "it holds a whole number with too many digits") from None
    if isinstance(tree, dict | list):
        _check(cast("Any", tree), file)
    if not isinstance(tree, dict):
        raise DocumentError(file, "", "expected an object, got " + word(cast("object", tree)))
    return cast("dict[str, Any]", tree)


def member(path: str, key: str | int) -> str:
    """The JSON path of a part of what is at `path`."""
    if isinstance(key, int):
        return f"{path}[{key}]"
    shown = key if key.isprintable() else ascii(key)[1:-1]
    return f"{path}.{shown}" if path else shown


def word(item: object) -> str:
    """What a part of the tree is, for a sentence."""
    match item:
        case None:
            return "null"
        case bool():
            return "true" if item else "false"
        case int() | float():
            return f"the number {item}"
        case str():
            return f"the string {item!r}" if len(item) < 40 else "a string"
        case dict():
            return "an object"
        case _:
            return "a list"


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) == len(pairs):
        return found
    twice, seen = _Twice(found), set[str]()
    twice.key = next(key for key, _ in pairs if key in seen or seen.add(key))
    return twice


def _check(tree: Any, file: str) -> None:
    """Look at every part, without recursion."""
    todo: list[tuple[Any, _Trail | None, int]] = [(tree, None, 1)]
    while todo:
        item, trail, depth = todo.pop()
        if depth > MAX_NESTING:
            raise DocumentError(file, "", _too_deep())
        if isinstance(item, _Twice):
            where = _path(_Trail(trail, item.key))
            raise DocumentError(file, where, "this key is there twice; remove one", rule="double-key")
        parts = cast("dict[str, Any]", item).items() if isinstance(item, dict) else enumerate(cast("list[Any]", item))
        for key, part in parts:
            if isinstance(key, str) and not _is_text(key):
                raise DocumentError(file, _path(trail), f"the key {key!r} is not valid Unicode")
            if isinstance(part, dict | list):
                todo.append((cast("Any", part), _Trail(trail, key), depth + 1))
            elif fault := _fault(part):
                raise DocumentError(file, _path(_Trail(trail, key)), fault)


def _fault(part: Any) -> str | None:
    """Why this string, number, boolean or null is refused, or None."""
    if isinstance(part, str):
        return None if _is_text(part) else f"the string {part!r} is not valid Unicode"
    if part is None or abs(part) <= sys.float_info.max:
        return None
    return "expected a finite number: JSON has no NaN or Infinity"


def _path(trail: _Trail | None) -> str:
    """The JSON path that a trail of keys stands for."""
    keys: list[str | int] = []
    while trail:
        keys.append(trail.key)
        trail = trail.outer
    return reduce(member, reversed(keys), "")


def _is_text(text: str) -> bool:
    """False for half a surrogate pair, which JSON can spell and UTF-8 cannot."""
    return text.isascii() or not any("\ud800" <= letter <= "\udfff" for letter in text)


def _too_deep() -> str:
    return f"objects and lists nest deeper than {MAX_NESTING}; that is no graph"
