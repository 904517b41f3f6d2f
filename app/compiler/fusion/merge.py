"""Merges passes of pointwise operations that read the same pictures into one that writes several pictures.

If a pass reads a picture of another one at its own pixel, the merged pass does not load it, and does not even store it
if nothing else reads it. Two passes that read the same picture load it once when merged. The merged pass runs in the
place of the earlier one if all pictures that it reads exist by then; else in the place of the later one, if nothing
reads its pictures before that.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from halation.nodes import Size
from msgspec import Struct

from ..ir import LoweredProgram, Ref
from ..library import Library
from ..target import Target
from .fuse import PassGroup
from .limits import fits, looks_around, order_members

MAX_READERS_TRIED = 4
"""Passes that read the same picture and are tried as partners of another one, the latest first. Hundreds of passes may
read one file, and trying all takes quadratic time. The presets have 7 passes more with 1, 1 more with 2, and no fewer
with any number above 4."""


def merge(
    program: LoweredProgram, passes: tuple[PassGroup, ...], target: Target, library: Library
) -> tuple[PassGroup, ...]:
    """Merge passes as far as `target` allows. They stay in an order in which each comes after what it reads."""
    candidates = _PassMerger(program, passes, target).run()
    return tuple(group.fused for group in candidates)


def split_by_result(program: LoweredProgram, fused: PassGroup) -> tuple[PassGroup, ...]:
    """The passes that would write the results of one operation each, in place of a pass that writes several."""
    roots = tuple(dict.fromkeys(ref.op for ref in fused.writes))
    return (fused,) if len(roots) == 1 else tuple(_extract_part(program, fused, root) for root in roots)


def _extract_part(program: LoweredProgram, fused: PassGroup, root: int) -> PassGroup:
    """The part of a pass that an operation needs."""
    needed, reads, all_reads = {root}, set[Ref](), frozenset(fused.reads)
    for index in reversed(fused.members):
        if index in needed:
            for ref in program.ops[index].reads():
                if ref in all_reads:
                    reads.add(ref)
                else:
                    needed.add(ref.op)
    return PassGroup(
        tuple(index for index in fused.members if index in needed),
        tuple(ref for ref in fused.reads if ref in reads),
        tuple(ref for ref in fused.writes if ref.op == root),
    )


class _MergeCandidate(Struct, frozen=True):
    """One pass, or several that were merged. `place` says when it runs; one that is not `open` is never merged."""

    place: int
    members: tuple[int, ...]
    reads: dict[Ref, None]
    writes: dict[Ref, None]
    size: Size
    open: bool

    @property
    def fused(self) -> PassGroup:
        return PassGroup(self.members, tuple(self.reads), tuple(self.writes))


class _PassMerger:
    """The state of merging: which group makes and which groups read each picture, by the numbers of groups."""

    def __init__(self, program: LoweredProgram, passes: tuple[PassGroup, ...], target: Target) -> None:
        self.program, self.ops, self.target = program, program.ops, target
        self.kept_refs = frozenset(program.kept_refs)
        self.groups: dict[int, _MergeCandidate] = {}
        self.makers: dict[Ref, int] = {}
        self.readers: dict[Ref, dict[int, None]] = {}
        self.visited_readers: dict[Ref, dict[int, None]] = {}
        """The readers of each picture that were visited so far."""
        for place, group in enumerate(passes):
            size, reads, writes = self.ops[group.root].size, dict.fromkeys(group.reads), dict.fromkeys(group.writes)
            self._add_group(place, _MergeCandidate(place, group.members, reads, writes, size, self._is_open(group)))

    def run(self) -> list[_MergeCandidate]:
        for number in list(self.groups):
            while number >= 0:
                for ref in self.groups[number].reads:
                    self.visited_readers.setdefault(ref, {})[number] = None
                number = self._merge_with_partner(number)
        return sorted(self.groups.values(), key=lambda group: group.place)

    def _is_open(self, group: PassGroup) -> bool:
        """True for a pass of pointwise operations and light gathers, which makes each pixel independently."""
        root = self.ops[group.root]
        if not root.is_inlinable:
            return False
        return all(self.program.shape(ref).size == root.size for ref in group.writes)

    def _add_group(self, number: int, group: _MergeCandidate) -> None:
        self.groups[number] = group
        self.makers |= dict.fromkeys(group.writes, number)
        for ref in group.reads:
            self.readers.setdefault(ref, {})[number] = None

    def _remove_group(self, number: int) -> None:
        group = self.groups.pop(number)
        for ref in group.reads:
            del self.readers[ref][number]
            self.visited_readers[ref].pop(number, None)

    def _merge_with_partner(self, number: int) -> int:
        """Merge a group with another one; the number of the merged group, or -1 if there is no partner."""
        for partner in dict.fromkeys(self._find_partners(number)):
            first, last = sorted((number, partner), key=lambda group: self.groups[group].place)
            merged = self._merge_pair(first, last)
            if merged and fits(self.program, merged.fused, self.target):
                self._remove_group(first)
                self._remove_group(last)
                self._add_group(last, merged)
                return last
        return -1

    def _find_partners(self, number: int) -> Iterator[int]:
        """Visited groups that share pictures with a group: those that make its pictures, then those that read them."""
        group = self.groups[number]
        if not group.open:
            return
        for ref in reversed(group.reads):
            if ref in self.makers and self._can_pair(group, self.makers[ref]):
                yield self.makers[ref]
        for ref in group.reads:
            if self.program.shape(ref).size == group.size:
                latest = islice(reversed(self.visited_readers[ref]), MAX_READERS_TRIED)
                yield from (reader for reader in latest if reader != number and self._can_pair(group, reader))

    def _can_pair(self, group: _MergeCandidate, partner: int) -> bool:
        other = self.groups[partner]
        return other.open and other.size == group.size and self.program.end_alike(group.members[-1], other.members[-1])

    def _merge_pair(self, first: int, last: int) -> _MergeCandidate | None:
        """Two groups merged into one, if there is a place where it can run."""
        early, late = self.groups[first], self.groups[last]
        place = self._find_place(first, last)
        if place < 0 or any(looks_around(self.ops, late.fused, ref) for ref in early.writes if ref in late.reads):
            return None
        members = order_members(self.ops, early.members, late.members)
        if not self.ops[members[-1]].is_pointwise:
            return None
        reads = dict.fromkeys(ref for ref in (*early.reads, *late.reads) if ref not in early.writes)
        writes = dict.fromkeys(
            ref for ref in (*early.writes, *late.writes) if self._is_read_by_others(ref, first, last)
        )
        return _MergeCandidate(place, members, reads, writes, early.size, True)

    def _is_read_by_others(self, ref: Ref, *groups: int) -> bool:
        """True if a picture is kept, or if other groups than these read it."""
        return ref in self.kept_refs or any(reader not in groups for reader in self.readers.get(ref, ()))

    def _find_place(self, first: int, last: int) -> int:
        """Where two groups can run as one; -1 if nowhere."""
        early, late = self.groups[first], self.groups[last]
        makers = (self.makers[ref] for ref in late.reads if ref in self.makers)
        if all(number == first or self.groups[number].place < early.place for number in makers):
            return early.place
        readers = (reader for ref in early.writes for reader in self.readers.get(ref, ()) if reader != last)
        return late.place if all(self.groups[reader].place > late.place for reader in readers) else -1
