"""Names that people choose, and the nearest one to what they meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import TypeVar

from ..errors import GraphError

INPUTS, OUTPUTS = "inputs", "outputs"
"""The ids under which links name the ends of the graph itself."""

_LISTED = 12

T = TypeVar("T")


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The tail of a sentence about an unknown `name`: the nearest known one, or a short list, or nothing."""
    lowered = {item.lower(): item for item in sorted(known, reverse=True)}
    if near := difflib.get_close_matches(name.lower(), lowered, n=1):
        return f"; did you mean '{lowered[near[0]]}'?"
    if 0 < len(lowered) <= _LISTED:
        return f"; there is {', '.join(sorted(lowered.values()))}"
    return ""


def pick(known: Mapping[str, T], name: str, lacking: str) -> T:
    """The entry of that name. Raises GraphError: `lacking`, the name and a suggestion."""
    if name not in known:
        raise GraphError(f"{lacking} '{name}'{did_you_mean(name, known)}")
    return known[name]


def name_fault(name: str, what: str) -> str | None:
    """Why `name` cannot name a node, input, output or control (`what` says which), or None."""
    if not name:
        return f"the name of {_article(what)} cannot be empty"
    if "." in name or "/" in name or not name.isprintable():
        return f"{_article(what)} cannot be called {name!r}: leave out dots, slashes and control characters"
    if what == "node" and name in (INPUTS, OUTPUTS):
        return f"a node cannot be called '{name}': that name stands for the ends of the graph"
    return None


def check_name(name: str, what: str, taken: Iterable[str] = ()) -> None:
    """Raise GraphError unless `name` is valid and free."""
    if fault := name_fault(name, what):
        raise GraphError(fault)
    if name in taken:
        raise GraphError(f"{_article(what)} called '{name}' already exists; choose another name")


def fresh_name(stem: str, taken: Iterable[str]) -> str:
    """`stem`, or `stem2`, `stem3`, ... where that is taken."""
    used, number, name = set(taken), 1, stem
    while name in used:
        number += 1
        name = f"{stem}{number}"
    return name


def _article(what: str) -> str:
    return f"an {what}" if what[0] in "aeiou" else f"a {what}"
