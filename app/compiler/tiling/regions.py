"""Finds the part of every picture that is needed for a part of the outputs.

For a rectangle of its own pixels an operation reads a rectangle of each input, which is known before anything runs; one
that reads anywhere needs the whole input. So a picture can be made tile by tile, each with only the overlap it needs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from types import MappingProxyType

from msgspec.structs import replace

from ..areas import Region, clip_region
from ..fusion.fuse import PassGroup
from ..ir import LoweredProgram, Ref


def find_regions(
    program: LoweredProgram,
    passes: Sequence[PassGroup],
    requested: Mapping[Ref, Region],
    cached_refs: Set[Ref] = frozenset(),
) -> dict[Ref, Region]:
    """The region of every texture of these passes from which the `requested` regions can be made.

    It lies in the data window of its picture. A pass makes the same region of all pictures that it writes. Those in
    `cached_refs` stay whole, and so does everything upstream of them, because their keys are those of whole pictures.
    """
    regions = dict(requested)
    for fused in reversed(passes):
        written = [ref for ref in fused.writes if ref in regions]
        if not written:
            continue
        is_there = all(ref in cached_refs for ref in written)
        size = program.shape(written[0]).size
        whole = is_there or any(program.ops[index].is_indivisible for index in fused.members)
        region = _unite([regions[ref] for ref in written])
        region = program.extent(written[0]).union(region) if whole else region
        regions |= {ref: region if program.shape(ref).size == size else program.extent(ref) for ref in fused.writes}
        for ref, part in _find_reads(program, fused, region).items():
            part = program.extent(ref) if is_there else part
            regions[ref] = regions[ref].union(part) if ref in regions else part
    return regions


def focus_program(
    program: LoweredProgram, passes: Sequence[PassGroup], region: Region, cached_refs: Set[Ref] = frozenset()
) -> LoweredProgram:
    """The same program, which makes only a region of its outputs, as far as it lies in them.

    It makes a larger part of an output that another operation reads. Memories are whole, and so are `cached_refs`.
    """
    requested: dict[Ref, Region] = {}
    for ref in program.outputs.values():
        window = program.data_window(ref)
        requested[ref] = clip_region(region.across, region.down, program.shape(ref).size, "clamp", window)
    requested |= {ref: Region.whole(program.shape(ref).size) for ref in program.memories.values()}
    regions = find_regions(program, passes, requested, cached_refs)
    written = {ref for fused in passes for ref in fused.writes}
    whole_refs = {
        ref for ref in regions if ref not in written and (ref in cached_refs or program.ops[ref.op].is_memory)
    }
    parts = {ref: part for ref, part in regions.items() if ref not in whole_refs and part != program.extent(ref)}
    return replace(program, windows=MappingProxyType(parts))


def _find_reads(program: LoweredProgram, fused: PassGroup, region: Region) -> dict[Ref, Region]:
    """The regions that a pass reads to write a region."""
    inner = dict.fromkeys(fused.writes, region)
    for index in reversed(fused.members):
        op = program.ops[index]
        own = [inner[ref] for number in range(op.outputs) if (ref := Ref(index, number)) in inner]
        for ref in op.reads():
            part = op.footprint(ref, program.shape(ref).size, _unite(own) if own else region, program.data_window(ref))
            inner[ref] = inner[ref].union(part) if ref in inner else part
    return {ref: inner[ref] for ref in fused.reads}


def _unite(regions: list[Region]) -> Region:
    union = regions[0]
    for region in regions[1:]:
        union = union.union(region)
    return union
