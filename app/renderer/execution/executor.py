"""Executes single passes, uploads and downloads. It knows nothing of what comes before and after."""

from __future__ import annotations

import time

import moderngl
import numpy as np
from msgspec import Struct

from ...compiler import FIRST_TABLE, MAX_WEIGHTS, Pass, Plan, Shader, Upload
from ...errors import InputError, RenderError
from ...resources.mesh import Mesh
from ..opengl.device import Device
from ..opengl.heartbeat import Heartbeat
from ..opengl.meshes import MeshBuffers
from ..opengl.programs import Program, Programs
from ..opengl.tables import Tables
from ..opengl.textures import Lease, Texture, Textures
from .arrays import Arrays
from .costs import Costs
from .decoding import Array, Decoded

MAX_WEIGHT_BUFFERS = 64

BAND_PIXELS = 2**21
"""The software rasterizer computes at most so many pixels at a time: an interrupt is heard only in between."""


class Counters(Struct):
    """What a runner has done since it was made."""

    passes: int = 0
    uploads: int = 0
    skipped: int = 0


class Executor:
    """Programs, textures and buffers on one device, and what is done with them."""

    def __init__(self, device: Device, budget: int) -> None:
        self.device = device
        self.programs = Programs(device.context)
        self.textures = Textures(device.context, budget)
        self.counters = Counters()
        self.closed = False
        self._costs = Costs(device.target.software)
        self._tables = Tables(device.context)
        self._meshes = MeshBuffers(device.context)
        self._filtered = device.context.sampler(
            repeat_x=False, repeat_y=False, filter=(moderngl.LINEAR, moderngl.LINEAR)
        )
        self._weights: dict[tuple[float, ...], moderngl.Buffer] = {}
        self._query: moderngl.Query | None = None
        self._heart = Heartbeat()

    def close(self) -> None:
        """Give everything back."""
        self.closed = True
        self.textures.clear()
        self.programs.clear()
        self._tables.clear()
        self._meshes.clear()
        self._filtered.release()
        for buffer in self._weights.values():
            buffer.release()
        self._weights.clear()

    def upload(self, plan: Plan, upload: Upload, decoded: Decoded, lease: Lease) -> None:
        """Write decoded pixels, or the part that is wanted of them, into their surface.

        Raises InputError if they are not those that were planned for.
        """
        surface, pixels = plan.surfaces[upload.surface], decoded.pixels
        started = time.perf_counter()
        found = (pixels.shape[1], pixels.shape[0])
        if surface.window and found == upload.whole:
            rows, columns = (slice(*span) for span in (surface.window.down, surface.window.across))
            pixels = pixels[rows, columns]
        elif found != surface.size:
            raise InputError(
                f"{upload.picture.path}: it was {upload.whole[0]}x{upload.whole[1]} pixels when the rendering "
                f"began, and is {found[0]}x{found[1]} now; render again"
            )
        try:
            texture = lease.make(surface)
            texture.handle.write(_fitting(pixels, surface.components, surface.depth))
            texture.cost = decoded.seconds + time.perf_counter() - started
        except BaseException:
            lease.spoil(surface.key)
            raise
        self.counters.uploads += 1

    def timed(self, plan: Plan, one: Pass, lease: Lease) -> float:
        """Execute a pass and wait for it; the seconds that it took on the device."""
        context = self.device.context
        self.programs.get(one)
        if self.device.target.software:  # its timer queries leave most of the work out
            context.finish()
            started = time.perf_counter()
            self.execute(plan, one, lease)
            context.finish()
            seconds = time.perf_counter() - started
        else:
            if self._query is None:
                self._query = context.query(time=True)
            with self._query:
                self.execute(plan, one, lease)
            seconds = self._query.elapsed / 1e9
        self._costs.learn(plan, one, seconds)
        return seconds

    def execute(self, plan: Plan, one: Pass, lease: Lease) -> None:
        """Run a pass whose textures are on the device. Raises ShaderError, DeviceError, RenderError."""
        if not (one.writers and self._heart.watched):
            self._execute(plan, one, lease)
            return
        self.device.context.finish()
        with self._heart.running(tuple(one.writers.values())):
            self._execute(plan, one, lease)
            self.device.context.finish()

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
        textures = [self.resident(plan, number) for number in one.textures]
        try:
            for surface in missing:
                lease.make(surface)
            made = [self.resident(plan, number) for number in one.targets]
            for name, value in one.uniforms:
                program.set(name, value)
            for unit, table in enumerate(one.tables, FIRST_TABLE):
                self._tables.use(table, unit)
            if one.weights:
                self._weight_buffer(one.weights).bind_to_uniform_block(0)
            if one.mesh is not None:
                self._rasterize(one.mesh, program, made)
            elif one.shader.form == "compute":
                started = time.perf_counter()
                self._dispatch(plan, one, program, textures, made)
                if self.device.target.software:  # which returns when it is done
                    self._costs.learn(plan, one, time.perf_counter() - started)
            else:
                self._draw(one.shader, program.vertices, textures, made)
            error = self.device.context.error
            if error != "GL_NO_ERROR":
                raise RenderError(
                    f"node '{', '.join(one.nodes)}': {self.device.target.renderer} reports {error}",
                    node=one.nodes[-1],
                )
        except BaseException:
            for surface in missing:
                lease.spoil(surface.key)
            raise
        for texture in made:
            texture.cost = self._costs.of(plan, one)
        self.counters.passes += 1

    def _dispatch(self, plan: Plan, one: Pass, program: Program, textures: list[Texture], made: list[Texture]) -> None:
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
        across, down, blocks = one.groups
        width, height = plan.surfaces[one.targets[0]].size
        bands = -(-width * height // BAND_PIXELS) if self.device.target.software else 1
        step = -(-down // bands)
        for row in range(0, down, step):
            program.set("first_row", row)
            program.handle.run(across, min(step, down - row), blocks)
        self.device.context.memory_barrier()

    def _draw(
        self, shader: Shader, vertices: moderngl.VertexArray | None, textures: list[Texture], made: list[Texture]
    ) -> None:
        assert vertices is not None
        context = self.device.context
        for unit, texture in enumerate(textures):
            texture.handle.use(unit)
            if shader.foreign:
                self._filtered.use(unit)
        alone = made[0] if len(made) == 1 else None
        framebuffer = alone.framebuffer if alone else None
        if framebuffer is None:
            framebuffer = context.framebuffer([texture.handle for texture in made])
        framebuffer.use()
        context.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        if shader.foreign:
            framebuffer.clear()
        strip = bool(shader.vertex)
        vertices.render(moderngl.TRIANGLE_STRIP if strip else moderngl.TRIANGLES, vertices=4 if strip else 3)
        for unit in range(len(textures) if shader.foreign else 0):
            self._filtered.clear(unit)
        self.device.idle.use()
        if alone:
            alone.framebuffer = framebuffer
        else:
            framebuffer.release()

    def _rasterize(self, mesh: Mesh, program: Program, made: list[Texture]) -> None:
        assert isinstance(program.handle, moderngl.Program)
        context, depth = self.device.context, self.device.context.depth_renderbuffer(made[0].handle.size)
        framebuffer = context.framebuffer([texture.handle for texture in made], depth)
        framebuffer.use()
        framebuffer.clear()
        context.disable(moderngl.BLEND | moderngl.CULL_FACE)
        context.enable(moderngl.DEPTH_TEST)
        self._meshes.draw(mesh, program.handle)
        context.disable(moderngl.DEPTH_TEST)
        self.device.idle.use()
        framebuffer.release()
        depth.release()

    def _weight_buffer(self, weights: tuple[float, ...]) -> moderngl.Buffer:
        known = self._weights.get(weights)
        if known is None:
            if len(self._weights) >= MAX_WEIGHT_BUFFERS:
                self._weights.pop(next(iter(self._weights))).release()
            data = np.zeros(MAX_WEIGHTS, np.float32)
            data[: len(weights)] = weights
            known = self._weights[weights] = self.device.context.buffer(data)
        return known

    def resident(self, plan: Plan, number: int) -> Texture:
        """The texture of a surface that somebody leases."""
        texture = self.textures.find(plan.surfaces[number].key)
        assert texture is not None, f"surface {number} is gone before its last reader"
        return texture

    def download(self, plan: Plan, number: int, arrays: Arrays) -> Array:
        """The pixels of a surface as [height, width, channels], in one of the `arrays`."""
        surface = plan.surfaces[number]
        width, height = surface.size
        if self.device.target.software:  # llvmpipe may read a texture before the draws into it are done
            self.device.context.finish()
        shape = (height, width, surface.components)
        pixels = arrays.take(shape, np.float16 if surface.depth == "f2" else np.float32)
        self.resident(plan, number).handle.read_into(pixels)
        return pixels[..., : surface.channels]


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
