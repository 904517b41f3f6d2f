"""What is cheap and pointwise is computed by each pass that reads it, rather than stored for all of them."""

from __future__ import annotations

from ..ir import LoweredProgram, Ref
from ..library import Library
from ..target import Target
from .fuse import PassGroup
from .limits import fits, looks_around, order_members

MAX_READERS = 3
MAX_RECOMPUTED = 4
"""Operations that are computed again, at most."""

STORE_COST = 4
"""A picture that is stored takes as long as so many that are read: measured on the software rasterizer."""


def recompute(
    program: LoweredProgram, passes: tuple[PassGroup, ...], target: Target, library: Library
) -> tuple[PassGroup, ...]:
    """Leave out passes whose readers can do their work, where that costs fewer reads than it saves."""
    kept_refs = frozenset(program.kept_refs)
    groups = dict(enumerate(passes))
    readers: dict[Ref, dict[int, None]] = {}
    for number, group in groups.items():
        for ref in group.reads:
            readers.setdefault(ref, {})[number] = None
    for number in range(len(passes)):
        group = groups[number]
        if len(group.writes) != 1 or group.writes[0] in kept_refs or not _is_cheap(program, group, library):
            continue
        group_readers = {reader: groups[reader] for reader in readers[group.writes[0]]}
        if len(group_readers) > MAX_READERS or not all(
            _can_compute(program, reader, group.writes[0]) for reader in group_readers.values()
        ):
            continue
        merged = {at: _merge_into_reader(program, group, reader) for at, reader in group_readers.items()}
        added_reads = sum(len(merged[at].reads) - len(reader.reads) for at, reader in group_readers.items())
        if added_reads >= STORE_COST + len(group.reads) or not all(
            fits(program, reader, target) for reader in merged.values()
        ):
            continue
        groups |= merged
        del groups[number]
        for read in group.reads:
            readers[read] = {at: None for at in (*readers[read], *merged) if at != number}
    return tuple(groups.values())


def _is_cheap(program: LoweredProgram, group: PassGroup, library: Library) -> bool:
    ops = [program.ops[index] for index in group.members]
    return len(ops) <= MAX_RECOMPUTED and all(op.is_cheap(library) for op in ops)


def _can_compute(program: LoweredProgram, reader: PassGroup, ref: Ref) -> bool:
    """True if a pass wants each pixel of a picture for one of its own, and can compute it there."""
    root, size = program.ops[reader.root], program.shape(ref).size
    if not root.takes_producers or size != root.find_producer_size(program.ops):
        return False
    return not root.is_pointwise or not looks_around(program.ops, reader, ref)


def _merge_into_reader(program: LoweredProgram, group: PassGroup, reader: PassGroup) -> PassGroup:
    """A pass that also does the work of one that it reads."""
    reads = dict.fromkeys((*(ref for ref in reader.reads if ref not in group.writes), *group.reads))
    return PassGroup(
        (*order_members(program.ops, group.members, reader.members[:-1]), reader.root), tuple(reads), reader.writes
    )
