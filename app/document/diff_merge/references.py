"""Which elements the entries of a graph build on: nodes by id, and ends such as `inputs.beauty`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from ...graph import INPUTS, OUTPUTS, Expression
from .parts import ABSENT, Tree, equals, is_tree, sort_keys

LINKED: Final = ("nodes", INPUTS, OUTPUTS, "links", "animation", "controls")
"""Sections whose entries are elements, or build on some."""


def references(section: str, name: str, entry: Any) -> frozenset[str]:
    """The elements that an entry of a section is, or builds on; none if it is ABSENT."""
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


def find_contested(base: Tree, ours: Tree, theirs: Tree) -> frozenset[str]:
    """Elements that one side deleted while the other changed or used them, and that both added differently."""
    before, our_elements, their_elements = (frozenset(element_names(body)) for body in (base, ours, theirs))
    contested = {element for element in before & our_elements - their_elements if element in _find_touched(base, ours)}
    contested |= {
        element for element in before & their_elements - our_elements if element in _find_touched(base, theirs)
    }
    added_twice = our_elements & their_elements - before
    return frozenset(
        contested
        | {element for element in added_twice if not equals(_element(ours, element), _element(theirs, element))}
    )


def _find_touched(base: Tree, side: Tree) -> frozenset[str]:
    """The elements that changed entries of a side are, or build on."""
    touched: set[str] = set()
    for section in LINKED:
        before, after = base.get(section, {}), side.get(section, {})
        for name in sort_keys(iter((after,))):
            if not equals(before.get(name, ABSENT), after[name]):
                touched |= references(section, name, after[name])
    return frozenset(touched)


def element_names(body: Tree) -> Iterator[str]:
    """The elements of a graph: its nodes and its ends."""
    yield from body.get("nodes", {})
    for section in (INPUTS, OUTPUTS):
        yield from (f"{section}.{name}" for name in body.get(section, {}))


def _element(body: Tree, element: str) -> Any:
    section, dot, name = element.partition(".")
    entries = body.get(section if dot else "nodes", {})
    return entries.get(name if dot else element, ABSENT) if is_tree(entries) else ABSENT


def _owner(port: Any) -> str:
    """The element of a port: its node, or an end of the graph."""
    text = str(port)
    node = text.partition(".")[0]
    return text if node in (INPUTS, OUTPUTS) else node
