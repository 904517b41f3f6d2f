"""Pictures that go on beyond their frame.

As in OpenEXR, a picture has a display window, its frame, and a data window: the pixels that there are. A graph whose
settings have an `overscan` keeps data windows through all of its nodes: what a node moved out of the frame, or a
renderer made around it, is still there for the next one. Without `overscan` every picture ends at its frame.

A shader counts pixels from the top left one of the frame on, and sizes are those of the frame, whatever the data window
is. So functions of nodes know nothing of it: they are evaluated at more pixels, some of them below 0.

Three steps lead from a lowered program to what is made:

1. `add_data_windows` goes from the inputs to the outputs. A file says its own data window, and a formula has pixels
   everywhere. A function of one pixel has those of what it reads; noise over a picture ends where the picture does. A
   blur that takes outside to be black grows the window, and a placement moves it by its matrix. Nodes that warp a
   picture may show something of it everywhere, and the camera of a scene sees what lies around its frame. Nothing goes
   further than the overscan.
2. Passes are found. Operations share one only if their data windows are the same, so no function is evaluated where its
   inputs have ended, and its result is not 0.
3. `add_extents` goes back from the outputs, which are the frame: of each picture only those pixels of the data window
   are made that somebody reads. So overscan costs nothing where nothing is brought back.

Reading beyond a data window is what it was at the frame: the edge mode says what is there. The modes that repeat a
picture repeat its frame.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence, Set
from functools import reduce, singledispatch
from types import MappingProxyType

from halation.nodes import Affine, Size, glsl_type
from msgspec import Struct
from msgspec.structs import replace

from .areas import Neighborhood, Region
from .fusion.fuse import PassGroup
from .ir import (
    Call,
    Convolve,
    ExternalProgram,
    Gather,
    HistoryRead,
    HostCall,
    LoweredProgram,
    Op,
    Parameter,
    Placement,
    Raster,
    Read,
    Ref,
)
from .tiling.regions import find_regions

_SINGULAR = 1e-12
"""A determinant that is 0 but for the rounding of doubles: the picture is a millionth of its size along both sides."""

_ROUNDING = 1e-6
"""Pixels by which the edge of a data window may be off after a matrix in doubles, and still lie on a pixel's edge."""


def add_data_windows(program: LoweredProgram, overscan: float, whole: Set[str] = frozenset()) -> LoweredProgram:
    """The program with the data windows of its pictures, which go `overscan` heights beyond the frame at most.

    Outputs end at their frame, except those in `whole`. One that others read beyond it gets a copy that ends there.
    """
    return _crop_outputs(replace(program, data_windows=_find_data_windows(program, overscan, whole)), whole)


def add_extents(program: LoweredProgram, passes: Sequence[PassGroup], whole: Set[str] = frozenset()) -> LoweredProgram:
    """The program with the pixels that these passes make of each picture: of outputs the frame, of `whole` ones all."""
    requested = {ref: Region.whole(program.shape(ref).size) for ref in program.kept_refs}
    requested |= {ref: program.data_window(ref) for name, ref in program.outputs.items() if name in whole}
    # Nobody knows yet what the next frame will read.
    requested |= {ref: program.data_window(ref) for ref in program.memories.values()}
    extents: dict[Ref, Region] = {}
    for ref, region in find_regions(program, passes, requested).items():
        frame = Region.whole(program.shape(ref).size)
        region = program.data_window(ref) if program.ops[ref.op].is_memory else region
        if not frame.contains(region):
            extents[ref] = frame.union(region)
    return replace(program, extents=MappingProxyType(extents))


def _find_data_windows(program: LoweredProgram, overscan: float, whole: Set[str]) -> MappingProxyType[Ref, Region]:
    """The data windows that are not the frame. All pictures of an operation have the same."""
    tables = _find_tables(program)
    ending = _find_ending(program, whole) | tables
    known = _Pictures(program, windows := dict[Ref, Region](), boundless := set[int](), tables)
    for index, op in enumerate(program.ops):
        if index in ending or op.size == (1, 1):
            continue
        frame = Region.whole(op.size)
        most = frame.grow(math.ceil(overscan * op.size[1]))
        window = _find_window(op, known, most)
        if window is None:
            boundless.add(index)
        window = most if window is None else frame.union(window).intersect(most)
        if window != frame:
            windows |= {Ref(index, output): window for output in range(op.outputs)}
    return MappingProxyType(windows)


class _Pictures(Struct, frozen=True):
    """The data windows that were found so far; operations in `boundless` have pixels wherever they are asked for.

    What is drawn from `tables` alone, such as a mask from the points of its outline, has too.
    """

    program: LoweredProgram
    windows: Mapping[Ref, Region]
    boundless: Set[int]
    tables: Set[int]

    def find_size(self, ref: Ref) -> Size:
        return self.program.shape(ref).size

    def find_window(self, ref: Ref) -> Region:
        return self.windows.get(ref) or Region.whole(self.find_size(ref))

    def is_bounded(self, ref: Ref) -> bool:
        """False for numbers and other generated pictures, which end nowhere."""
        return self.find_size(ref) != (1, 1) and ref.op not in self.boundless and ref.op not in self.tables


def _find_tables(program: LoweredProgram) -> set[int]:
    """The operations that make numbers for others, not pictures: from numbers alone, and read anywhere by all."""
    numbers, looked_at = set[int](), {ref.op for ref in program.outputs.values()}
    for index, op in enumerate(program.ops):
        refs = {ref for ref in op.reads() if program.shape(ref).size != (1, 1)}
        if isinstance(op, Read):
            is_number = op.picture.pixels is not None
        else:
            is_number = isinstance(op, Gather) and bool(refs) and all(ref.op in numbers for ref in refs)
        if is_number:
            numbers.add(index)
        looked_at |= {ref.op for ref in refs if not op.reads_whole(ref, program.shape(ref).size)}
    return numbers - looked_at


def _find_ending(program: LoweredProgram, whole: Set[str]) -> set[int]:
    """The operations whose pictures end at their frame: somebody must get the frame of one and nothing more."""
    whole_refs = {ref for op in program.ops if isinstance(op, ExternalProgram) for ref in op.reads()}
    whole_refs |= {*_find_last(program, whole).values()}
    return {ref.op for ref in whole_refs}


def _find_last(program: LoweredProgram, whole: Set[str]) -> dict[str, Ref]:
    """The outputs of operations of which nobody needs anything beyond the frame."""
    read = {ref.op for op in program.ops for ref in op.reads()}
    read |= {ref.op for name, ref in program.outputs.items() if name in whole}
    read |= {ref.op for ref in program.memories.values()}
    return {name: ref for name, ref in program.outputs.items() if ref.op not in read}


def _crop_outputs(program: LoweredProgram, whole: Set[str]) -> LoweredProgram:
    """A program with copies of those outputs that go on beyond their frame and are not to. All other windows stay."""
    ops, outputs = list(program.ops), dict(program.outputs)
    last = {*_find_last(program, whole), *whole}
    for name, ref in program.outputs.items():
        if ref in program.data_windows and name not in last:
            shape = program.shape(ref)
            glsl = glsl_type(shape.channels)
            owner = program.ops[ref.op].owner
            ops.append(Call((shape,), owner, "primitive/convert", f"as_{glsl}", (Parameter(glsl, ref),)))
            outputs[name] = Ref(len(ops) - 1)
    return replace(program, ops=tuple(ops), outputs=MappingProxyType(outputs))


@singledispatch
def _find_window(op: Op, pictures: _Pictures, most: Region) -> Region | None:
    """The pixels that an operation has, of `most`, or None for pixels everywhere. Its frame is added to them."""
    return Region.whole(op.size)


@_find_window.register
def _(op: Raster, pictures: _Pictures, most: Region) -> Region | None:
    """A camera sees what lies around its frame as well."""
    return most


@_find_window.register
def _(op: Read, pictures: _Pictures, most: Region) -> Region | None:
    return op.data_window or Region.whole(op.size)


@_find_window.register
def _(op: HistoryRead, pictures: _Pictures, most: Region) -> Region | None:
    return op.data_window or Region.whole(op.size)


@_find_window.register
def _(op: HostCall, pictures: _Pictures, most: Region) -> Region | None:
    """All that it reads: a program on the processor gets pictures that are all as large as the largest."""
    refs = [ref for ref in op.reads() if pictures.is_bounded(ref) and pictures.find_size(ref) == op.size]
    return _unite([Region.whole(op.size), *map(pictures.find_window, refs)])


@_find_window.register
def _(op: Call, pictures: _Pictures, most: Region) -> Region | None:
    """The pixels of all that it reads, except of what has no end: noise over a picture ends where the picture does."""
    refs = [ref for ref in op.reads() if pictures.is_bounded(ref)]
    windows = [pictures.find_window(ref) for ref in refs if pictures.find_size(ref) == op.size]
    return _unite(windows) if windows else Region.whole(op.size) if refs else None


@_find_window.register
def _(op: Gather, pictures: _Pictures, most: Region) -> Region | None:
    """Where it reads something else than what the edge mode invents."""
    if op.is_indivisible:
        return Region.whole(op.size)
    refs = {item: item.operand for item in op.accessors if isinstance(item.operand, Ref)}
    read = {item: ref for item, ref in refs.items() if pictures.is_bounded(ref)}
    if not read:
        return None
    if op.warps:
        return most
    windows = [Region.whole(op.size)]
    if op.ends_as is not None and op.ends_as[0].op not in pictures.boundless:
        ((_, ref),) = read.items()
        other, axis = pictures.find_window(op.ends_as[0]), op.ends_as[1]
        spans = (
            (other.across, pictures.find_window(ref).down)
            if axis == 0
            else (pictures.find_window(ref).across, other.down)
        )
        return _unite([*windows, Region.of(*spans)])
    for item, ref in read.items():
        window, size = pictures.find_window(ref), pictures.find_size(ref)
        if item.around:
            windows.append(_follow(item.around, window, size, op.size, grows=item.around.shows))
        elif size == op.size:
            windows.append(window)
    return _unite(windows)


@_find_window.register
def _(op: Placement, pictures: _Pictures, most: Region) -> Region | None:
    """Where the placed picture lies; with an edge mode that continues it, everywhere."""
    (item,) = op.accessors
    if op.edge != "black" or item.around is None or not isinstance(item.operand, Ref):
        return most
    window, size = pictures.find_window(item.operand), pictures.find_size(item.operand)
    return _follow(item.around, window, size, op.size, grows=True)


@_find_window.register
def _(op: Convolve, pictures: _Pictures, most: Region) -> Region | None:
    """Along its axis the pixels of which a tap, or without black outside the middle one, lies in what it reads.

    A smaller picture has all of them: those around it are what the edge mode makes, and the same all the way outward.
    """
    if op.image.op in pictures.boundless:
        return None
    read, taps = pictures.find_window(op.image), len(op.weights)
    if read == Region.whole(pictures.find_size(op.image)) and op.edge != "black":
        return Region.whole(op.size)
    spans = [read.across, read.down]
    first, end = spans[op.axis]
    low, high = (
        (op.origin, op.origin + taps - 1) if op.edge == "black" or op.stride > 1 else (op.origin + taps // 2,) * 2
    )
    spans[op.axis] = (math.ceil((first - high) / op.stride), math.floor((end - 1 - low) / op.stride) + 1)
    return Region.of(*spans)


def _follow(around: Neighborhood, read: Region, size: Size, own: Size, *, grows: bool) -> Region:
    """The pixels of a picture of the size `own` that are read from within `read`; if it `grows`, also those around."""
    if not grows and read == Region.whole(size):
        return Region.whole(own)
    radius = around.radius if grows else (0.0, 0.0)
    inverse = _invert(around.matrix)
    if inverse is None or not all(map(math.isfinite, radius)):
        return read.union(Region.whole(own))
    a, b, x, c, d, y = inverse
    corners = [
        (a * i + b * j + x, c * i + d * j + y)
        for i in (read.x - radius[0], read.across[1] + radius[0])
        for j in (read.y - radius[1], read.down[1] + radius[1])
    ]
    across, down = ((min(places), max(places)) for places in zip(*corners, strict=True))
    if grows:
        return Region.of(*((math.floor(low), math.ceil(high)) for low, high in (across, down)))
    return Region.of(*((math.ceil(low - _ROUNDING), math.floor(high + _ROUNDING)) for low, high in (across, down)))


def _invert(matrix: Affine) -> Affine | None:
    """The matrix that leads back; None if there is none."""
    a, b, x, c, d, y = matrix
    determinant = a * d - b * c
    if not (math.isfinite(determinant) and abs(determinant) > _SINGULAR):
        return None
    e, f, g, h = d / determinant, -b / determinant, -c / determinant, a / determinant
    return (e, f, -(e * x + f * y), g, h, -(g * x + h * y))


def _unite(windows: Sequence[Region]) -> Region:
    return reduce(Region.union, windows)
