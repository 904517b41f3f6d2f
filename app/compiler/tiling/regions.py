"""Which part of every picture is needed for a part of the outputs.

Everything that an operation reads for a rectangle of its own pixels lies in a rectangle too, known before anything
runs; what reads anywhere needs all. So a picture can be made tile by tile, each with just the overlap that it needs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from types import MappingProxyType

from halation.nodes import Edge
from msgspec.structs import replace

from ..areas import Region, Span, inside
from ..fusion.fuse import PassGroup
from ..ir import BLOCK, Accessor, Call, Convolve, ExternalProgram, Gather, History, Op, Program, Raster, Reduce, Ref


def needed(
    program: Program, passes: Sequence[PassGroup], wanted: Mapping[Ref, Region], there: Set[Ref] = frozenset()
) -> dict[Ref, Region]:
    """The region of every texture of these passes, so that the regions `wanted` can be made.

    A pass makes the same region of all that it writes. What is `there` stays whole, as does all that it was made of:
    so it is still what it was.
    """
    found = dict(wanted)
    for fused in reversed(passes):
        made = [ref for ref in fused.writes if ref in found]
        if not made:
            continue
        known = all(ref in there for ref in made)
        size = program.shape(made[0]).size
        whole = known or any(made_whole(program.ops[index]) for index in fused.members)
        region = Region.whole(size) if whole else _joined([found[ref] for ref in made])
        found |= {
            ref: region if program.shape(ref).size == size else Region.whole(program.shape(ref).size)
            for ref in fused.writes
        }
        for ref, part in _read(program, fused, region).items():
            part = Region.whole(program.shape(ref).size) if known else part
            found[ref] = found[ref].with_(part) if ref in found else part
    return found


def focused(program: Program, passes: Sequence[PassGroup], region: Region, there: Set[Ref] = frozenset()) -> Program:
    """The same program, which makes only a region of its outputs, as far as that lies in them.

    The parts that it makes may be larger, where something else reads an output. What is remembered is whole, and so is
    what is `there` already.
    """
    wanted: dict[Ref, Region] = {}
    for ref in program.outputs.values():
        width, height = program.shape(ref).size
        wanted[ref] = Region.of(inside(region.across, width, "clamp"), inside(region.down, height, "clamp"))
    wanted |= {ref: Region.whole(program.shape(ref).size) for ref in program.memories.values()}
    found = needed(program, passes, wanted, there)
    made = {ref for fused in passes for ref in fused.writes}
    kept = {ref for ref in found if ref not in made and (ref in there or isinstance(program.ops[ref.op], History))}
    parts = {ref: part for ref, part in found.items() if ref not in kept and part.size != program.shape(ref).size}
    return replace(program, windows=MappingProxyType(parts))


def _read(program: Program, fused: PassGroup, region: Region) -> dict[Ref, Region]:
    """What a pass reads to write a region."""
    inner = dict.fromkeys(fused.writes, region)
    for index in reversed(fused.members):
        op = program.ops[index]
        own = [inner[ref] for number in range(len(op.shapes)) if (ref := Ref(index, number)) in inner]
        for ref, part in reads(program, op, _joined(own) if own else region):
            inner[ref] = inner[ref].with_(part) if ref in inner else part
    return {ref: inner[ref] for ref in fused.reads}


def reads(program: Program, op: Op, region: Region) -> Iterator[tuple[Ref, Region]]:
    """What an operation reads for a region of its own pixels, by picture; one may come several times."""
    for ref in op.reads():
        yield ref, _part(program, op, ref, region)


def reads_all(program: Program, op: Op, ref: Ref) -> bool:
    """True if an operation may read a picture anywhere, whatever region of its own is wanted."""
    size = program.shape(ref).size
    if isinstance(op, Gather):
        return any(item.operand == ref and item.around is None for item in op.accessors)
    return isinstance(op, ExternalProgram) or (isinstance(op, Call) and size != op.size)


def made_whole(op: Op) -> bool:
    """True for what is always made as a whole: its program has no parts, or outputs of several sizes."""
    return isinstance(op, ExternalProgram | Raster) or len({shape.size for shape in op.shapes}) > 1


def _part(program: Program, op: Op, ref: Ref, region: Region) -> Region:
    size = program.shape(ref).size
    whole = Region.whole(size)
    if size == (1, 1) or reads_all(program, op, ref):
        return whole
    if isinstance(op, Gather):
        found = [_around(item, size, op.edge, region) for item in op.accessors if item.operand == ref]
        return _joined(found)
    if isinstance(op, Convolve):
        spans = [region.across, region.down]
        first, end = spans[op.axis]
        span = (first * op.stride + op.origin, (end - 1) * op.stride + op.origin + len(op.weights))
        spans[op.axis] = inside(span, size[op.axis], op.edge)
        return Region.of(spans[0], spans[1])
    if isinstance(op, Reduce):
        return Region.of(_blocks(region.across, size[0]), _blocks(region.down, size[1]))
    return region if isinstance(op, Call) else whole


def _around(item: Accessor, size: tuple[int, int], edge: Edge, region: Region) -> Region:
    assert item.around is not None
    across, down = item.around.read(region)
    return Region.of(inside(across, size[0], edge), inside(down, size[1], edge))


def _blocks(span: Span, length: int) -> Span:
    return span[0] * BLOCK, min(span[1] * BLOCK, length)


def _joined(regions: list[Region]) -> Region:
    found = regions[0]
    for region in regions[1:]:
        found = found.with_(region)
    return found
