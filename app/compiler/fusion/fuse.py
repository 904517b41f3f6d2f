"""Second stage: decides which operations share a pass.

A pointwise operation joins its reader if nothing else reads it, both have the same size, and the pass stays within the
device's limits. A reduction takes in its producer too, because it reads every pixel exactly once. An operation that
reads neighbors joins a pointwise reader if it is light; the pictures that it reads itself must be textures.
"""

from __future__ import annotations

from collections.abc import Iterable

from msgspec import Struct

from ..ir import LoweredProgram, Op, Ref
from ..target import Target

MAX_MEMBERS = 48
"""Operations of a pass. The largest pass of the presets has 20, so more would save nothing there; with 16 or 8 the
presets have 1 and 21 passes more. Compile times grow faster than passes: llvmpipe takes 2 s for 192 pointwise
operations in passes of 48, 5 s in passes of 96, and 15 s in one pass."""

MAX_UNIFORMS = 512
"""Floats of uniforms of a pass: the least that OpenGL 4.3 guarantees for compute shaders
(MAX_COMPUTE_UNIFORM_COMPONENTS; 1024 for fragment shaders). Twice as many would save no pass of the presets."""


class PassGroup(Struct, frozen=True):
    """Operations of one pass in order, the root last; the pictures that it reads from textures and those it writes."""

    members: tuple[int, ...]
    reads: tuple[Ref, ...]
    writes: tuple[Ref, ...]

    @property
    def root(self) -> int:
        return self.members[-1]


def fuse(
    program: LoweredProgram, target: Target, *, enabled: bool = True, gathers: bool = True
) -> tuple[PassGroup, ...]:
    """Group the operations of `program` into passes, in order.

    `enabled=False` gives each operation a pass of its own, `gathers=False` only those that read neighbors.

    Operations are visited from the last to the first, so that the pass of every reader is known before its producer is
    considered: one visit decides. The other direction would have to merge whole passes.
    """
    ops, live = program.ops, _find_live(program)
    readers = _find_readers(ops, live)
    kept_refs = set(program.kept_refs)
    roots_by_op: dict[int, int] = {}
    members: dict[int, list[int]] = {}
    reads: dict[int, dict[Ref, None]] = {}
    uniforms: dict[int, int] = {}
    tables: dict[int, int] = {}
    for index in reversed(range(len(ops))):
        op = ops[index]
        if index not in live or op.is_source:
            continue
        outputs = [Ref(index, number) for number in range(op.outputs)]
        roots = {roots_by_op[reader] for ref in outputs for reader in readers.get(ref, ())}
        root = roots.pop() if len(roots) == 1 else index
        joins = (
            (op.is_pointwise or (gathers and op.is_inlinable))
            and root != index
            and not kept_refs.intersection(outputs)
            and _are_read_at_own_pixel(ops, outputs, readers)
        )
        if enabled and joins:
            joined = _join_reads(reads[root], outputs, op)
            floats = uniforms[root] + op.uniform_floats
            inputs = len(joined) + tables[root] + len(op.tables)
            if floats <= MAX_UNIFORMS and _fits(program, index, members[root], inputs, target):
                roots_by_op[index] = root
                uniforms[root] = floats
                tables[root] += len(op.tables)
                members[root].append(index)
                reads[root] = joined
                continue
        roots_by_op[index], members[index], uniforms[index] = index, [index], op.uniform_floats
        reads[index], tables[index] = dict.fromkeys(op.reads()), len(op.tables)
    return tuple(
        PassGroup(
            tuple(reversed(members[root])), tuple(reads[root]), tuple(_find_writes(ops, root, readers, kept_refs))
        )
        for root in sorted(members)
    )


def _find_live(program: LoweredProgram) -> set[int]:
    """Operations that an output needs."""
    live: set[int] = set()
    todo = [ref.op for ref in program.kept_refs]
    while todo:
        index = todo.pop()
        if index not in live:
            live.add(index)
            todo.extend(ref.op for ref in program.ops[index].reads())
    return live


def _find_readers(ops: tuple[Op, ...], live: set[int]) -> dict[Ref, list[int]]:
    readers: dict[Ref, list[int]] = {}
    for index in live:
        for ref in ops[index].reads():
            readers.setdefault(ref, []).append(index)
    return readers


def _are_read_at_own_pixel(ops: tuple[Op, ...], outputs: Iterable[Ref], readers: dict[Ref, list[int]]) -> bool:
    """True if all readers of these pictures read each pixel for the same pixel of their own."""
    return all(ops[reader].takes_producers for ref in outputs for reader in readers.get(ref, ()))


def _join_reads(outer: Iterable[Ref], outputs: list[Ref], op: Op) -> dict[Ref, None]:
    """What a pass reads after `op` has joined it."""
    return dict.fromkeys([*(ref for ref in outer if ref not in outputs), *op.reads()])


def count_tables(ops: tuple[Op, ...], members: Iterable[int]) -> int:
    """How many tables of color programs a pass reads at most."""
    return sum(len(ops[index].tables) for index in members)


def _fits(program: LoweredProgram, index: int, members: list[int], inputs: int, target: Target) -> bool:
    """Whether an operation can be part of the pass that these are members of, the root first."""
    ops, op, reader = program.ops, program.ops[index], program.ops[members[0]]
    if reader.is_pointwise and not program.end_alike(index, members[0]):
        return False
    if not reader.takes_producers or not (reader.is_pointwise or op.is_pointwise):
        return False
    same_size = reader.find_producer_size(ops) == op.size
    return same_size and len(members) < MAX_MEMBERS and inputs <= target.max_inputs


def _find_writes(ops: tuple[Op, ...], root: int, readers: dict[Ref, list[int]], kept_refs: set[Ref]) -> list[Ref]:
    """The outputs of the root that another pass reads, or that are kept."""
    outputs = [Ref(root, number) for number in range(ops[root].outputs)]
    return [ref for ref in outputs if ref in readers or ref in kept_refs]
