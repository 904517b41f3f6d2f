"""What differs between two graphs, as a value."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from msgspec import Struct

from ...graph import Graph, Group
from .aligning import NodeRename, align_two, rename_all, replace_items
from .parts import (
    ABSENT,
    PartPath,
    Tree,
    equals,
    is_section,
    is_tree,
    is_whole,
    local_path,
    parts_of,
    put_part,
    sort_keys,
)


class PartChange(Struct, frozen=True):
    """A part of a document before and after; ABSENT where there is none, or a value is at its default."""

    at: PartPath
    before: Any
    after: Any


class GraphDifference(Struct, frozen=True):
    """Which nodes were renamed, and what else changed, under the new names."""

    renamed: tuple[NodeRename, ...] = ()
    changes: tuple[PartChange, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.renamed or self.changes)


def compare_graphs(before: Graph, after: Graph, *, layout: bool = False) -> GraphDifference:
    """What changed, in a stable order; of the layout only if asked. Raises GraphError for what cannot be saved.

    Graphs are compared as they would be saved: how a file was written, a value that is its default, older versions
    of nodes make no difference. A group in a file of its own is compared by that file's name.
    """
    aligned, renamed = align_two(before, after)
    return GraphDifference(renamed, tuple(_changes((), parts_of(aligned), parts_of(after), layout)))


def apply_difference(before: Graph, difference: GraphDifference) -> Tree:
    """The parts of a graph after those changes."""
    for rename in difference.renamed:
        before = _rename_in_group(before, rename.group, {rename.old: rename.new})
    parts = parts_of(before)
    for change in difference.changes:
        parts = put_part(parts, change.at, change.after)
    return parts


def _changes(at: PartPath, before: Any, after: Any, layout: bool) -> Iterator[PartChange]:
    if equals(before, after) or (local_path(at) == ("ui",) and not layout):
        return
    if is_whole(at, before, after) or (ABSENT in (before, after) and not is_section(at)):
        yield PartChange(at, before, after)
        return
    entries_before, entries_after = _tree(before), _tree(after)
    for key in sort_keys(iter((entries_before, entries_after))):
        yield from _changes((*at, key), entries_before.get(key, ABSENT), entries_after.get(key, ABSENT), layout)


def _tree(part: Any) -> Tree:
    return part if is_tree(part) else {}


def _rename_in_group(graph: Graph, group: tuple[str, ...], ids: dict[str, str]) -> Graph:
    if not group:
        return rename_all(graph, ids)
    item = graph.nodes[group[0]]
    assert isinstance(item, Group)
    return replace_items(graph, {group[0]: replace(item, graph=_rename_in_group(item.graph, group[1:], ids))})
