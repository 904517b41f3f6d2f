"""Names of nodes, inputs, outputs and controls, and suggestions for misspelled ones."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import TypeVar

from ..errors import GraphError
from ..resources.suggestions import can_compare, find_near_names, may_compare

INPUTS, OUTPUTS = "inputs", "outputs"
"""The node ids in links that stand for the inputs and outputs of the graph itself."""

_MAX_LISTED = 12
"""Names in a message: about three lines."""
_MAX_LENGTH = 100
"""Letters of a name. Longer names get no suggestion: the time to compare two names grows with the square of this."""
_MAX_NAMES = 20_000
"""Names that are compared with one unknown name. Comparing that many takes 0.1 s."""

T = TypeVar("T")


def did_you_mean(name: str, names: Collection[str]) -> str:
    """The end of a sentence about an unknown name: the most similar of `names`, or a short list of them, or ""."""
    if len(name) > _MAX_LENGTH or not can_compare_all(names) or not may_compare(len(names)):
        return ""
    lowered = {item.lower(): item for item in sorted(names, reverse=True) if len(item) <= _MAX_LENGTH}
    if near := find_near_names(name.lower(), lowered):
        return f"; did you mean '{lowered[near[0]]}'?"
    if 0 < len(lowered) <= _MAX_LISTED:
        return f"; there is {', '.join(sorted(lowered.values()))}"
    return ""


def can_compare_all(names: Collection[str]) -> bool:
    """False if an unknown name is not compared with so many others, or after so many faults."""
    return can_compare() and len(names) <= _MAX_NAMES


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


def find_name_fault(names: Mapping[str, object], subject: str) -> str | None:
    """What `name_fault` says about the first name that cannot be one, or None. Most files have none: all are looked at
    together, since there may be 100,000.
    """
    letters = "".join(names)
    is_plain = letters.isprintable() and "." not in letters and "/" not in letters
    if is_plain and "" not in names and (subject != "node" or not (INPUTS in names or OUTPUTS in names)):
        return None
    return next((fault for name in names if (fault := name_fault(name, subject))), None)


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


def name_several(noun: str) -> str:
    """More than one of them: "lights", "pairs of curves"."""
    head, of, rest = noun.partition(" of ")
    return f"{head}s{of}{rest}"


def _add_article(noun: str) -> str:
    return f"an {noun}" if noun[0] in "aeiou" else f"a {noun}"
