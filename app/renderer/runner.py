"""Runs plans. It knows nothing of graphs and nodes: only passes, surfaces and keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import moderngl
import numpy as np

from ..compiler import MAX_WEIGHTS, Memory, Pass, Plan
from ..errors import InputError, RenderError, UsageError
from .decoding import Array, Decoding, Loader
from .device import Device
from .programs import Program, Programs
from .textures import Lease, Texture, Textures

MAX_WEIGHT_BUFFERS = 64

BAND_PIXELS = 2**21
"""The software rasterizer computes at most so many pixels at a time: an interrupt is heard only in between."""


@dataclass
class Counters:
    """What a runner has done since it was made."""

    passes: int = 0
    uploads: int = 0
    skipped: int = 0


class Runner:
    """Executes plans on one device, keeping programs, textures and results between them."""

    def __init__(self, device: Device, load: Loader, budget: int) -> None:
        self.device, self._load = device, load
        self.programs = Programs(device.context)
        self.textures = Textures(device.context, budget)
        self.counters = Counters()
        self._weights: dict[tuple[float, ...], moderngl.Buffer] = {}
        self._history = Lease(self.textures)
        self.memories: Mapping[str, Memory] = {}
        """What temporal nodes remember of the last plan that ran to its end."""
        self._idle: moderngl.Framebuffer | None = None
        self._closed = False
        self._threads = ThreadPoolExecutor(max_workers=2, thread_name_prefix="decode")

    def run(self, plan: Plan) -> dict[str, Array]:
        """Run to the end; the outputs as [height, width, channels]."""
        outputs: dict[str, Array] = {}
        for _ in self.steps(plan, outputs):
            pass
        return outputs

    def steps(self, plan: Plan, outputs: dict[str, Array]) -> Iterator[Pass]:
        """Run one pass per step, so that a caller can stop in between; fills `outputs` at the end.

        Several plans may be under way at once, step by step.
        """
        if self._closed:
            raise UsageError("this renderer is closed: make another one")
        wanted, needed = _needed(plan, self.textures)
        self.counters.skipped += len(plan.passes) - len(needed)
        readers = _count_readers(plan, needed, wanted)
        decoding = self._decoding(plan, needed, wanted)
        lease = Lease(self.textures)
        try:
            for key in readers:
                if key in self.textures:
                    lease.take(key)
            for index in needed:
                one = plan.passes[index]
                with self.device.current():
                    self._upload(plan, one.textures, decoding, lease)
                    self._execute(plan, one, lease)
                    for key in (plan.surfaces[number].key for number in one.textures):
                        readers[key] -= 1
                        if readers[key] == 0:
                            lease.give(key)
                yield one
            with self.device.current():
                self._upload(plan, tuple(plan.outputs.values()), decoding, lease)
                for name, number in plan.outputs.items():
                    outputs[name] = self._download(plan, number)
            self._remember(plan)
        finally:
            decoding.cancel()
            if not self._closed:
                lease.close()
                with self.device.current():
                    self.textures.next_round()

    def close(self) -> None:
        """Give everything back. Runs that are under way end here."""
        if self._closed:
            return
        self._closed = True
        self._threads.shutdown(cancel_futures=True)
        with self.device.current():
            self.textures.clear()
            self.programs.clear()
            for buffer in self._weights.values():
                buffer.release()
            self._weights.clear()
            if self._idle is not None:
                self._idle.release()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _decoding(self, plan: Plan, needed: list[int], wanted: set[int]) -> Decoding:
        """What must be decoded, in the order in which passes want it."""
        reads = dict.fromkeys(number for index in needed for number in plan.passes[index].textures)
        order = {number: place for place, number in enumerate([*reads, *(wanted - reads.keys())])}
        uploads = [
            upload for upload in plan.uploads
            if upload.surface in order and plan.surfaces[upload.surface].key not in self.textures
        ]
        return Decoding(self._threads, self._load, sorted(uploads, key=lambda upload: order[upload.surface]))

    def _upload(self, plan: Plan, numbers: tuple[int, ...], decoding: Decoding, lease: Lease) -> None:
        for number in numbers:
            if number not in decoding:
                continue
            surface = plan.surfaces[number]
            if surface.key in self.textures:
                decoding.skip(number)
                lease.take(surface.key)
                continue
            upload, pixels = decoding.take(number)
            found = (pixels.shape[1], pixels.shape[0])
            if found != surface.size:
                raise InputError(
                    f"{upload.picture.path}: it was {surface.size[0]}x{surface.size[1]} pixels when the rendering "
                    f"began, and is {found[0]}x{found[1]} now; render again"
                )
            try:
                lease.make(surface).handle.write(_fitting(pixels, surface.components, surface.depth))
            except BaseException:
                lease.spoil(surface.key)
                raise
            self.counters.uploads += 1

    def _execute(self, plan: Plan, one: Pass, lease: Lease) -> None:
        targets = [plan.surfaces[number] for number in one.targets]
        missing = [surface for surface in targets if surface.key not in self.textures]
        for surface in targets:
            if surface not in missing:
                lease.take(surface.key)
        if not missing:  # another run was quicker
            self.counters.skipped += 1
            return
        program = self.programs.get(one)
        textures = [self._resident(plan, number) for number in one.textures]
        try:
            for surface in missing:
                lease.make(surface)
            made = [self._resident(plan, number) for number in one.targets]
            for name, value in one.uniforms:
                program.set(name, value)
            if one.weights:
                self._weight_buffer(one.weights).bind_to_uniform_block(0)
            if one.shader.form == "compute":
                self._dispatch(plan, one, program, textures, made)
            else:
                self._draw(one, program.vertices, textures, made)
            error = self.device.context.error
            if error != "GL_NO_ERROR":
                raise RenderError(f"node '{', '.join(one.nodes)}': {self.device.target.renderer} reports {error}")
        except BaseException:
            for surface in missing:
                lease.spoil(surface.key)
            raise
        self.counters.passes += 1

    def _dispatch(
        self, plan: Plan, one: Pass, program: Program, textures: list[Texture], made: list[Texture]
    ) -> None:
        assert isinstance(program.handle, moderngl.ComputeShader)
        first = 0
        if one.shader.reads_images:
            first = len(textures)
            for unit, texture in enumerate(textures):
                texture.handle.bind_to_image(unit, read=True, write=False)
        else:
            for unit, texture in enumerate(textures):
                texture.handle.use(unit)
        for unit, texture in enumerate(made):
            texture.handle.bind_to_image(first + unit, read=False, write=True)
        across, down = one.groups
        width, height = plan.surfaces[one.targets[0]].size
        bands = -(-width * height // BAND_PIXELS) if self.device.target.software else 1
        step = -(-down // bands)
        for row in range(0, down, step):
            program.set("first_row", row)
            program.handle.run(across, min(step, down - row))
        self.device.context.memory_barrier()

    def _draw(
        self, one: Pass, vertices: moderngl.VertexArray | None, textures: list[Texture], made: list[Texture]
    ) -> None:
        assert vertices is not None
        context = self.device.context
        for unit, texture in enumerate(textures):
            texture.handle.use(unit)
        alone = made[0] if len(made) == 1 else None
        framebuffer = alone.framebuffer if alone else None
        if framebuffer is None:
            framebuffer = context.framebuffer([texture.handle for texture in made])
        framebuffer.use()
        context.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        vertices.render(moderngl.TRIANGLES, vertices=3)
        self._rest().use()
        if alone:
            alone.framebuffer = framebuffer
        else:
            framebuffer.release()

    def _rest(self) -> moderngl.Framebuffer:
        """What stays bound between draws: moderngl rebinds the last framebuffer, even one that was released."""
        if self._idle is None:
            context = self.device.context
            self._idle = context.framebuffer([context.texture((1, 1), 1)])
        return self._idle

    def _weight_buffer(self, weights: tuple[float, ...]) -> moderngl.Buffer:
        known = self._weights.get(weights)
        if known is None:
            if len(self._weights) >= MAX_WEIGHT_BUFFERS:
                self._weights.pop(next(iter(self._weights))).release()
            data = np.zeros(MAX_WEIGHTS, np.float32)
            data[: len(weights)] = weights
            known = self._weights[weights] = self.device.context.buffer(data)
        return known

    def _resident(self, plan: Plan, number: int) -> Texture:
        texture = self.textures.find(plan.surfaces[number].key)
        assert texture is not None, f"surface {number} is gone before its last reader"
        return texture

    def _remember(self, plan: Plan) -> None:
        """Keep what the next frame will want, and let go of what this one wanted."""
        before, self._history = self._history, Lease(self.textures)
        for memory in plan.memories.values():
            self._history.take(memory.key)
        self.memories = plan.memories
        before.close()

    def _download(self, plan: Plan, number: int) -> Array:
        surface = plan.surfaces[number]
        width, height = surface.size
        pixels = np.empty((height, width, surface.components), np.float16 if surface.depth == "f2" else np.float32)
        self._resident(plan, number).handle.read_into(pixels)
        return pixels[..., : surface.channels]


def _needed(plan: Plan, textures: Textures) -> tuple[set[int], list[int]]:
    """The output surfaces, and the passes that must run because nobody has their pixels."""
    makers = {number: index for index, one in enumerate(plan.passes) for number in one.targets}
    wanted = set(plan.outputs.values())
    remembered = {memory.key for memory in plan.memories.values()}
    passes: set[int] = set()
    todo = [*wanted, *(number for number, item in enumerate(plan.surfaces) if item.key in remembered)]
    while todo:
        number = todo.pop()
        index = makers.get(number)
        if index is None or index in passes or plan.surfaces[number].key in textures:
            continue
        passes.add(index)
        todo.extend(plan.passes[index].textures)
    return wanted, sorted(passes)


def _count_readers(plan: Plan, needed: list[int], wanted: set[int]) -> dict[str, int]:
    """How often each surface will be read; outputs are read once more, at the end."""
    found: dict[str, int] = {}
    for index in needed:
        for number in plan.passes[index].textures:
            key = plan.surfaces[number].key
            found[key] = found.get(key, 0) + 1
    for number in wanted:
        key = plan.surfaces[number].key
        found[key] = found.get(key, 0) + 1
    return found


def _fitting(pixels: Array, components: int, depth: str) -> Array:
    """The same pixels with the components and depth of the texture."""
    dtype = np.float16 if depth == "f2" else np.float32
    if pixels.ndim == 2:
        pixels = pixels[..., None]
    missing = components - pixels.shape[2]
    if missing > 0:
        pixels = np.concatenate([pixels, np.zeros((*pixels.shape[:2], missing), pixels.dtype)], axis=2)
    with np.errstate(over="ignore"):  # too large for the texture is infinite in it
        return np.ascontiguousarray(pixels[..., :components], dtype)
