"""Plans pictures that the device, or the allowed memory, cannot hold: they are made tile by tile.

A tile needs only the parts of its inputs that lie around it: see `regions`. A picture that is read anywhere must be
whole, so it is made in an earlier stage, tile by tile as well, and assembled in memory. So the plan of a large picture
is a row of stages, each with many small plans, which share their programs.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from types import MappingProxyType

from halation.nodes import Size
from msgspec.structs import replace

from ...errors import DeviceError, describe_owner
from ..areas import Region
from ..explain import format_bytes
from ..fusion.fuse import PassGroup
from ..ir import LoweredProgram, Op, Ref, StoredResult
from ..library import Library
from ..plan import Plan, texture_bytes
from ..scheduling.schedule import count_peak_bytes, schedule
from ..target import Precision, Target
from .refusals import check_extents, check_whole_pictures, count_pixels, format_size
from .regions import find_regions
from .tiles import TileStage, Tiling

MIN_TILE = 8
"""The smallest side of a tile in pixels. A blur of sigma 1 already reads 4 pixels on each side, so that a tile of 8
reads four times the pixels that it makes; smaller ones would be nearly all overlap."""

SMALL_FRACTION = 16
"""A picture with so many times fewer pixels than the largest one is made whole, even if it need not be. Blurs and glows
read far around in pictures that were decimated, by 4 along each side at least; once these are whole, tiles of large
pictures need little overlap. A larger number keeps more of them in tiles, which saves memory and repeats work."""

USUAL_BYTES = 2**31
"""Bytes of textures for a tile if the user sets no limit; more, if a single pixel needs much of it. Chosen by
judgement: nearly every GPU has as much. With less, tiles are smaller and more of their work is overlap."""

MAX_TILES = 2**16
"""Tiles of a picture: 256 along each side. Chosen by judgement: every tile is planned and runs all passes, so that more
would take hours, and tiles as small as that are mostly overlap."""

MAX_PIXELS = 2**32
"""Pixels of a picture: 65536x65536, which takes 64 GiB as RGBA floats. It is assembled in memory, so a larger size is
taken for a mistake."""


def plan_tiling(
    program: LoweredProgram,
    passes: tuple[PassGroup, ...],
    texels: Mapping[Ref, str],
    library: Library,
    target: Target,
    precision: Precision,
    halves: frozenset[str],
    keys: Mapping[Ref, str] = MappingProxyType({}),
    by_rows: frozenset[str] = frozenset(),
) -> Tiling | None:
    """The stages and tiles of these passes; None if they fit as they are.

    `texels` and `keys` are the formats and the keys of all pictures. The outputs `by_rows` need not be assembled.

    Raises DeviceError if they do not fit in tiles either.
    """
    why = _find_excess(program, passes, texels, target)
    if not why:
        return None
    if program.windows:
        raise DeviceError(f"{why}: choose a smaller region")
    for ref in texels:
        if count_pixels(program.shape(ref).size) > MAX_PIXELS:
            raise DeviceError(
                f"{why}, and too many to be made in parts; render smaller with --scale or --size",
                node=program.ops[ref.op].owner,
            )
    check_whole_pictures(program, passes, target)
    work = _StagePlanner(program, passes, texels, target, by_rows)
    check_extents(program, work.whole_refs, why)
    before, last = work.plan_before(), work.plan_last()
    # What an output was rounded to as a part of the whole, it is rounded to in a tile.
    rounded = frozenset(name for name in halves if texels[program.outputs[name]].endswith("16f"))
    return Tiling(program, library, target, precision, rounded, keys, before, last, work.nbytes, why, work.by_rows)


def plan_tile(tiling: Tiling, stage: TileStage, number: int, stored: Mapping[int, StoredResult]) -> Plan:
    """The plan of one tile of a stage; `stored` are the results of earlier stages by operation."""
    ops = tuple(stored.get(index, op) for index, op in enumerate(tiling.program.ops))
    program = replace(
        tiling.program,
        ops=ops,
        outputs=stage.outputs,
        memories=MappingProxyType({}),
        results=MappingProxyType({}),
        windows=stage.windows[number],
    )
    return schedule(program, stage.passes, tiling.library, tiling.target, tiling.precision, tiling.halves).plan


def _find_excess(
    program: LoweredProgram, passes: Sequence[PassGroup], texels: Mapping[Ref, str], target: Target
) -> str:
    """A sentence on what does not fit; "" if all pictures do."""
    for ref in texels:
        size, owner = program.size_on_device(ref), program.ops[ref.op].owner
        if max(size) > target.max_size:
            return (
                f"{describe_owner(owner)}: {format_size(size)} pixels is more than the {target.max_size} that "
                f"{target.name_in_sentences} can hold on a side"
            )
    if not target.memory:
        return ""
    nbytes = count_peak_bytes(program, passes, texels) + sum(
        _count_bytes(program, texels, ref) for ref in _find_outside(program, passes)
    )
    nbytes += _count_memory_bytes(program, texels)
    if nbytes <= target.memory:
        return ""
    allowed = format_bytes(target.memory)
    return f"{format_bytes(nbytes)} of textures and pictures is more than the {allowed} that may be used"


def _count_memory_bytes(program: LoweredProgram, texels: Mapping[Ref, str]) -> int:
    """Bytes of memories beyond those that the plan reads: they exist twice, of this frame and of the one before."""
    kept_bytes = sum(_count_bytes(program, texels, ref) for ref in program.memories.values())
    read = sum(_count_bytes(program, texels, ref) for ref in texels if program.ops[ref.op].is_memory)
    return max(kept_bytes - read, 0)


def _find_outside(program: LoweredProgram, passes: Sequence[PassGroup]) -> set[Ref]:
    """The pictures that also take memory of the processor: those read from files, and outputs."""
    reads = {ref for fused in passes for ref in fused.reads if program.ops[ref.op].find_upload(ref.output)}
    return reads | set(program.outputs.values())


def _count_bytes(program: LoweredProgram, texels: Mapping[Ref, str], ref: Ref) -> int:
    """The bytes of a whole picture, with what is made of it beyond its frame."""
    return texture_bytes(program.extent(ref).size, texels[ref])


class _StagePlanner:
    """Finds the stages of a program."""

    def __init__(
        self,
        program: LoweredProgram,
        passes: tuple[PassGroup, ...],
        texels: Mapping[Ref, str],
        target: Target,
        by_rows: frozenset[str],
    ) -> None:
        self.program, self.passes, self.texels, self.target = program, passes, texels, target
        self.makers = {ref: fused for fused in passes for ref in fused.writes}
        self.largest = max(count_pixels(program.shape(ref).size) for ref in texels)
        self.whole_passes = tuple(fused for fused in passes if self._is_made_whole(fused))
        self.whole_refs = {ref for fused in self.whole_passes for ref in fused.writes}
        self.by_rows = frozenset(name for name in by_rows if program.outputs[name] not in self.whole_refs)
        self.nbytes = 0

    def plan_before(self) -> tuple[TileStage, ...]:
        """The stages of pictures that must be whole before they are read."""
        return tuple(
            self._plan_stage({f"{ref.op}.{ref.output}": ref for ref in fused.writes}, fused)
            for fused in self.whole_passes
        )

    def plan_last(self) -> tuple[TileStage, ...]:
        """The stages of all other outputs, one for each size."""
        sizes: dict[Size, dict[str, Ref]] = {}
        for name, ref in self.program.outputs.items():
            if ref not in self.whole_refs:
                sizes.setdefault(self.program.shape(ref).size, {})[name] = ref
        return tuple(self._plan_stage(outputs, None) for outputs in sizes.values())

    # --- parts -------------------------------------------------------------------------------------------------------

    def _is_made_whole(self, fused: PassGroup) -> bool:
        """True for a pass whose pictures are made whole before others read them."""
        if any(op.is_made_first for op in self._find_ops(fused)):
            return True
        ends = self.program.extents.keys().isdisjoint(fused.writes)
        if self._is_small(fused.writes[0]) and ends and self._is_light(fused) and not self._stays_small(fused):
            return True
        return any(
            op.reads_whole(ref, self.program.shape(ref).size) and self.program.shape(ref).size != (1, 1)
            for reader in self.passes
            for op in self._find_ops(reader)
            for ref in op.reads()
            if ref in fused.writes
        )

    def _is_small(self, ref: Ref) -> bool:
        return SMALL_FRACTION * count_pixels(self.program.shape(ref).size) <= self.largest

    def _is_light(self, fused: PassGroup) -> bool:
        """True for a pass whose pictures take an eighth of the allowed memory at most. Chosen by judgement."""
        nbytes = sum(_count_bytes(self.program, self.texels, ref) for ref in fused.writes)
        return not self.target.memory or 8 * nbytes <= self.target.memory

    def _stays_small(self, fused: PassGroup) -> bool:
        """True for a pass that reads small pictures and is read by passes of small pictures: its readers are cut."""
        readers = [reader for reader in self.passes if not set(fused.writes).isdisjoint(reader.reads)]
        return all(map(self._is_small, (*fused.reads, *(reader.writes[0] for reader in readers))))

    def _find_ops(self, fused: PassGroup) -> list[Op]:
        return [self.program.ops[index] for index in fused.members]

    def _plan_stage(self, outputs: dict[str, Ref], own: PassGroup | None) -> TileStage:
        """A stage with the fewest tiles that fit.

        Tiles are halved until they fit. Without a limit of memory, `usual` is what they may take: more than usual where
        even the smallest tile needs it, because then smaller tiles would only read the same large surroundings more
        often.
        """
        passes = self._find_passes(outputs.values(), own)
        size = self.program.shape(next(iter(outputs.values()))).size
        whole = any(op.is_indivisible for fused in passes for op in self._find_ops(fused))
        tile = size
        usual = max(USUAL_BYTES, 2 * self._measure_textures(passes, outputs, size, (MIN_TILE, MIN_TILE))[1])
        while True:
            windows, textures = self._measure_textures(passes, outputs, size, tile)
            nbytes = self._measure_pictures(passes, outputs, windows, tile) + textures
            fits = self._fits(windows, textures, nbytes, usual)
            if fits or whole or max(tile) <= MIN_TILE:
                break
            tile = _halve_tile(tile, self._find_too_long_sides(windows))
        if not fits and (self.target.memory or any(self._find_too_long_sides(windows))):
            self._raise_too_large(windows, nbytes)
        self.nbytes = max(self.nbytes, nbytes)
        if math.prod(-(-side // length) for side, length in zip(size, tile, strict=True)) > MAX_TILES:
            owner, memory = self.program.ops[next(iter(outputs.values())).op].owner, self.target.memory
            within = f"within {format_bytes(memory)} its" if memory else "its"
            more = "give more with --memory, or render" if memory else "render"
            raise DeviceError(
                f"{describe_owner(owner)}: {within} {format_size(size)} pixels can only be made in tiles of "
                f"{format_size(tile)}, which takes too long; {more} smaller with --scale or --size",
                node=owner,
            )
        tiles = _split_into_tiles(size, tile)
        windows_by_tile = [self._find_windows(passes, outputs.values(), region) for region in tiles]
        return TileStage(MappingProxyType(outputs), passes, tiles, _select_parts(self.program, windows_by_tile))

    def _measure_textures(
        self, passes: Sequence[PassGroup], outputs: dict[str, Ref], size: Size, tile: Size
    ) -> tuple[list[dict[Ref, Region]], int]:
        """The windows of tiles of this size, and the bytes that textures take at most."""
        windows = [self._find_windows(passes, outputs.values(), region) for region in _sample_tiles(size, tile)]
        programs = (
            replace(self.program, windows=tile_windows, outputs=outputs, memories={}) for tile_windows in windows
        )
        return windows, max(count_peak_bytes(program, passes, self.texels) for program in programs)

    def _find_passes(self, refs: Iterable[Ref], own: PassGroup | None) -> tuple[PassGroup, ...]:
        """The passes that make pictures from results of earlier stages; `own` is the pass that the stage is for."""
        numbers_found: set[int] = set()
        todo = list(refs)
        numbers = {id(fused): number for number, fused in enumerate(self.passes)}
        while todo:
            ref = todo.pop()
            fused = self.makers.get(ref)
            if fused is None or numbers[id(fused)] in numbers_found or (ref in self.whole_refs and fused is not own):
                continue
            numbers_found.add(numbers[id(fused)])
            todo.extend(fused.reads)
        return tuple(self.passes[number] for number in sorted(numbers_found))

    def _find_windows(self, passes: Sequence[PassGroup], refs: Iterable[Ref], region: Region) -> dict[Ref, Region]:
        return find_regions(self.program, passes, dict.fromkeys(refs, region))

    def _measure_pictures(
        self,
        passes: Sequence[PassGroup],
        outputs: Mapping[str, Ref],
        windows_by_tile: Sequence[Mapping[Ref, Region]],
        tile: Size,
    ) -> int:
        """Bytes of the pictures in memory during a stage: inputs, results of earlier stages, and its own results.

        Files that are read by rows, and outputs that are handed over by rows, count with the rows of a tile; outputs
        count twice, since an encoded copy exists while they are written.
        """
        held_refs = {ref for fused in passes for ref in fused.reads if ref not in self.makers or ref in self.whole_refs}
        rows = {
            ref: max(windows[ref].height for windows in windows_by_tile if ref in windows)
            for ref in held_refs
            if self.target.memory and (picture := self.program.ops[ref.op].find_upload(ref.output)) and picture.by_rows
        }
        rows |= {ref: 2 * tile[1] for name, ref in outputs.items() if name in self.by_rows}
        total = 0
        for ref in held_refs | set(outputs.values()):
            height = self.program.shape(ref).size[1]
            total += _count_bytes(self.program, self.texels, ref) * min(rows.get(ref, height), height) // height
        return total

    def _fits(self, windows: Sequence[Mapping[Ref, Region]], textures: int, nbytes: int, usual: int) -> bool:
        """Whether tiles with so many bytes of textures, and of textures and pictures, are within the limits."""
        fits = nbytes <= self.target.memory if self.target.memory else textures <= usual
        return fits and self._find_too_long_sides(windows) == (False, False)

    def _find_too_long_sides(self, windows_by_tile: Sequence[Mapping[Ref, Region]]) -> tuple[bool, bool]:
        """Whether some window is wider, and whether one is higher, than the device can hold."""
        most = self.target.max_size
        regions = [region for windows in windows_by_tile for region in windows.values()]
        return any(region.width > most for region in regions), any(region.height > most for region in regions)

    def _raise_too_large(self, windows_by_tile: Sequence[Mapping[Ref, Region]], nbytes: int) -> None:
        """Raise DeviceError: even the smallest tiles are too large."""
        sizes = {ref: region.width * region.height for windows in windows_by_tile for ref, region in windows.items()}
        largest = max(sizes, key=lambda ref: sizes[ref])
        owner, memory = self.program.ops[largest.op].owner, self.target.memory
        if memory and nbytes > memory:
            shortage = (
                f"{format_bytes(nbytes)} of pictures must be held at once, but only {format_bytes(memory)} may be used"
            )
            raise DeviceError(
                f"{describe_owner(owner)}: {shortage}; give more with --memory, or render smaller with --scale or "
                "--size",
                node=owner,
            )
        raise DeviceError(
            f"{describe_owner(owner)}: for a few pixels it needs more than the {self.target.max_size} that "
            f"{self.target.name_in_sentences} can hold on a side; render smaller with --scale or --size",
            node=owner,
        )


def _split_into_tiles(size: Size, tile: Size) -> tuple[Region, ...]:
    """Tiles that cover a picture, row by row."""
    return tuple(
        Region(x, y, min(tile[0], size[0] - x), min(tile[1], size[1] - y))
        for y, x in product(range(0, size[1], tile[1]), range(0, size[0], tile[0]))
    )


def _sample_tiles(size: Size, tile: Size) -> tuple[Region, ...]:
    """The tiles of a grid in its corners, along its edges and in the middle: each other tile is like one of these."""
    across, down = (
        sorted({0, (length - 1) // step // 2 * step, (length - 1) // step * step})
        for length, step in zip(size, tile, strict=True)
    )
    return tuple(Region(x, y, min(tile[0], size[0] - x), min(tile[1], size[1] - y)) for y, x in product(down, across))


def _halve_tile(tile: Size, too_wide: tuple[bool, bool]) -> Size:
    """A tile of half as many pixels: the side that is too long for the device is halved, else the longer one."""
    width, height = tile
    across = too_wide[0] if any(too_wide) and min(tile) > MIN_TILE else width > height
    return (max(-(-width // 2), MIN_TILE), height) if across else (width, max(-(-height // 2), MIN_TILE))


def _select_parts(
    program: LoweredProgram, windows_by_tile: Sequence[Mapping[Ref, Region]]
) -> tuple[Mapping[Ref, Region], ...]:
    """The regions of all pictures that are not whole, for every tile."""
    parts = {ref for windows in windows_by_tile for ref, region in windows.items() if region != program.extent(ref)}
    return tuple(
        MappingProxyType({ref: windows[ref] for ref in windows if ref in parts}) for windows in windows_by_tile
    )
