"""Pairs of brackets run one way: rule N0 of the Unicode Bidirectional Algorithm, which python-bidi's levels lack."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any
from unicodedata import category

Letter = dict[str, Any]
"""A letter of python-bidi: `ch`, `type`, the embedding `level`."""

_MOST_OPEN = 63
"""How many brackets may be open at a time (BD16)."""

_STRONG = {"L": "L", "R": "R", "AL": "R", "EN": "R", "AN": "R"}
"""The direction of letters and numbers between brackets."""


def resolve_brackets(storage: dict[str, Any], mirrored: dict[str, str]) -> None:
    """Give both brackets of each pair the direction of what is in them, as Unicode 6.3 says."""
    for run in storage["runs"]:
        letters = storage["chars"][run["start"] : run["start"] + run["length"]]
        for start, end in _find_pairs(letters, mirrored):
            direction = _choose_direction(letters, start, end, run["sor"])
            if direction:
                letters[start]["type"] = letters[end]["type"] = direction


def _find_pairs(letters: Sequence[Letter], mirrored: dict[str, str]) -> list[tuple[int, int]]:
    """The places of pairs, in the order of the opening brackets (BD16)."""
    pairs, expected = list[tuple[int, int]](), list[tuple[str, int]]()
    for place, letter in _list_brackets(letters):
        if category(letter) == "Ps":
            if len(expected) == _MOST_OPEN:
                return []
            expected.append((mirrored.get(letter, ""), place))
            continue
        for depth in range(len(expected) - 1, -1, -1):
            if expected[depth][0] == letter:
                pairs.append((expected[depth][1], place))
                del expected[depth:]
                break
    return sorted(pairs)


def _list_brackets(letters: Sequence[Letter]) -> Iterator[tuple[int, str]]:
    for place, letter in enumerate(letters):
        if letter["type"] == "ON" and category(letter["ch"]) in ("Ps", "Pe"):
            yield place, letter["ch"]


def _choose_direction(letters: Sequence[Letter], start: int, end: int, before: str) -> str:
    """That of the embedding if a letter inside has it, else that of the letters before if those inside agree."""
    embedding = "LR"[letters[start]["level"] % 2]
    inside = {_STRONG[letter["type"]] for letter in letters[start + 1 : end] if letter["type"] in _STRONG}
    if not inside or embedding in inside:
        return embedding if inside else ""
    context = next((_STRONG[item["type"]] for item in reversed(letters[:start]) if item["type"] in _STRONG), before)
    return context if context in inside else embedding
