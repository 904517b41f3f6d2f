"""What the entries of a graph build on: nodes by id, the ends of the graph as `inputs.beauty`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from ...graph import INPUTS, OUTPUTS, Expression
from .parts import ABSENT, Tree, is_tree, names_of, same

LINKED: Final = ("nodes", INPUTS, OUTPUTS, "links", "animation", "controls")
"""Sections whose entries stand for something, or build on it."""


def references(section: str, name: str, entry: Any) -> frozenset[str]:
    """What an entry of a section is, or builds on; nothing if it is ABSENT."""
    if entry is ABSENT:
        return frozenset()
    if section == "nodes":
        return frozenset({name})
    if section in (INPUTS, OUTPUTS):
        return frozenset({f"{section}.{name}"})
    if section == "links":
        return frozenset({_owner(name), _owner(entry)})
    if section == "controls":
        return frozenset({_owner(entry.get("target"))})
    text = entry.get("expression")
    named = Expression(text).names if isinstance(text, str) else ()
    return frozenset({_owner(name), *map(_owner, named)})


def taken_away(base: Tree, ours: Tree, theirs: Tree) -> frozenset[str]:
    """What one side removed while the other changed it or built on it, and what both added, each in its way."""
    before, mine, others = (frozenset(things_of(body)) for body in (base, ours, theirs))
    fought = {thing for thing in before & mine - others if thing in _touched(base, ours)}
    fought |= {thing for thing in before & others - mine if thing in _touched(base, theirs)}
    twice = mine & others - before
    return frozenset(fought | {thing for thing in twice if not same(_thing(ours, thing), _thing(theirs, thing))})


def _touched(base: Tree, side: Tree) -> frozenset[str]:
    """What changed entries of a side are or build on."""
    found: set[str] = set()
    for section in LINKED:
        before, after = base.get(section, {}), side.get(section, {})
        for name in names_of(iter((after,))):
            if not same(before.get(name, ABSENT), after[name]):
                found |= references(section, name, after[name])
    return frozenset(found)


def things_of(body: Tree) -> Iterator[str]:
    """The nodes of a graph, and its ends."""
    yield from body.get("nodes", {})
    for section in (INPUTS, OUTPUTS):
        yield from (f"{section}.{name}" for name in body.get(section, {}))


def _thing(body: Tree, thing: str) -> Any:
    section, dot, name = thing.partition(".")
    entries = body.get(section if dot else "nodes", {})
    return entries.get(name if dot else thing, ABSENT) if is_tree(entries) else ABSENT


def _owner(port: Any) -> str:
    """The node of a port; an end of the graph is a thing of its own."""
    text = str(port)
    node = text.partition(".")[0]
    return text if node in (INPUTS, OUTPUTS) else node
