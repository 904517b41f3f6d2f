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
    kept = frozenset(program.kept_refs)
    found = dict(enumerate(passes))
    readers: dict[Ref, dict[int, None]] = {}
    for number, one in found.items():
        for ref in one.reads:
            readers.setdefault(ref, {})[number] = None
    for number in range(len(passes)):
        one = found[number]
        if len(one.writes) != 1 or one.writes[0] in kept or not _is_cheap(program, one, library):
            continue
        asking = {reader: found[reader] for reader in readers[one.writes[0]]}
        if len(asking) > MAX_READERS or not all(
            _can_compute(program, reader, one.writes[0]) for reader in asking.values()
        ):
            continue
        made = {at: _merge_into_reader(program, one, reader) for at, reader in asking.items()}
        more = sum(len(made[at].reads) - len(reader.reads) for at, reader in asking.items())
        if more >= STORE_COST + len(one.reads) or not all(fits(program, reader, target) for reader in made.values()):
            continue
        found |= made
        del found[number]
        for read in one.reads:
            readers[read] = {at: None for at in (*readers[read], *made) if at != number}
    return tuple(found.values())


def _is_cheap(program: LoweredProgram, one: PassGroup, library: Library) -> bool:
    ops = [program.ops[index] for index in one.members]
    return len(ops) <= MAX_RECOMPUTED and all(op.is_cheap(library) for op in ops)


def _can_compute(program: LoweredProgram, reader: PassGroup, ref: Ref) -> bool:
    """True if a pass wants each pixel of a picture for one of its own, and can compute it there."""
    root, size = program.ops[reader.root], program.shape(ref).size
    if not root.takes_producers or size != root.find_producer_size(program.ops):
        return False
    return not root.is_pointwise or not looks_around(program.ops, reader, ref)


def _merge_into_reader(program: LoweredProgram, one: PassGroup, reader: PassGroup) -> PassGroup:
    """A pass that also does the work of one that it reads."""
    reads = dict.fromkeys((*(ref for ref in reader.reads if ref not in one.writes), *one.reads))
    return PassGroup(
        (*order_members(program.ops, one.members, reader.members[:-1]), reader.root), tuple(reads), reader.writes
    )
