"""What cannot be made in tiles: pictures that must be whole and do not fit."""

from __future__ import annotations

from collections.abc import Sequence, Set

from halation.nodes import Size

from ...errors import DeviceError, describe_owner
from ..fusion.fuse import PassGroup
from ..ir import LoweredProgram, Ref
from ..target import Target


def check_whole_pictures(program: LoweredProgram, passes: Sequence[PassGroup], target: Target) -> None:
    """Raise DeviceError for a picture that must be whole and does not fit, and for nodes with memories."""
    for fused in passes:
        for op in (program.ops[index] for index in fused.members):
            refs = [
                ref for ref in fused.reads if ref in set(op.reads()) and op.reads_whole(ref, program.shape(ref).size)
            ]
            sizes = [program.shape(ref).size for ref in refs] + ([op.size] if op.is_indivisible else [])
            for size in sizes:
                if max(size) > target.max_size:
                    raise DeviceError(
                        f"{describe_owner(op.owner)}: it may need all {format_size(size)} pixels of a picture for one "
                        f"of its own, so they cannot be made in parts, and {target.name_in_sentences} holds "
                        f"{target.max_size} on a side; render smaller with --scale or --size",
                        node=op.owner,
                    )
    for port in program.memories:
        raise DeviceError(
            f"node '{port.node}': what it remembers of a frame must fit into memory as a whole; render smaller with "
            "--scale or --size, or give more with --memory",
            node=port.node,
        )


def check_extents(program: LoweredProgram, whole_refs: Set[Ref], why: str) -> None:
    """Raise DeviceError for a picture with pixels beyond its frame that must be assembled: only frames are."""
    beyond = [ref for ref in (*whole_refs, *program.outputs.values()) if ref in program.extents]
    if beyond:
        largest = max(beyond, key=lambda ref: count_pixels(program.extents[ref].size))
        owner, size = program.ops[largest.op].owner, format_size(program.extents[largest].size)
        raise DeviceError(
            f"{why}, and {describe_owner(owner)} makes {size} pixels with those beyond the frame, which must be whole; "
            "render smaller with --scale or --size, give more with --memory, or set a smaller overscan",
            node=owner,
        )


def format_size(size: Size) -> str:
    """Width x height."""
    return f"{size[0]}x{size[1]}"


def count_pixels(size: Size) -> int:
    """The pixels of a picture."""
    return size[0] * size[1]
