"""Lets each reader of a cheap pointwise pass compute its pixels again, in place of storing them for all readers."""

from __future__ import annotations

from ..ir import LoweredProgram, Ref
from ..library import Library
from ..target import Target
from .fuse import PassGroup
from .limits import fits, looks_around, order_members

MAX_READERS = 3
"""Readers that compute a pass again. With 1 the presets store 1 % more megapixels; more than 3 change nothing there."""

MAX_RECOMPUTED = 4
"""Operations that are computed again. The presets need 2; a few more are still cheaper than a store."""

STORE_COST = 4
"""A picture that is stored takes as long as so many that are read: measured on the software rasterizer. Plans of the
presets are the same with 2 to 8."""


def recompute(
    program: LoweredProgram, passes: tuple[PassGroup, ...], target: Target, library: Library
) -> tuple[PassGroup, ...]:
    """Drop passes that their readers can compute, if that adds fewer reads than it saves.

    A pass is dropped only if all readers can take it in: if one still needed the picture, it would have to be stored
    all the same.
    """
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
    """True if a pass reads each pixel of a picture for the same pixel of its own, and can compute it there."""
    root, size = program.ops[reader.root], program.shape(ref).size
    if not root.takes_producers or size != root.find_producer_size(program.ops):
        return False
    if not root.is_pointwise:
        return True
    return program.end_alike(reader.root, ref.op) and not looks_around(program.ops, reader, ref)


def _merge_into_reader(program: LoweredProgram, group: PassGroup, reader: PassGroup) -> PassGroup:
    """A pass that also computes what another pass made for it."""
    reads = dict.fromkeys((*(ref for ref in reader.reads if ref not in group.writes), *group.reads))
    return PassGroup(
        (*order_members(program.ops, group.members, reader.members[:-1]), reader.root), tuple(reads), reader.writes
    )
