"""Three versions of a graph made one: every part that only one side changed is taken from that side.

Parts go by name, so two people who add nodes, move them or turn different values never meet. They do where both change
one part differently, or where one takes away what the other builds on: then all that is ours there stays in place, and
what theirs says is noted as a conflict (see `conflicts.py`). Where both move the same thing on the canvas, ours stays
without a word: layout is no logic.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ...errors import HalationError
from ...graph import Graph
from ..reading import loads
from ..writing import dumps
from .aligning import align_three
from .conflicts import Conflict, with_conflicts
from .faults import faults
from .layout import without_strays
from .lines import merged_lines
from .parts import (
    ABSENT,
    CONFLICTS,
    At,
    Tree,
    at_part,
    is_list,
    is_tree,
    is_whole,
    like,
    local,
    names_of,
    parts_of,
    put_part,
    same,
    text_of,
)
from .references import LINKED, references, taken_away

Sides = tuple[Any, Any, Any]
"""A part in the base, in ours and in theirs."""


@dataclass(frozen=True)
class Merged:
    """The canonical text of what both sides made, and what is to be decided."""

    text: str
    conflicts: tuple[Conflict, ...]


def merged(base: Graph, ours: Graph, theirs: Graph) -> Merged:
    """What both sides made of the base, as it would be saved. Files of groups are not read.

    Raises GraphError for what cannot be saved.
    """
    base, ours, theirs = align_three(base, ours, theirs)
    sides = (parts_of(base), parts_of(ours), parts_of(theirs))
    work = _Merging()
    parts = work.part((), sides)
    try:
        while wrong := [at for at in faults(_graph(parts), ours, theirs) if at not in work.found]:
            for at in wrong:
                parts = put_part(parts, at, work.undecided(at, tuple(at_part(side, at) for side in sides)))
        text = dumps(_graph(with_conflicts(parts, work.found)))
    except HalationError:  # parts that go together in no way that can be read
        work = _Merging()
        for name in names_of(iter(sides)):
            one = tuple(side.get(name, ABSENT) for side in sides)
            if not same(one[1], one[2]):
                work.undecided((name,), one)
        text = dumps(_graph(with_conflicts(sides[1], work.found)))
    return Merged(text, tuple(work.found.values()))


def _graph(parts: Tree) -> Graph:
    return loads(text_of(parts), follow=False)


@dataclass
class _Merging:
    """One merge. `held` is what the sides fight over in the graph at hand: see `taken_away`."""

    found: dict[At, Conflict] = field(default_factory=dict[At, Conflict])
    held: frozenset[str] = frozenset()

    def part(self, at: At, sides: Sides) -> Any:
        """What becomes of a part."""
        base, ours, theirs = sides
        here = local(at)
        if same(ours, theirs):
            return ours
        if len(here) == 1 and here[0] in LINKED and self.held:
            return self.inside(at, sides)
        if len(here) == 2 and self.is_held(here, sides):
            return self.undecided(at, sides)
        if same(theirs, base) or same(ours, base):
            return ours if same(theirs, base) else theirs
        if here[:1] == ("ui",):
            return self.ui(at, sides)
        if here[:1] == (CONFLICTS,) and len(here) > 1:
            return theirs if ours is ABSENT else ours
        if is_whole(at, *sides):
            return self.decided(at, sides)
        if not here:
            return self.body(at, sides)
        made = self.inside(at, sides)
        keyless = here[0] == "animation" and len(here) == 2 and "keys" in made and not made["keys"]
        return self.undecided(at, sides) if keyless else made

    def body(self, at: At, sides: Sides) -> Any:
        """What becomes of a graph, or of that of a group."""
        outer, self.held = self.held, taken_away(*(part if is_tree(part) else {} for part in sides))
        made = self.inside(at, sides)
        self.held = outer
        return without_strays(made, sides[0])

    def inside(self, at: At, sides: Sides) -> Any:
        """The same part by part. What has no parts left is absent where a side has it so."""
        trees = tuple(part if is_tree(part) else {} for part in sides)
        made: Tree = {}
        for key in names_of(iter(trees)):
            base, ours, theirs = (tree.get(key, ABSENT) for tree in trees)
            part = self.part((*at, key), (base, ours, theirs))
            if part is not ABSENT:
                made[key] = part
        return ABSENT if not made and ABSENT in sides else like(made, trees[1] or trees[2])

    def is_held(self, here: At, sides: Sides) -> bool:
        """True for an entry that is, or builds on, what the sides fight over."""
        section, name = str(here[0]), str(here[1])
        built = (references(section, name, part) for part in sides) if section in LINKED else ()
        return any(self.held & one for one in built)

    def decided(self, at: At, sides: Sides) -> Any:
        """A part that both changed: code may go together line by line."""
        here, (base, ours, theirs) = local(at), sides
        is_code = len(here) == 3 and here[0] == "nodes" and here[2] == "code"
        if is_code and is_list(base) and is_list(ours) and is_list(theirs):
            lines = merged_lines(base, ours, theirs)
            return self.undecided(at, sides) if lines is None else lines
        return self.undecided(at, sides)

    def ui(self, at: At, sides: Sides) -> Any:
        """What becomes of the layout; only words may need a decision."""
        if all(is_tree(part) or part is ABSENT for part in sides) and not (len(local(at)) == 3 and ABSENT in sides[1:]):
            return self.inside(at, sides)
        words = local(at)[1:2] in (("comments",), ("frames",)) and all(isinstance(part, str) for part in sides[1:])
        if words:
            return self.undecided(at, sides)
        return sides[2] if sides[1] is ABSENT else sides[1]

    def undecided(self, at: At, sides: Sides) -> Any:
        """Ours stays, and a conflict is noted."""
        self.found[at] = Conflict(at, *sides)
        return sides[1]
