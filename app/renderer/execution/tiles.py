"""Runs a plan that does not fit on the device, tile by tile."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Mapping, Set
from typing import Protocol

import numpy as np
from halation.nodes import Kind, Size
from msgspec.structs import replace

from ...compiler import Pass, Plan, Ref, Region, StoredResult, TileStage, Upload, plan_tile
from ...compiler.areas import Span
from ...compiler.explain import format_bytes
from ...compiler.ir import LoweredProgram
from ...errors import DeviceError, HalationError
from ...resources.large_arrays import ArrayMaker, create_array, reuse_pages
from ...resources.machine import machine_memory
from ...resources.picture import Picture
from .decoding import Array, PictureLoader
from .run import Run, find_shared_surfaces
from .texture_pool import TextureLease


class PlanRunner(Protocol):
    """Runs plans that fit: see `Runner`."""

    def release_idle(self) -> None:
        """Give back textures that nobody leases."""
        ...

    def start_run(self, plan: Plan, outputs_lease: TextureLease, requested: Iterable[int] | None = None) -> Run:
        """Begin to run a plan."""
        ...

    def download(self, plan: Plan, create: ArrayMaker = np.empty) -> dict[str, Array]:
        """The outputs of a plan that has run, in arrays that `create` makes."""
        ...

    def create_lease(self) -> TextureLease:
        """A new lease that holds no pixels yet."""
        ...


class TiledRun(Run):
    """Executes a plan tile by tile, one pass per `next`. At the end `keep_outputs` gets the outputs by name.

    Pictures that passes read anywhere are assembled in memory first. So are the outputs, unless `receive_rows` takes
    their rows.
    """

    def __init__(
        self, runner: PlanRunner, load: PictureLoader, plan: Plan, keep_outputs: Callable[[dict[str, Array]], None]
    ) -> None:
        assert plan.tiling is not None
        super().__init__(plan)
        self._tiling = plan.tiling
        self._runner, self._keep_outputs = runner, keep_outputs
        self._pictures = _PictureCache(load, by_rows=plan.tiling.target.memory > 0)
        self._tile: Run | None = None
        self._passes = self._run_stages()

    @property
    def total(self) -> int:
        return self._tiling.total

    @property
    def is_ready(self) -> bool:
        """False while the next pass of a tile would wait for the trial of a program; pictures never wait."""
        return self._tile is None or self._tile.is_ready

    def __next__(self) -> Pass:
        try:
            render_pass = next(self._passes)
        except BaseException:
            self.has_ended = True
            raise
        self.passes_done += 1
        return render_pass

    def close(self) -> None:
        self.has_ended = True
        self._passes.close()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _run_stages(self) -> Generator[Pass, None, None]:
        tiling = self._tiling
        row_outputs = tiling.by_rows if self.receive_rows else frozenset[str]()
        _check_memory(tiling.program, row_outputs)
        with reuse_pages():
            stored: dict[int, StoredResult] = {}
            for number, stage in enumerate(tiling.stages[: len(tiling.before)]):
                arrays = yield from self._run_stage(stage, stored)
                stored |= self._store_outputs(stage, arrays)
                self._drop_unread(stored, tiling.stages[number + 1 :])
            outputs = {
                name: _get_pixels(stored[ref.op], ref.output)
                for name, ref in tiling.program.outputs.items()
                if ref.op in stored
            }
            for number, stage in enumerate(tiling.last, len(tiling.before)):
                outputs |= yield from self._run_stage(stage, stored)
                self._drop_unread(stored, tiling.stages[number + 1 :])
            self._keep_outputs({name: outputs[name] for name in tiling.program.outputs if name not in row_outputs})

    def _run_stage(
        self, stage: TileStage, stored: Mapping[int, StoredResult]
    ) -> Generator[Pass, None, dict[str, Array]]:
        """Make the pictures of a stage: [height, width, channels] by name, except those handed over by rows."""
        size = self._tiling.program.shape(next(iter(stage.outputs.values()))).size
        row_outputs = self._tiling.by_rows.intersection(stage.outputs) if self.receive_rows else frozenset[str]()
        pictures: dict[str, Array] = {}
        before, plan = self._runner.create_lease(), plan_tile(self._tiling, stage, 0, stored)
        try:
            for number, tile in enumerate(stage.tiles):
                # Each tile keeps what the next one would make again.
                last = number + 1 == len(stage.tiles)
                following = None if last else plan_tile(self._tiling, stage, number + 1, stored)
                shared = find_shared_surfaces(plan, following) if following else ()
                tile_lease = self._runner.create_lease()
                try:
                    loaded_plan = self._load_pictures(plan)
                    with self._runner.start_run(loaded_plan, tile_lease, (*plan.outputs.values(), *shared)) as run:
                        before.close()
                        self._tile = run
                        yield from run
                    del loaded_plan
                    self._place_outputs(plan, tile, size, row_outputs, pictures)
                    for surface in plan.outputs.values():
                        if surface not in shared:
                            tile_lease.release(plan.surfaces[surface].key)
                finally:
                    if following and _collect_texture_kinds(following) != _collect_texture_kinds(plan):
                        self._runner.release_idle()  # else textures of other sizes would wait for their next use
                    before, plan = tile_lease, following or plan
        finally:
            before.close()
        return pictures

    def _place_outputs(
        self, plan: Plan, tile: Region, size: Size, row_outputs: frozenset[str], pictures: dict[str, Array]
    ) -> None:
        """Put the outputs of a tile into whole pictures, and hand over those of `row_outputs` whose rows are done."""
        for name, pixels in self._runner.download(plan, create_array).items():
            first = tile.y if name in row_outputs else 0
            if name not in pictures:
                height = tile.height if name in row_outputs else size[1]
                pictures[name] = np.empty((height, size[0], pixels.shape[2]), pixels.dtype)
            # Others may read more of an output than the tile.
            window = plan.surfaces[plan.outputs[name]].window or Region.whole(size)
            tile_part = Region(tile.x - window.x, tile.y - window.y, *tile.size)
            place = _to_slices(Region(tile.x, tile.y - first, *tile.size))
            pictures[name][place] = pixels[_to_slices(tile_part)]
            if name in row_outputs and self.receive_rows and tile.across[1] == size[0]:
                self.receive_rows(name, first, pictures.pop(name))

    def _load_pictures(self, plan: Plan) -> Plan:
        """The same plan with the pixels of its uploads."""
        uploads = tuple(self._pictures.read(item, plan.surfaces[item.surface].window) for item in plan.uploads)
        return replace(plan, uploads=uploads)

    def _store_outputs(self, stage: TileStage, arrays: Mapping[str, Array]) -> dict[int, StoredResult]:
        """The results of a stage as operations that replace those which would compute them again."""
        program, keys = self._tiling.program, self._tiling.keys
        stored: dict[int, StoredResult] = {}
        for index in dict.fromkeys(ref.op for ref in stage.outputs.values()):
            op = program.ops[index]
            refs = [Ref(index, output) for output in range(len(op.shapes))]
            names = {ref: name for name, ref in stage.outputs.items()}
            pixels = [arrays[names[ref]] if ref in names else None for ref in refs]
            stored[index] = StoredResult(
                op.shapes,
                op.owner,
                tuple(None if array is None else _wrap_pixels(op.owner, array) for array in pixels),
                tuple(array is not None and array.dtype == np.float16 for array in pixels),
                tuple(keys.get(ref, "") for ref in refs),
            )
        return stored

    def _drop_unread(self, stored: dict[int, StoredResult], later: Iterable[TileStage]) -> None:
        """Forget results and pictures that no later stage reads."""
        read = {ref.op for stage in later for fused in stage.passes for ref in fused.reads}
        read |= {ref.op for ref in self._tiling.program.outputs.values()}
        for index in stored.keys() - read:
            del stored[index]
        ops = (self._tiling.program.ops[index] for index in read)
        self._pictures.keep({picture for op in ops if (picture := op.find_upload(0))})


class _PictureCache:
    """The pixels of files, each decoded once; or `by_rows`, the last rows that were read of those that can be."""

    def __init__(self, load: PictureLoader, *, by_rows: bool) -> None:
        self._load, self._by_rows = load, by_rows
        self._decoded: dict[Picture, tuple[Span, Array]] = {}

    def read(self, upload: Upload, window: Region | None) -> Upload:
        """The same upload, of pixels that are in memory: all, or a window of them."""
        picture = upload.picture
        if picture.in_memory:
            return upload
        everything = upload.whole
        window = window or everything
        in_parts = self._by_rows and picture.by_rows and not picture.overscan
        rows = window.down if in_parts else everything.down
        (first, end), pixels = self._decoded.get(picture, ((0, 0), None))
        if pixels is None or not first <= rows[0] <= rows[1] <= end:
            pixels = None
            self._decoded.pop(picture, None)  # there may be no room for both
            try:
                pixels = self._load(replace(picture, rows=rows) if rows != everything.down else picture)
            except HalationError as error:
                error.node = error.node or upload.node
                raise
            first, _ = rows
            self._decoded[picture] = rows, pixels
        if rows != everything.down:
            pixels = pixels[window.y - first : window.down[1] - first, slice(*window.across)]
        return replace(upload, picture=replace(picture, in_memory=True, pixels=pixels))

    def keep(self, pictures: Set[Picture]) -> None:
        """Forget all other pictures."""
        for picture in self._decoded.keys() - pictures:
            del self._decoded[picture]


def _check_memory(program: LoweredProgram, row_outputs: Set[str]) -> None:
    """Raise DeviceError if this machine cannot hold the outputs: all but `row_outputs` are assembled in memory."""
    shapes = [program.shape(ref) for name, ref in program.outputs.items() if name not in row_outputs]
    nbytes = sum(shape.size[0] * shape.size[1] * shape.channels * 4 for shape in shapes)
    if nbytes > (available := machine_memory()):
        raise DeviceError(
            f"the outputs take {format_bytes(nbytes)} of memory, and this machine has {format_bytes(int(available))}; "
            "render smaller with --scale or --size"
        )


def _wrap_pixels(owner: str, pixels: Array) -> Picture:
    return Picture(owner, "", Kind.VECTOR, pixels.shape[2], in_memory=True, pixels=pixels)


def _get_pixels(stored: StoredResult, output: int) -> Array:
    picture = stored.pictures[output]
    assert picture is not None and isinstance(picture.pixels, np.ndarray)
    return picture.pixels


def _collect_texture_kinds(plan: Plan) -> set[tuple[Size, str]]:
    """The sizes and formats of textures."""
    return {(surface.size, surface.texel) for surface in plan.surfaces}


def _to_slices(region: Region) -> tuple[slice, slice]:
    return slice(*region.down), slice(*region.across)
