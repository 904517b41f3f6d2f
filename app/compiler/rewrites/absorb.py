"""A convolution is stored as what its only reader makes of it, if that is cheap and reads nothing else."""

from __future__ import annotations

from ..fuse import Fused, kept_refs
from ..ir import Call, Convolve, Program, Ref
from ..library import Library
from ..target import Target

MOST = 3
"""Operations that a convolution takes in: they are written once for each of the pixels that it makes at a time."""


def absorb(program: Program, passes: tuple[Fused, ...], target: Target, library: Library) -> tuple[Fused, ...]:
    """Leave out passes that only read what a convolution makes: it does their work, and what it made is not stored."""
    kept = frozenset(kept_refs(program))
    readers: dict[Ref, list[Fused]] = {}
    for one in passes:
        for ref in one.reads:
            readers.setdefault(ref, []).append(one)
    taken: dict[Fused, Fused] = {}
    for one in passes:
        root = program.ops[one.root]
        if not isinstance(root, Convolve) or root.stride > 1 or one.writes[0] in kept:
            continue
        reader, *others = readers.get(one.writes[0], [])
        if not others and _suits(program, one, reader, library):
            taken[reader] = Fused((*one.members, *reader.members), one.reads, reader.writes)
    gone = {made.members[0] for made in taken.values()}
    return tuple(taken.get(one, one) for one in passes if one.members[0] not in gone or one in taken)


def _suits(program: Program, one: Fused, reader: Fused, library: Library) -> bool:
    ops = [program.ops[index] for index in reader.members]
    return reader.reads == one.writes and len(ops) <= MOST and all(
        isinstance(op, Call) and op.size == program.ops[one.root].size and not op.program
        and library.cheap(op.shader, op.function, op.owner) for op in ops
    )
