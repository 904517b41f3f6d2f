"""Executes single passes, uploads and downloads, without knowing the plan's order."""

from __future__ import annotations

import math
import time
from collections.abc import Generator, Iterable, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from functools import partial
from itertools import count

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from ...compiler import FIRST_TABLE, MAX_WEIGHTS, Pass, Plan, Region, Surface, Upload
from ...errors import HalationError, InputError, RenderError, describe_owner
from ...resources.color_program import LookupTable
from ...resources.large_arrays import ArrayMaker
from ...resources.mesh import Mesh
from ..device import Bindings, Device, DeviceProgram, DeviceResource, DeviceTexture
from .costs import PassCosts
from .decoding import Array, DecodedPicture
from .host_jobs import HostJob, HostJobs
from .host_windows import cut_window, find_host_window, find_window
from .program_cache import ProgramCache
from .progress_beacon import ProgressBeacon
from .resource_cache import ResourceCache
from .texture_pool import PooledTexture, TextureLease, TexturePool
from .trials import Trial, Trials
from .variants import PendingPrograms

MAX_TABLES = 64
MAX_MESHES = 16
MAX_WEIGHT_BUFFERS = 64
"""Objects that stay on the device for later passes. The largest presets use 16 weight buffers and one mesh; a table is
a color transform of one node. So there is room for several graphs that are edited in turn."""

BAND_PIXELS = 2**21
"""The software rasterizer computes at most so many pixels at a time: an interrupt is heard only in between. A picture
of 1920x1080 is still one piece."""


FIRST_SHARE = 256
"""The first band of code has this part of the rows: a pass of ten seconds then holds up others for 0.04 s at first."""

_LEAST_ELAPSED = 1e-6
"""Seconds that a band counts as at least: clocks may show 0."""

MAX_GROWTH = 8
"""How many times as high as the last band a band may be: code that is quick is done in four bands."""

_HOST_SECONDS = 0.5
"""What a picture of a program on the processor is assumed to cost at least, where a run did not wait for it: Open Image
Denoise takes as long for 960x540 on two cores."""


class RunnerCounters(Struct):
    """How many passes and uploads a runner has executed, and how many passes it skipped."""

    passes: int = 0
    uploads: int = 0
    skipped: int = 0


class Executor:
    """Executes passes on one device and owns its programs, textures and buffers."""

    def __init__(self, device: Device, budget: int, trials: Trials | None = None) -> None:
        self.device, self._trials = device, trials
        self.programs = ProgramCache(device)
        self.textures = TexturePool(device, budget)
        self.counters = RunnerCounters()
        self.closed = False
        self._costs = PassCosts(device.target.software)
        self._tables = ResourceCache[LookupTable, DeviceResource](MAX_TABLES)
        self._meshes = ResourceCache[Mesh, DeviceResource](MAX_MESHES)
        self._weights = ResourceCache[tuple[float, ...], DeviceResource](MAX_WEIGHT_BUFFERS)
        self._pending = PendingPrograms(device, self.programs)
        self._beacon = ProgressBeacon()
        self._host_jobs = HostJobs()
        self._draft_numbers = count()

    def close(self) -> None:
        """Give everything back."""
        self.closed = True
        self._host_jobs.close()
        for resources in (self.textures, self.programs, self._tables, self._meshes, self._weights):
            resources.clear()

    def upload(self, plan: Plan, upload: Upload, decoded: DecodedPicture, lease: TextureLease) -> None:
        """Write decoded pixels, or the part of them that the plan reads, into their surface.

        Raises InputError if their size is not the one that was planned for.
        """
        surface, pixels = plan.surfaces[upload.surface], decoded.pixels
        started = time.perf_counter()
        size, whole = (pixels.shape[1], pixels.shape[0]), upload.whole
        window = surface.window or Region.whole(surface.size)
        if size == whole.size and window != whole:
            top, left = window.y - whole.y, window.x - whole.x
            pixels = pixels[top : top + window.height, left : left + window.width]
        elif size != surface.size:
            raise InputError(
                f"{upload.picture.path}: it was {whole.width}x{whole.height} pixels when the rendering "
                f"began, and is {size[0]}x{size[1]} now; render again"
            )
        texture = self.write_pixels(surface, pixels, lease)
        texture.cost = decoded.seconds + time.perf_counter() - started
        self.counters.uploads += 1

    def write_pixels(self, surface: Surface, pixels: Array, lease: TextureLease) -> PooledTexture:
        """Put pixels on the device under the key of a surface. Raises DeviceError where there is no room."""
        try:
            texture = lease.create(surface)
            texture.handle.write(_convert(pixels, surface.components, surface.depth))
        except BaseException:
            lease.discard(surface.key)
            raise
        return texture

    def measure(self, plan: Plan, render_pass: Pass, lease: TextureLease) -> float:
        """Execute a pass and wait for it; the seconds that it took on the device."""
        self._await_trial(plan, render_pass)
        self.compile(render_pass)
        seconds = self.device.time(partial(self.execute, plan, render_pass, lease))
        self._costs.record_time(plan, render_pass, seconds)
        return seconds

    def compile(self, render_pass: Pass) -> None:
        """Have the program of a pass at hand. Raises ShaderError."""
        self._pending.wait_for(render_pass)
        with self._watch(render_pass):
            self.programs.get(render_pass)

    def execute(self, plan: Plan, render_pass: Pass, lease: TextureLease) -> None:
        """Run a pass whose textures are on the device. Raises ShaderError, DeviceError, RenderError."""
        for _ in self.execute_in_bands(plan, render_pass, lease):
            pass

    def execute_in_bands(
        self, plan: Plan, render_pass: Pass, lease: TextureLease, seconds: float = math.inf
    ) -> Generator[None, None, None]:
        """Run a pass as `execute` does, with a stop after every band that takes about so many seconds.

        Code of users is taken to be slow, and other passes if they were before.
        """
        self._await_trial(plan, render_pass)
        if render_pass.host is not None:
            self._execute_on_host(plan, render_pass, lease)
            return
        self._pending.wait_for(render_pass)
        with self._watch(render_pass):
            yield from self._execute(plan, render_pass, lease, seconds)

    def begin_host_job(self, plan: Plan, render_pass: Pass) -> HostJob | None:
        """Begin the work of a pass on the processor, whose textures are on the device; None where it is done."""
        key = plan.surfaces[render_pass.targets[0]].key
        if render_pass.host is None or key in self.textures:
            return None
        if job := self._host_jobs.find(key):
            return job
        numbers = {name: render_pass.textures[place] for name, place in render_pass.host.pictures}
        whole = find_host_window(plan, render_pass)
        pictures = {
            name: cut_window(self.download(plan, number), find_window(plan.surfaces[number]), whole)
            for name, number in numbers.items()
        }
        return self._host_jobs.start(key, render_pass.host.program, pictures)

    def abandon_host_job(self, plan: Plan, render_pass: Pass) -> None:
        """Say that nobody waits for the work of a pass on the processor any more."""
        self._host_jobs.abandon(plan.surfaces[render_pass.targets[0]].key)

    def _execute_on_host(self, plan: Plan, render_pass: Pass, lease: TextureLease) -> None:
        """Wait for the work of a pass on the processor, and upload its picture."""
        surface = plan.surfaces[render_pass.targets[0]]
        if self.begin_host_job(plan, render_pass) is None:  # another run was quicker
            lease.add(surface.key)
            self.counters.skipped += 1
            return
        started = time.perf_counter()
        try:
            pixels = self._host_jobs.finish(surface.key)
            pixels = cut_window(pixels, find_host_window(plan, render_pass), find_window(surface))
        except HalationError as error:
            error.node = error.node or render_pass.nodes[-1]
            raise type(error)(f"{describe_owner(error.node)}: {error}", node=error.node) from error
        texture = self.write_pixels(surface, pixels, lease)
        texture.cost = max(time.perf_counter() - started, _HOST_SECONDS)
        self.counters.passes += 1

    def begin_programs(self, plan: Plan, passes: Iterable[Pass]) -> None:
        """Begin to try programs in another process, and to compile others on threads."""
        passes = tuple(passes)
        for render_pass in passes:
            self.begin_trial(plan, render_pass)
        self._pending.begin(plan, passes)

    def has_program(self, plan: Plan, render_pass: Pass) -> bool:
        """False while the program of a pass is tried or compiled elsewhere, which `execute` would wait for."""
        trial = self.begin_trial(plan, render_pass)
        return (trial is None or trial.done()) and self._pending.are_ready(render_pass)

    def begin_trial(self, plan: Plan, render_pass: Pass) -> Future[Trial] | None:
        """Begin to try the program of a pass in another process, where it has code of users and is not known."""
        if self._trials is None or not render_pass.writers or self._beacon.replaces_trials:
            return None
        return None if render_pass.shader in self.programs else self._trials.begin(plan, render_pass)

    def _await_trial(self, plan: Plan, render_pass: Pass) -> None:
        while trial := self.begin_trial(plan, render_pass):
            with suppress(CancelledError):  # it made way for others, and is tried again
                if fault := trial.result().fault:
                    raise fault
                break
        software = self.device.target.software
        if self._trials and (fault := self._trials.find_slowness(plan, render_pass, software)):
            raise fault

    @contextmanager
    def _watch(self, render_pass: Pass) -> Iterator[None]:
        """Announce code of users to a process that watches, for as long as the device works on it."""
        if not (render_pass.writers and self._beacon.is_watched):
            yield
            return
        self.device.finish()
        with self._beacon.announce(tuple(render_pass.writers.values())):
            yield
            self.device.finish()

    def _execute(self, plan: Plan, render_pass: Pass, lease: TextureLease, seconds: float) -> Iterator[None]:
        """Run a pass for those of its pictures that are not stored yet.

        Until it is done they have keys of their own: what else is rendered between two bands, or after a failure, must
        not take a picture that is drawn in part for a whole one.
        """
        surfaces = [plan.surfaces[number] for number in render_pass.targets]
        drafts = {
            surface.key: replace(surface, key=f"draft {next(self._draft_numbers)}")
            for surface in surfaces
            if surface.key not in self.textures
        }
        for surface in surfaces:
            if surface.key not in drafts:
                lease.add(surface.key)
        if not drafts:  # another run was quicker
            self.counters.skipped += 1
            return
        try:
            for draft in drafts.values():
                lease.create(draft)
            keys = [drafts.get(surface.key, surface).key for surface in surfaces]
            yield from self._run_bands(plan, render_pass, keys, seconds)
            if error := self.device.take_error():
                raise RenderError(
                    f"{describe_owner(', '.join(render_pass.nodes))}: {self.device.target.renderer} reports {error}",
                    node=render_pass.nodes[-1],
                )
        except BaseException:
            for draft in drafts.values():
                lease.discard(draft.key)
            raise
        cost = self._costs.estimate(plan, render_pass)
        for key, draft in drafts.items():
            if key in self.textures:  # another run was quicker
                lease.discard(draft.key)
                lease.add(key)
            else:
                lease.rename(draft.key, key)
                self._find(key).cost = cost
        self.counters.passes += 1

    def _run_bands(self, plan: Plan, render_pass: Pass, targets: list[str], seconds: float) -> Iterator[None]:
        """Run a pass band by band, for targets with these keys. A band is as high as the time of the last one says.

        Between two bands others may use the device, so that each band asks for its program and textures again.
        """
        is_limited, is_compute = math.isfinite(seconds), render_pass.shader.form == "compute"
        total = render_pass.groups[1] if is_compute else plan.surfaces[render_pass.targets[0]].size[1]
        row, height, spent = 0, self._choose_rows(plan, render_pass, total, seconds), 0.0
        while row < total:
            end = min(row + height, total)
            program = self.programs.get(render_pass)
            textures = [self._find(plan.surfaces[number].key).handle for number in render_pass.textures]
            for name, number in render_pass.uniforms:
                program.set(name, number)
            started = time.perf_counter()
            rows = (row, end) if (row, end) != (0, total) else None
            self._run_pass(render_pass, program, textures, [self._find(key).handle for key in targets], rows)
            row = end
            if is_limited and row < total:
                self.device.finish()
            elapsed = time.perf_counter() - started
            spent += elapsed
            if row < total:
                yield
            if is_limited:
                height = max(1, min(int(height * seconds / max(elapsed, _LEAST_ELAPSED)), MAX_GROWTH * height))
        if is_compute and self.device.target.software:  # which returns when it is done
            self._costs.record_time(plan, render_pass, spent)

    def _choose_rows(self, plan: Plan, render_pass: Pass, total: int, seconds: float) -> int:
        """The rows of the first band: few of code of users, whose time is not known; all if the pass may be quick."""
        if render_pass.mesh is not None:
            return total
        rows = total
        if render_pass.shader.form == "compute" and self.device.target.software:
            width, height = plan.surfaces[render_pass.targets[0]].size
            rows = -(-total // -(-width * height // BAND_PIXELS))
        if not math.isfinite(seconds):
            return rows
        if render_pass.writers:
            return min(rows, max(1, total // FIRST_SHARE))
        estimate = self._costs.estimate(plan, render_pass)
        return max(1, int(rows * seconds / estimate)) if estimate > seconds else rows

    def _run_pass(
        self,
        render_pass: Pass,
        program: DeviceProgram,
        textures: list[DeviceTexture],
        targets: list[DeviceTexture],
        rows: tuple[int, int] | None,
    ) -> None:
        """Ask the device for a pass, or for a band of it: triangles of a mesh, a dispatch, or a draw over pixels."""
        shader, bindings = render_pass.shader, self._bind(render_pass, textures)
        if render_pass.mesh is not None:
            mesh = self._meshes.get(render_pass.mesh, partial(self.device.create_mesh, render_pass.mesh))
            self.device.draw_mesh(program, targets, bindings, mesh)
        elif shader.form == "compute":
            across, down, blocks = render_pass.groups
            first, end = rows or (0, down)
            groups = (across, end - first, blocks)
            self.device.dispatch(program, targets, bindings, groups, reads_images=shader.reads_images, first_row=first)
        else:
            if shader.foreign and (rows is None or rows[0] == 0):  # it may leave pixels out
                for target in targets:
                    self.device.clear(target, (0.0, 0.0, 0.0, 0.0))
            self.device.draw(program, targets, bindings, rows=rows)

    def _bind(self, render_pass: Pass, textures: list[DeviceTexture]) -> Bindings:
        """What a pass reads: its textures, and its tables and weights, uploaded where they are not there yet."""
        tables = {
            unit: self._tables.get(table, partial(self.device.create_table, table))
            for unit, table in enumerate(render_pass.tables, FIRST_TABLE)
        }
        weights = render_pass.weights
        buffer = self._weights.get(weights, partial(self._create_weights, weights)) if weights else None
        return Bindings(textures, tables, buffer, interpolated=render_pass.shader.foreign)

    def _create_weights(self, weights: tuple[float, ...]) -> DeviceResource:
        numbers = np.zeros(MAX_WEIGHTS, np.float32)
        numbers[: len(weights)] = weights
        return self.device.create_buffer(numbers)

    def _find(self, key: str) -> PooledTexture:
        """The texture of a surface that has a lease."""
        texture = self.textures.find(key)
        assert texture is not None, f"{key} is gone before its last reader"
        return texture

    def download(self, plan: Plan, number: int, create: ArrayMaker = np.empty) -> Array:
        """The pixels of a surface as [height, width, channels], in an array that `create` makes.

        By default that is numpy's, whose allocator finds the memory of the last one.
        """
        surface = plan.surfaces[number]
        width, height = surface.size
        self.device.finish()  # other threads go on meanwhile, and llvmpipe may read before the draws are done
        shape = (height, width, surface.components)
        pixels = create(shape, np.float16 if surface.depth == "f2" else np.float32)
        self._find(surface.key).handle.read_into(pixels)
        return pixels[..., : surface.channels]


def _convert(pixels: Array, components: int, depth: str) -> Array:
    """The same pixels with the components and depth of the texture."""
    dtype = np.float16 if depth == "f2" else np.float32
    if pixels.ndim == 2:
        pixels = pixels[..., None]
    missing = components - pixels.shape[2]
    if missing > 0:
        pixels = np.concatenate([pixels, np.zeros((*pixels.shape[:2], missing), pixels.dtype)], axis=2)
    with np.errstate(over="ignore"):  # too large for the texture is infinite in it
        return np.ascontiguousarray(pixels[..., :components], dtype)
