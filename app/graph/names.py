"""Names of nodes, inputs, outputs and controls, and suggestions for misspelled ones."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Generator, Iterable, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

from ..errors import GraphError

INPUTS, OUTPUTS = "inputs", "outputs"
"""The node ids in links that stand for the inputs and outputs of the graph itself."""

_MAX_LISTED = 12
_MAX_LENGTH = 100
"""Letters of a name. Longer names get no suggestion: the time to compare two names grows with the square of this."""
_MAX_NAMES = 20_000
"""Names that are compared with one unknown name. Comparing that many takes 0.1 s."""
_MAX_COMPARISONS = 40_000
"""Names that are compared for all faults of one graph together. A file can hold 100,000 faults."""
_LEAST_COMPARISONS = 20
"""What the shortest list counts as: starting to compare takes as long as comparing this many names (measured)."""

_COMPARISONS_LEFT: ContextVar[list[int] | None] = ContextVar("_COMPARISONS_LEFT", default=None)

T = TypeVar("T")


@contextmanager
def limit_suggestions() -> Generator[None]:
    """Inside this context only the first of many faults get suggestions, because each suggestion takes time."""
    token = None if _COMPARISONS_LEFT.get() else _COMPARISONS_LEFT.set([_MAX_COMPARISONS])
    try:
        yield
    finally:
        if token:
            _COMPARISONS_LEFT.reset(token)


def did_you_mean(name: str, names: Collection[str]) -> str:
    """The end of a sentence about an unknown name: the most similar of `names`, or a short list of them, or ""."""
    comparisons = _COMPARISONS_LEFT.get() or [_MAX_COMPARISONS]
    cost = max(len(names), _LEAST_COMPARISONS)
    if len(name) > _MAX_LENGTH or cost > min(_MAX_NAMES, comparisons[0]):
        return ""
    comparisons[0] -= cost
    lowered = {item.lower(): item for item in sorted(names, reverse=True) if len(item) <= _MAX_LENGTH}
    if near := difflib.get_close_matches(name.lower(), lowered, n=1):
        return f"; did you mean '{lowered[near[0]]}'?"
    if 0 < len(lowered) <= _MAX_LISTED:
        return f"; there is {', '.join(sorted(lowered.values()))}"
    return ""


def make_printable(name: str) -> str:
    """A name on one line: characters that cannot be printed are escaped."""
    return name if name.isprintable() else ascii(name)[1:-1]


def pick(entries: Mapping[str, T], name: str, lacking: str) -> T:
    """The entry of a name. Raises GraphError made of `lacking`, the name and a suggestion."""
    if name not in entries:
        raise GraphError(f"{lacking} '{make_printable(name)}'{did_you_mean(name, entries)}")
    return entries[name]


def name_fault(name: str, subject: str) -> str | None:
    """Why a node, input, output or control (`subject`) cannot have this name, or None."""
    if not name:
        return f"the name of {_add_article(subject)} cannot be empty"
    if "." in name or "/" in name or not name.isprintable():
        return f"{_add_article(subject)} cannot be called {name!r}: leave out dots, slashes and control characters"
    if subject == "node" and name in (INPUTS, OUTPUTS):
        return f"a node cannot be called '{name}': that name stands for the ends of the graph"
    return None


def check_name(name: str, subject: str, used_names: Iterable[str] = ()) -> None:
    """Raise GraphError unless a name is valid and not used yet."""
    if fault := name_fault(name, subject):
        raise GraphError(fault)
    if name in used_names:
        raise GraphError(f"{_add_article(subject)} called '{name}' already exists; choose another name")


def fresh_name(stem: str, used_names: Iterable[str]) -> str:
    """A name that is not used yet: `stem`, or `stem2`, `stem3`, ..."""
    names, number, name = set(used_names), 1, stem
    while name in names:
        number += 1
        name = f"{stem}{number}"
    return name


def _add_article(noun: str) -> str:
    return f"an {noun}" if noun[0] in "aeiou" else f"a {noun}"
