"""What differs between two graphs, as a value."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from ...graph import Graph, Group
from .aligning import Renamed, align, rename_all, with_items
from .parts import ABSENT, At, Tree, is_section, is_tree, is_whole, local, names_of, parts_of, put_part, same


@dataclass(frozen=True)
class Change:
    """A part of a document before and after; ABSENT where there is none, or a value is at its default."""

    at: At
    before: Any
    after: Any


@dataclass(frozen=True)
class Difference:
    """Which nodes were renamed, and what else changed, under the new names."""

    renamed: tuple[Renamed, ...] = ()
    changes: tuple[Change, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.renamed or self.changes)


def difference(before: Graph, after: Graph, *, layout: bool = False) -> Difference:
    """What changed, in a stable order; of the layout only if asked. Raises GraphError for what cannot be saved.

    Graphs are compared as they would be saved: how a file was written, a value that is its default, older versions
    of nodes make no difference. A group in a file of its own is compared by that file's name.
    """
    aligned, renamed = align(before, after)
    return Difference(renamed, tuple(_changes((), parts_of(aligned), parts_of(after), layout)))


def applied(before: Graph, wanted: Difference) -> Tree:
    """The parts of a graph after those changes."""
    for one in wanted.renamed:
        before = _renamed(before, one.group, {one.old: one.new})
    parts = parts_of(before)
    for change in wanted.changes:
        parts = put_part(parts, change.at, change.after)
    return parts


def _changes(at: At, before: Any, after: Any, layout: bool) -> Iterator[Change]:
    if same(before, after) or (local(at) == ("ui",) and not layout):
        return
    if is_whole(at, before, after) or (ABSENT in (before, after) and not is_section(at)):
        yield Change(at, before, after)
        return
    one, other = _tree(before), _tree(after)
    for key in names_of(iter((one, other))):
        yield from _changes((*at, key), one.get(key, ABSENT), other.get(key, ABSENT), layout)


def _tree(part: Any) -> Tree:
    return part if is_tree(part) else {}


def _renamed(graph: Graph, group: tuple[str, ...], ids: dict[str, str]) -> Graph:
    if not group:
        return rename_all(graph, ids)
    item = graph.nodes[group[0]]
    assert isinstance(item, Group)
    return with_items(graph, {group[0]: replace(item, graph=_renamed(item.graph, group[1:], ids))})
