"""What all rewrites must know of a pass: whether a device can run it, and the order of its operations."""

from __future__ import annotations

from collections.abc import Iterable

from ..ir import LoweredProgram, Op, PictureShape, Ref
from ..target import Target
from .fuse import MAX_MEMBERS, MAX_UNIFORMS, PassGroup, count_tables


def fits(program: LoweredProgram, group: PassGroup, target: Target) -> bool:
    """True if a pass of pointwise operations is within the limits of a device, and can still load from images."""
    reads, writes = len(group.reads), len(group.writes)
    if target.loads_images and not target.has_images_for(reads + writes):
        return False
    most = target.max_images if target.form == "compute" else target.max_targets
    return (
        reads + count_tables(program.ops, group.members) <= target.max_inputs
        and writes <= most
        and len(group.members) <= MAX_MEMBERS
        and sum(program.ops[index].uniform_floats for index in group.members) <= MAX_UNIFORMS
    )


def operations_fit(program: LoweredProgram, target: Target) -> bool:
    """True if no pass can be too large for a device, whatever is fused: no picture of any operation is, and the device
    has all the memory that it needs. A pass writes no more at once than its last operation, or is checked by `fits`.
    """
    if target.memory:
        return False
    most = min(target.max_images, target.max_targets)
    return all(len(op.shapes) <= most and _is_storable(op.shapes, target) for op in program.ops)


def _is_storable(shapes: tuple[PictureShape, ...], target: Target) -> bool:
    return all(max(shape.size) <= target.max_size for shape in shapes)


def order_members(ops: tuple[Op, ...], *members: Iterable[int]) -> tuple[int, ...]:
    """The operations of several passes in one order. Those that read neighbors, from textures alone, go first."""
    indices = {index for group in members for index in group}
    return tuple(sorted(indices, key=lambda index: (ops[index].is_pointwise, index)))


def looks_around(ops: tuple[Op, ...], group: PassGroup, ref: Ref) -> bool:
    """True if a pass reads more of a picture than its own pixel."""
    return any(ref in ops[index].reads() for index in group.members if not ops[index].is_pointwise)
