"""Pictures that the device, or the memory that may be used, cannot hold are made tile by tile.

A tile needs the parts of what it reads that lie around it, and no more: see `regions`. What is read anywhere must be
whole: it is made before, tile by tile as well, and put together. So the plan of a large picture is a row of stages,
each with many small plans, which share their programs.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from types import MappingProxyType

from halation.nodes import Size
from msgspec.structs import replace

from ...errors import DeviceError
from ..areas import Region
from ..explain import format_bytes
from ..fusion.fuse import PassGroup
from ..ir import LoweredProgram, Op, Ref, StoredResult
from ..library import Library
from ..plan import Plan, texture_bytes
from ..scheduling.schedule import count_peak_bytes, schedule
from ..target import Precision, Target
from .regions import find_regions
from .tiles import TileStage, Tiling

MIN_TILE = 8
"""Pixels across a tile, at least: smaller ones would be all overlap."""

SMALL_FRACTION = 16
"""What has so many times fewer pixels than the largest picture is made whole, even if it need not be: blurs and glows
look far around in small pictures, and tiles of the large ones then need little around them."""

USUAL_BYTES = 2**31
"""Bytes of textures for a tile where nobody says how much memory may be used; more, where much of it is needed for a
single pixel."""

MAX_TILES = 2**16
"""Of a picture: more are so small that they would be mostly overlap."""

MAX_PIXELS = 2**32
"""Of a picture. It is put together in memory: a larger one is a mistake."""


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
    """How to run passes tile by tile, None where they fit as they are.

    `texels` and `keys` are the formats and the keys of all pictures. The outputs `by_rows` need not be put together.

    Raises DeviceError where they do not fit that way either.
    """
    why = _find_excess(program, passes, texels, target)
    if not why:
        return None
    if program.windows:
        raise DeviceError(f"{why}: choose a smaller region")
    for ref in texels:
        if _count_pixels(program.shape(ref).size) > MAX_PIXELS:
            raise DeviceError(
                f"{why}, and too many to be made in parts; render smaller with --scale or --size",
                node=program.ops[ref.op].owner,
            )
    _check_whole_pictures(program, passes, target)
    work = _StagePlanner(program, passes, texels, target, by_rows)
    before, last = work.plan_before(), work.plan_last()
    # What an output was rounded to as a part of the whole, it is rounded to in a tile.
    rounded = frozenset(name for name in halves if texels[program.outputs[name]].endswith("16f"))
    return Tiling(program, library, target, precision, rounded, keys, before, last, work.nbytes, why, work.by_rows)


def plan_tile(tiling: Tiling, stage: TileStage, number: int, stored: Mapping[int, StoredResult]) -> Plan:
    """How a tile of a stage is made; `made` is what the stages before made, by operation."""
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
    """What cannot be held, in a sentence; "" if all can."""
    for ref in texels:
        size, owner = program.size_on_device(ref), program.ops[ref.op].owner
        if max(size) > target.max_size:
            return (
                f"node '{owner}': {_format_size(size)} pixels is more than the {target.max_size} that "
                f"{target.renderer} can hold on a side"
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
    """What nodes remember is there twice: of this frame, and of the one before, which may not be read."""
    kept_bytes = sum(_count_bytes(program, texels, ref) for ref in program.memories.values())
    read = sum(_count_bytes(program, texels, ref) for ref in texels if program.ops[ref.op].is_memory)
    return max(kept_bytes - read, 0)


def _find_outside(program: LoweredProgram, passes: Sequence[PassGroup]) -> set[Ref]:
    """What is not only on the device: pictures that are read from files, and outputs."""
    reads = {ref for fused in passes for ref in fused.reads if program.ops[ref.op].find_upload(ref.output)}
    return reads | set(program.outputs.values())


def _count_bytes(program: LoweredProgram, texels: Mapping[Ref, str], ref: Ref) -> int:
    """What a whole picture takes."""
    return texture_bytes(program.shape(ref).size, texels[ref])


def _check_whole_pictures(program: LoweredProgram, passes: Sequence[PassGroup], target: Target) -> None:
    """Raise DeviceError for what must be whole and does not fit, and for what remembers frames."""
    for fused in passes:
        for op in (program.ops[index] for index in fused.members):
            refs = [
                ref for ref in fused.reads if ref in set(op.reads()) and op.reads_whole(ref, program.shape(ref).size)
            ]
            sizes = [program.shape(ref).size for ref in refs] + ([op.size] if op.is_indivisible else [])
            for size in sizes:
                if max(size) > target.max_size:
                    raise DeviceError(
                        f"node '{op.owner}': it may need all {_format_size(size)} pixels of a picture for one of its "
                        f"own, so they cannot be made in parts, and {target.renderer} holds {target.max_size} on a "
                        "side; render smaller with --scale or --size",
                        node=op.owner,
                    )
    for port in program.memories:
        raise DeviceError(
            f"node '{port.node}': what it remembers of a frame must fit into memory as a whole; render smaller with "
            "--scale or --size, or give more with --memory",
            node=port.node,
        )


def _format_size(size: Size) -> str:
    return f"{size[0]}x{size[1]}"


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
        self.largest = max(_count_pixels(program.shape(ref).size) for ref in texels)
        self.whole_passes = tuple(fused for fused in passes if self._is_made_whole(fused))
        self.whole_refs = {ref for fused in self.whole_passes for ref in fused.writes}
        self.by_rows = frozenset(name for name in by_rows if program.outputs[name] not in self.whole_refs)
        self.nbytes = 0

    def plan_before(self) -> tuple[TileStage, ...]:
        """What is made whole before it is read."""
        return tuple(
            self._plan_stage({f"{ref.op}.{ref.output}": ref for ref in fused.writes}, fused)
            for fused in self.whole_passes
        )

    def plan_last(self) -> tuple[TileStage, ...]:
        """The outputs that are not made by then, by size."""
        sizes: dict[Size, dict[str, Ref]] = {}
        for name, ref in self.program.outputs.items():
            if ref not in self.whole_refs:
                sizes.setdefault(self.program.shape(ref).size, {})[name] = ref
        return tuple(self._plan_stage(outputs, None) for outputs in sizes.values())

    # --- parts -------------------------------------------------------------------------------------------------------

    def _is_made_whole(self, fused: PassGroup) -> bool:
        """True for a pass whose pictures are made as a whole before others read them."""
        if any(op.is_made_first for op in self._find_ops(fused)):
            return True
        if self._is_small(fused.writes[0]) and self._is_light(fused) and not self._stays_small(fused):
            return True
        return any(
            op.reads_whole(ref, self.program.shape(ref).size) and self.program.shape(ref).size != (1, 1)
            for other in self.passes
            for op in self._find_ops(other)
            for ref in op.reads()
            if ref in fused.writes
        )

    def _is_small(self, ref: Ref) -> bool:
        return SMALL_FRACTION * _count_pixels(self.program.shape(ref).size) <= self.largest

    def _is_light(self, fused: PassGroup) -> bool:
        """True for a pass whose pictures leave room for much else."""
        nbytes = sum(_count_bytes(self.program, self.texels, ref) for ref in fused.writes)
        return not self.target.memory or 8 * nbytes <= self.target.memory

    def _stays_small(self, fused: PassGroup) -> bool:
        """True for a pass between small pictures: it is made together with those that shrink or enlarge."""
        readers = [other for other in self.passes if not set(fused.writes).isdisjoint(other.reads)]
        return all(map(self._is_small, (*fused.reads, *(other.writes[0] for other in readers))))

    def _find_ops(self, fused: PassGroup) -> list[Op]:
        return [self.program.ops[index] for index in fused.members]

    def _plan_stage(self, outputs: dict[str, Ref], own: PassGroup | None) -> TileStage:
        """A stage with the fewest tiles that fit."""
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
                f"node '{owner}': {within} {_format_size(size)} pixels can only be made in tiles of "
                f"{_format_size(tile)}, which takes too long; {more} smaller with --scale or --size",
                node=owner,
            )
        tiles = _split_into_tiles(size, tile)
        windows_by_tile = [self._find_windows(passes, outputs.values(), region) for region in tiles]
        return TileStage(MappingProxyType(outputs), passes, tiles, _select_parts(self.program, windows_by_tile))

    def _measure_textures(
        self, passes: Sequence[PassGroup], outputs: dict[str, Ref], size: Size, tile: Size
    ) -> tuple[list[dict[Ref, Region]], int]:
        """The windows of tiles of this size, and what textures take at most."""
        windows = [self._find_windows(passes, outputs.values(), region) for region in _sample_tiles(size, tile)]
        programs = (
            replace(self.program, windows=tile_windows, outputs=outputs, memories={}) for tile_windows in windows
        )
        return windows, max(count_peak_bytes(program, passes, self.texels) for program in programs)

    def _find_passes(self, refs: Iterable[Ref], own: PassGroup | None) -> tuple[PassGroup, ...]:
        """The passes that make pictures of what stages before made; `own` is the stage's own one."""
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
        """Bytes of the pictures that are held meanwhile: what was read or made before, and what is made.

        Of files that are read by rows, and outputs that are handed over by rows, those of a tile: of outputs twice,
        since they are encoded.
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
        """Whether tiles of so many bytes of textures, and of so many in all, can be made one after another."""
        fits = nbytes <= self.target.memory if self.target.memory else textures <= usual
        return fits and self._find_too_long_sides(windows) == (False, False)

    def _find_too_long_sides(self, windows_by_tile: Sequence[Mapping[Ref, Region]]) -> tuple[bool, bool]:
        """Whether a window is wider, or higher, than the device can hold."""
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
                f"node '{owner}': {shortage}; give more with --memory, or render smaller with --scale or --size",
                node=owner,
            )
        raise DeviceError(
            f"node '{owner}': for a few pixels it needs more than the {self.target.max_size} that "
            f"{self.target.renderer} can hold on a side; render smaller with --scale or --size",
            node=owner,
        )


def _count_pixels(size: Size) -> int:
    return size[0] * size[1]


def _split_into_tiles(size: Size, tile: Size) -> tuple[Region, ...]:
    """Tiles that cover a picture, row by row."""
    return tuple(
        Region(x, y, min(tile[0], size[0] - x), min(tile[1], size[1] - y))
        for y, x in product(range(0, size[1], tile[1]), range(0, size[0], tile[0]))
    )


def _sample_tiles(size: Size, tile: Size) -> tuple[Region, ...]:
    """Of the tiles of a grid, those in corners, along edges and in the middle: all others are like one of these."""
    across, down = (
        sorted({0, (length - 1) // step // 2 * step, (length - 1) // step * step})
        for length, step in zip(size, tile, strict=True)
    )
    return tuple(Region(x, y, min(tile[0], size[0] - x), min(tile[1], size[1] - y)) for y, x in product(down, across))


def _halve_tile(tile: Size, too_wide: tuple[bool, bool]) -> Size:
    """Half as many pixels: of what is too long for the device, else of the longer side."""
    width, height = tile
    across = too_wide[0] if any(too_wide) and min(tile) > MIN_TILE else width > height
    return (max(-(-width // 2), MIN_TILE), height) if across else (width, max(-(-height // 2), MIN_TILE))


def _select_parts(
    program: LoweredProgram, windows_by_tile: Sequence[Mapping[Ref, Region]]
) -> tuple[Mapping[Ref, Region], ...]:
    """The regions of what is not whole for every tile."""
    parts = {
        ref for windows in windows_by_tile for ref, region in windows.items() if region.size != program.shape(ref).size
    }
    return tuple(
        MappingProxyType({ref: windows[ref] for ref in windows if ref in parts}) for windows in windows_by_tile
    )
