"""Where things stand in the text of a document: JSON path -> line."""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from itertools import accumulate

from .syntax import member

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\],:]|[^\s{}\[\],:"]+', re.DOTALL)


class Positions:
    """The lines on which the parts of a text begin: an entry of an object at its key, one of a list at itself.

    The text is taken to be JSON; of one that is damaged, the part before the damage is known.
    """

    def __init__(self, text: str) -> None:
        self._places = _places(text)
        self._starts = [0, *accumulate(len(line) + 1 for line in text.split("\n"))]

    def __contains__(self, path: str) -> bool:
        return path in self._places

    def line(self, path: str, *, last: bool = False) -> int:
        """The line, from 1, of what is at a JSON path as errors write it, or of the nearest thing around it.

        Of a key that is there more than once the first one counts, or the `last`.
        """
        while path and path not in self._places:
            path = path[: max(path.rfind("."), path.rfind("["), 0)]
        places = self._places.get(path, (0,))
        return bisect_right(self._starts, places[-1 if last else 0])


def _places(text: str) -> dict[str, list[int]]:
    """Where in the text every part begins, by JSON path."""
    found: dict[str, list[int]] = {}
    above: list[tuple[str, bool, int]] = []
    path, is_list, count = "", False, 0
    key: str | None = None
    key_next = False
    for token in _TOKEN.finditer(text):
        word, here = token[0], token.start()
        if word in "}]":
            if not above:
                break
            path, is_list, count = above.pop()
            key_next = False
        elif word == ",":
            key_next, key, count = not is_list, None, count + 1
        elif word == ":":
            key_next = False
        elif key_next:
            key = _text(word)
            found.setdefault(member(path, key), []).append(here)
        else:
            mine = member(path, count) if is_list else path if key is None else member(path, key)
            if is_list or not above:
                found.setdefault(mine, []).append(here)
            if word in "{[":
                above.append((path, is_list, count))
                path, is_list, count, key = mine, word == "[", 0, None
                key_next = not is_list
    return found


def _text(word: str) -> str:
    """What a string of JSON says; one that is damaged says itself."""
    try:
        return str(json.loads(word)) if "\\" in word else word.strip('"')
    except ValueError:
        return word
