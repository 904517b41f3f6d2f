"""The merge of three versions of a graph: every part that only one side changed is taken from that side.

Parts have names, so two users who add nodes, move nodes or set different values do not interfere. They do where both
change one part differently, or where one deletes what the other builds on: then our version stays in place, and theirs
is noted as a conflict (see `conflicts`). Where both move the same node on the canvas, our place is taken and no
conflict is noted: layout does not change the picture.
"""

from __future__ import annotations

from typing import Any

from msgspec import Struct, field

from ...errors import HalationError
from ...graph import Graph
from ..reading import loads
from ..writing import dumps
from .aligning import align_three
from .conflicts import Conflict, add_conflicts
from .faults import find_merge_faults
from .layout import remove_stray_layout
from .lines import merge_lines
from .parts import (
    ABSENT,
    CONFLICTS,
    PartPath,
    Tree,
    equals,
    get_part,
    is_list,
    is_tree,
    is_whole,
    keep_kind,
    local_path,
    parts_of,
    put_part,
    sort_keys,
    write_parts,
)
from .references import LINKED, find_contested, references

ThreeSides = tuple[Any, Any, Any]
"""A part in the base, in ours and in theirs."""


class MergedGraph(Struct, frozen=True):
    """The result of a merge: the canonical text of the graph, and the conflicts that are left to the user."""

    text: str
    conflicts: tuple[Conflict, ...]


def merge_graphs(base: Graph, ours: Graph, theirs: Graph) -> MergedGraph:
    """The graph with the changes of both sides to the base, as it would be saved. Files of groups are not read.

    If the merged parts cannot be read as a graph at all, our version is the result, and every section in which the
    sides differ is one conflict.

    Raises GraphError for what cannot be saved.
    """
    base, ours, theirs = align_three(base, ours, theirs)
    sides = (parts_of(base), parts_of(ours), parts_of(theirs))
    merger = _PartMerger()
    parts = merger.merge_part((), sides)
    try:
        while faulty := [at for at in find_merge_faults(_graph(parts), ours, theirs) if at not in merger.conflicts]:
            for at in faulty:
                parts = put_part(parts, at, merger.note_conflict(at, tuple(get_part(side, at) for side in sides)))
        text = dumps(_graph(add_conflicts(parts, merger.conflicts)))
    except HalationError:  # the merged parts are no valid graph
        merger = _PartMerger()
        for name in sort_keys(iter(sides)):
            versions = tuple(side.get(name, ABSENT) for side in sides)
            if not equals(versions[1], versions[2]):
                merger.note_conflict((name,), versions)
        text = dumps(_graph(add_conflicts(sides[1], merger.conflicts)))
    return MergedGraph(text, tuple(merger.conflicts.values()))


def _graph(parts: Tree) -> Graph:
    return loads(write_parts(parts), sandbox=None)


class _PartMerger(Struct):
    """Merges part by part, and notes conflicts. `contested` are elements of the graph at hand: see `find_contested`."""

    conflicts: dict[PartPath, Conflict] = field(default_factory=dict[PartPath, Conflict])
    contested: frozenset[str] = frozenset()

    def merge_part(self, at: PartPath, sides: ThreeSides) -> Any:
        """The merged version of a part: the first rule that fits decides."""
        base, ours, theirs = sides
        here = local_path(at)
        if equals(ours, theirs):
            return ours
        if len(here) == 1 and here[0] in LINKED and self.contested:
            return self.merge_entries(at, sides)
        if len(here) == 2 and self.is_contested(here, sides):
            return self.note_conflict(at, sides)
        if equals(theirs, base) or equals(ours, base):
            return ours if equals(theirs, base) else theirs
        if here[:1] == ("ui",):
            return self.merge_layout(at, sides)
        if here[:1] == (CONFLICTS,) and len(here) > 1:
            return theirs if ours is ABSENT else ours
        if is_whole(at, *sides):
            return self.merge_whole(at, sides)
        if not here:
            return self.merge_body(at, sides)
        merge = self.merge_entries(at, sides)
        keyless = here[0] == "animation" and len(here) == 2 and "keys" in merge and not merge["keys"]
        return self.note_conflict(at, sides) if keyless else merge

    def merge_body(self, at: PartPath, sides: ThreeSides) -> Any:
        """The merged version of a graph, or of the graph in a group."""
        outer, self.contested = self.contested, find_contested(*(part if is_tree(part) else {} for part in sides))
        merge = self.merge_entries(at, sides)
        self.contested = outer
        return remove_stray_layout(merge, sides[0])

    def merge_entries(self, at: PartPath, sides: ThreeSides) -> Any:
        """The merged version of an object, entry by entry. An empty one is absent if it is absent on a side."""
        trees = tuple(part if is_tree(part) else {} for part in sides)
        merge: Tree = {}
        for key in sort_keys(iter(trees)):
            base, ours, theirs = (tree.get(key, ABSENT) for tree in trees)
            part = self.merge_part((*at, key), (base, ours, theirs))
            if part is not ABSENT:
                merge[key] = part
        return ABSENT if not merge and ABSENT in sides else keep_kind(merge, trees[1] or trees[2])

    def is_contested(self, here: PartPath, sides: ThreeSides) -> bool:
        """True for an entry that is a contested element, or builds on one."""
        section, name = str(here[0]), str(here[1])
        built = (references(section, name, part) for part in sides) if section in LINKED else ()
        return any(self.contested & names for names in built)

    def merge_whole(self, at: PartPath, sides: ThreeSides) -> Any:
        """The merged version of a part that both changed and that has no entries: code is merged line by line."""
        here, (base, ours, theirs) = local_path(at), sides
        is_code = len(here) == 3 and here[0] == "nodes" and here[2] == "code"
        if is_code and is_list(base) and is_list(ours) and is_list(theirs):
            lines = merge_lines(base, ours, theirs)
            return self.note_conflict(at, sides) if lines is None else lines
        return self.note_conflict(at, sides)

    def merge_layout(self, at: PartPath, sides: ThreeSides) -> Any:
        """The merged version of the layout; only texts of comments and frames can be conflicts."""
        if all(is_tree(part) or part is ABSENT for part in sides) and not (
            len(local_path(at)) == 3 and ABSENT in sides[1:]
        ):
            return self.merge_entries(at, sides)
        words = local_path(at)[1:2] in (("comments",), ("frames",)) and all(isinstance(part, str) for part in sides[1:])
        if words:
            return self.note_conflict(at, sides)
        return sides[2] if sides[1] is ABSENT else sides[1]

    def note_conflict(self, at: PartPath, sides: ThreeSides) -> Any:
        """Note a conflict; our version stays in place."""
        self.conflicts[at] = Conflict(at, *sides)
        return sides[1]
