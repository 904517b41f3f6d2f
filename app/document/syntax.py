"""Text -> JSON tree, stricter than JSON: no key twice, no NaN, limited depth; every fault has its JSON path.

Size, number of parts and depth are counted in the text, before anything is made of it. For that the text is cut at its
quotes, which takes a tenth of the time of a regular expression. The tree is walked only where something in the text
looks like a fault: a walk takes longer than all the rest.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Sequence
from functools import partial, reduce
from itertools import accumulate
from typing import Any, NamedTuple, cast

import msgspec

from ..errors import DocumentError
from .limits import MAX_KEY, MAX_NESTING, MAX_PARTS, size_fault
from .syntax_faults import explain_syntax

_LARGE_NUMBER = re.compile(r"NaN|Infinity|[eE]\+?\d{3}|\d{200}")
"""Texts that may be a number that is not finite."""
_MANY_DIGITS, _LONG = re.compile(r"\d{200}"), 200
"""What msgspec reads although it may be larger than any number of 64 bits, and the least letters that it has."""
_ESCAPED_HALF = re.compile(r"\\u[dD][89a-fA-F]")
_HALF = r"[\ud800-\udfff]"
"""Texts that may be half of a surrogate pair."""
_STEPS = {ord("{"): 1, ord("["): 1, ord("}"): -1, ord("]"): -1}
_NO_BRACKETS = bytes(set(range(256)) - {*_STEPS})

_NO_END_OF_KEY = (b'\\":', b':":', b',":', b'[":', b'{":')
"""Where a quote and a colon may be part of a string."""
_MAX_QUOTES = 4 * MAX_PARTS + 4
"""Quotes of a text that has no more parts than a file may: each has a key and a string at most."""


class Trail(NamedTuple):
    """The place of a part, from the inside out. Most trails are never written as a path, which would take time."""

    outer: Trail | None
    key: str | int


class _Twice(dict[str, Any]):
    """An object of the text that has one key more than once, or one that is too long."""

    key = ""


def parse(text: str, file: str) -> dict[str, Any]:
    """The object that `text` holds. Raises DocumentError."""
    if fault := size_fault(len(text.strip())):
        raise DocumentError(file, "", fault, rule="unreadable-graph")
    plain_text = text.replace("\\\\", "__").replace('\\"', "__") if "\\" in text else text
    if plain_text.count('"') > _MAX_QUOTES:
        raise DocumentError(file, "", _refuse_parts())
    pieces = plain_text.split('"')  # each second one is a string
    outline = "".join(pieces[::2])
    if fault := _shape_fault(outline):
        raise DocumentError(file, "", fault)
    if plain_tree := _parse_plain(text, pieces, outline):
        return plain_tree
    del pieces
    odd_objects: list[_Twice] = []
    try:
        tree: Any = json.loads(text, object_pairs_hook=partial(_make_object, odd_objects))
    except json.JSONDecodeError as error:
        clause, offset = explain_syntax(text, error)
        line, column = text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset)
        fault = f"not valid JSON: {clause} (line {line}, column {column})"
        raise DocumentError(file, "", fault, rule="syntax", line=line) from None
    except ValueError:
        raise DocumentError(file, "", "it holds a whole number with too many digits") from None
    if isinstance(tree, dict | list) and (odd_objects or _is_suspect(text, outline)):
        _check(cast("Any", tree), file)
    if not isinstance(tree, dict):
        raise DocumentError(file, "", "expected an object, got " + word(cast("object", tree)))
    return cast("dict[str, Any]", tree)


def _parse_plain(text: str, pieces: Sequence[str], outline: str) -> dict[str, Any] | None:
    """The object that `text` holds, if it has no fault; None if it may have one, which costs a slower look at it.

    `pieces` are what is between its quotes. msgspec reads in a fifth of the time, and refuses numbers that are not
    finite. Of a key that is there twice it takes the last one: the tree, written again, then has fewer colons than the
    text.
    """
    if max(map(len, pieces)) >= _LONG and (_has_long_key(pieces) or _MANY_DIGITS.search(outline)):
        return None
    if _has_half(text):
        return None
    try:
        tree = msgspec.json.decode(text)
    except (msgspec.MsgspecError, UnicodeError, RecursionError):
        return None
    written = msgspec.json.encode(tree)
    if any(odd in written for odd in _NO_END_OF_KEY) or written.count(b'":') != outline.count(":"):
        return None
    return cast("dict[str, Any]", tree) if isinstance(tree, dict) else None


def _has_long_key(pieces: Sequence[str]) -> bool:
    """True if a string before a colon may be longer than a key may be. `pieces` are what is between quotes."""
    long = [place for place, piece in enumerate(pieces) if len(piece) > MAX_KEY]
    return any(place % 2 and pieces[place + 1 : place + 2] and pieces[place + 1].lstrip()[:1] == ":" for place in long)


def member(path: str, key: str | int) -> str:
    """The JSON path of a part of what is at `path`."""
    if isinstance(key, int):
        return f"{path}[{key}]"
    printable = key if key.isprintable() else ascii(key)[1:-1]
    return f"{path}.{printable}" if path else printable


def word(item: object) -> str:
    """The type of a part of the tree, for a sentence."""
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


def spell_path(trail: Trail | None) -> str:
    """The JSON path that a trail of keys stands for."""
    keys: list[str | int] = []
    while trail:
        keys.append(trail.key)
        trail = trail.outer
    return reduce(member, reversed(keys), "")


def _is_suspect(text: str, outline: str) -> bool:
    """True if a part of a text may be no finite number, or no valid Unicode. `outline` is the text without strings."""
    return _LARGE_NUMBER.search(outline) is not None or _has_half(text)


def _has_half(text: str) -> bool:
    """True if half of a surrogate pair may be in a text."""
    if "\\u" in text and _ESCAPED_HALF.search(text):
        return True
    return not text.isascii() and re.search(_HALF, text) is not None


def _shape_fault(outline: str) -> str | None:
    """Why a text of that many parts and that depth is refused, or None. `outline` is the text without strings."""
    brackets = outline.count("[") + outline.count("{")
    if brackets + outline.count(",") > MAX_PARTS:
        return _refuse_parts()
    if brackets <= MAX_NESTING:
        return None
    steps = outline.encode(errors="replace").translate(None, _NO_BRACKETS)
    if max(accumulate(map(_STEPS.__getitem__, steps)), default=0) > MAX_NESTING:
        return f"objects and lists nest deeper than {MAX_NESTING}; that is no graph"
    return None


def _refuse_parts() -> str:
    return f"it has more than {MAX_PARTS:,} parts; that is no graph"


def _make_object(odd_objects: list[_Twice], pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object of the text; one with a key that is there twice or too long goes to `odd_objects` as well."""
    plain = dict(pairs)
    if len(plain) == len(pairs) and max(map(len, plain), default=0) <= MAX_KEY:
        return plain
    odd, keys = _Twice(plain), set[str]()
    odd.key = next((key for key, _ in pairs if key in keys or keys.add(key)), "")
    odd_objects.append(odd)
    return odd


def _check(tree: Any, file: str) -> None:
    """Check every part, without recursion."""
    todo: list[tuple[Any, Trail | None]] = [(tree, None)]
    while todo:
        item, trail = todo.pop()
        if isinstance(item, _Twice):
            if long := next((key for key in item if len(key) > MAX_KEY), None):
                fault = f"the key {long[:40]!r}... has {len(long):,} characters; at most {MAX_KEY:,} are allowed"
                raise DocumentError(file, spell_path(trail), fault)
            where = spell_path(Trail(trail, item.key))
            raise DocumentError(file, where, "this key is there twice; remove one", rule="double-key")
        parts = cast("dict[str, Any]", item).items() if isinstance(item, dict) else enumerate(cast("list[Any]", item))
        for key, part in parts:
            if isinstance(key, str) and not _is_text(key):
                raise DocumentError(file, spell_path(trail), f"the key {key[:40]!r} is not valid Unicode")
            if isinstance(part, dict | list):
                todo.append((cast("Any", part), Trail(trail, key)))
            elif fault := _fault(part):
                raise DocumentError(file, spell_path(Trail(trail, key)), fault)


def _fault(part: Any) -> str | None:
    """Why this string, number, boolean or null is refused, or None."""
    if isinstance(part, str):
        return None if _is_text(part) else f"the string {part[:40]!r} is not valid Unicode"
    if part is None or abs(part) <= sys.float_info.max:
        return None
    return "expected a finite number: JSON has no NaN or Infinity"


def _is_text(text: str) -> bool:
    """False for half a surrogate pair, which JSON can spell and UTF-8 cannot."""
    return text.isascii() or not any("\ud800" <= letter <= "\udfff" for letter in text)
