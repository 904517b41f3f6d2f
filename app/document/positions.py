"""Finds lines in the text of a document by JSON path.

A text may be hostile, so its parts are not all given their paths: a key of a megabyte around a thousand parts would
make a gigabyte of them. The paths that are asked for come first. The text is then read once, and only inside of
containers that one of those paths leads through.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable

from .syntax import member

_STRING = r'"(?:[^"\\]++|\\.)*+"?+'
_KEY = re.compile(rf'(?:[^"{{}}\[\]]++|{_STRING}(?!\s*+:))*+(?:({_STRING})\s*+:|([{{}}\[\]]))', re.DOTALL)
"""In an object: the next key, or the next bracket that is not in a string."""
_ENTRY = re.compile(rf'\s*+(?:({_STRING}|[^\s{{}}\[\],:"]++)|([{{}}\[\]])|[,:])', re.DOTALL)
"""In a list: the next scalar, bracket or comma."""
_BRACKET = re.compile(rf'(?:[^"{{}}\[\]]++|{_STRING})*+([{{}}\[\]])', re.DOTALL)
"""The next bracket that is not in a string."""

_PLAIN = rf'(?:[^"{{}}\[\]]++|{_STRING})*+'
_FLAT = re.compile(rf"{_PLAIN}(?:\{{{_PLAIN}\}}{_PLAIN})?[}}\]]", re.DOTALL)
"""The rest of a container in which there is one object at most, which holds no other: that of most nodes."""


class Positions:
    """The lines on which parts of a text begin: an entry of an object at its key, one of a list at itself.

    `paths` are all that will be asked for, as errors write them. The text is taken to be JSON; of one that is damaged,
    the part before the damage is known. With `first` nobody asks for the last of several keys: what comes behind all of
    the paths is then not read.
    """

    def __init__(self, text: str, paths: Iterable[str], *, first: bool = False) -> None:
        asked_paths = frozenset(paths)
        self._places = _find_places(text, _prefixes(asked_paths), set(asked_paths) if first else set())
        self._lines = _count_lines(text, {offset for offsets in self._places.values() for offset in offsets})

    def __contains__(self, path: str) -> bool:
        return path in self._places

    def line(self, path: str, *, last: bool = False) -> int:
        """The line, from 1, of the part at a JSON path as errors write it, or of the nearest part around it.

        If a key occurs more than once, the first one counts, or the `last`.
        """
        while path and path not in self._places:
            path = _shorten(path)
        return self._lines[self._places[path][1 if last else 0]]


def _count_lines(text: str, offsets: Iterable[int]) -> dict[int, int]:
    """The line of each offset. The text is read once: it may have a million lines, and few of them are asked for."""
    lines, line, before = dict[int, int](), 1, 0
    for offset in sorted(offsets):
        line += text.count("\n", before, offset)
        lines[offset] = line
        before = offset
    return lines


def _shorten(path: str) -> str:
    """The path without its last part. A key may hold a dot: then this is no path, and only one step more."""
    return path[: max(path.rfind("."), path.rfind("["), 0)]


def _prefixes(paths: Iterable[str]) -> frozenset[str]:
    """The paths and all that is around them."""
    prefixes = {""}
    for path in paths:
        while path not in prefixes:
            prefixes.add(path)
            path = _shorten(path)
    return frozenset(prefixes)


def _find_places(text: str, prefixes: frozenset[str], missing: set[str]) -> dict[str, tuple[int, int]]:
    """Where in the text each part of these paths begins, the first time and the last.

    It reads only what leads to these paths and skips the rest by regular expressions: a parser in Python would read
    every character of a large file. A name that stands twice has two places, of which JSON takes the last. It ends as
    soon as all paths that were `missing` are found, if any were.
    """
    begin = len(text) - len(text.lstrip())
    places = {"": (begin, begin)}
    containers = {_shorten(prefix) for prefix in prefixes if prefix}
    above: list[tuple[str, bool, int]] = []
    path, is_list, count = "", False, 0
    part, at = "", 0 if containers else len(text)
    while token := (_ENTRY if is_list else _KEY).match(text, at):
        word, bracket, at = token[1], token[2], token.end()
        if word or (is_list and bracket in ("{", "[")):
            part = member(path, count if is_list else _text(word))
            if part in prefixes:
                here = token.start(1 if word else 2)
                places[part] = places.get(part, (here, here))[0], here
                if part in missing:
                    missing.remove(part)
                    if not missing:
                        break
        if bracket in ("}", "]"):
            if not above:
                break
            path, is_list, count = above.pop()
        elif bracket and part not in containers:
            at = _skip(text, at)
        elif bracket:
            above.append((path, is_list, count))
            path, is_list, count = part, bracket == "[", 0
        elif is_list and not word:
            count += 1
    return places


def _skip(text: str, start: int) -> int:
    """The end of the container that `start` is inside of."""
    if flat := _FLAT.match(text, start):
        return flat.end()
    depth = 1
    while depth and (bracket := _BRACKET.match(text, start)):
        depth += 1 if bracket[1] in "{[" else -1
        start = bracket.end()
    return len(text) if depth else start


def _text(word: str) -> str:
    """The content of a JSON string; a damaged string is returned unchanged."""
    try:
        return str(json.loads(word)) if "\\" in word else word.strip('"')
    except ValueError:
        return word
