"""An OpenGL context as a device.

A draw leaves no framebuffer of ours bound: moderngl binds the last one again on its own, even one that was released.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import cached_property
from threading import current_thread, get_ident
from typing import Any, cast

import moderngl
import numpy as np
from halation.nodes import Size
from msgspec import Struct, field
from msgspec.structs import replace

from ...compiler import Target
from ...compiler.devices import is_software
from ...errors import DeviceError, UsageError
from ...resources.color_program import LookupTable
from ...resources.machine import describe_processor
from ...resources.mesh import Mesh
from ..device import Bindings, DeviceProgram, DeviceResource, DeviceTexture, PixelRect, ProgramVariant, TextureDepth
from .functions import OpenGLFunctions
from .mesh import OpenGLMesh, create_mesh
from .precompiler import Precompiler
from .program import OpenGLProgram, create_compute_program, create_program
from .texture import OpenGLTexture, create_table, create_texture

OLDEST = 410
"""The oldest OpenGL that works: macOS stops at 4.1."""


class OpenGLDevice(Struct, frozen=True, dict=True):
    """A `Device` on an OpenGL context."""

    context: moderngl.Context
    target: Target
    shared: bool = False
    """True if the context belongs to somebody else, a window say, and is current whenever we are called."""
    thread: int = field(default_factory=get_ident)
    """The thread that opened it: a context is current on one thread, and only there can it be used."""

    @property
    def driver(self) -> str:
        return str(self.context.info["GL_VERSION"])

    @property
    def description(self) -> str:
        kind = "software rasterizer" if self.target.software else "GPU"
        return f"{self.target.renderer} ({kind}, OpenGL {self.target.version / 100:.1f}, {self.target.form} passes)"

    def with_target(self, target: Target) -> OpenGLDevice:
        return replace(self, target=target)

    def make_current(self) -> AbstractContextManager[object]:
        if get_ident() != self.thread:
            name = current_thread().name
            raise UsageError(f"thread '{name}' did not open this device and cannot render on it: open one there")
        return nullcontext() if self.shared else self.context

    @contextmanager
    def save_draw_target(self) -> Iterator[moderngl.Context]:
        with self.make_current():
            before = self.context.fbo or self._idle
            try:
                yield self.context
            finally:
                before.use()

    # --- create ------------------------------------------------------------------------------------------------------

    def create_texture(
        self, size: Size, components: int, depth: TextureDepth, *, linear: bool = False
    ) -> OpenGLTexture:
        return create_texture(self.context, size, components, depth, linear, self._written)

    def create_table(self, table: LookupTable) -> DeviceResource:
        return create_table(self.context, table)

    def create_buffer(self, numbers: np.ndarray) -> DeviceResource:
        return self.context.buffer(numbers)

    def create_mesh(self, mesh: Mesh) -> DeviceResource:
        return create_mesh(self.context, mesh)

    def create_program(self, fragment: str, vertex: str = "") -> OpenGLProgram:
        return create_program(self.context, fragment, vertex)

    def create_compute_program(self, source: str) -> OpenGLProgram:
        return create_compute_program(self.context, source)

    def precompile(self, variants: Sequence[ProgramVariant]) -> Mapping[ProgramVariant, Future[float]]:
        return {} if self.shared or "llvmpipe" not in self.target.renderer else self._precompiler.begin(variants)

    # --- run ---------------------------------------------------------------------------------------------------------

    def draw(
        self,
        program: DeviceProgram,
        targets: Sequence[DeviceTexture],
        bindings: Bindings,
        *,
        viewport: PixelRect | None = None,
        rows: tuple[int, int] | None = None,
    ) -> None:
        self._bind(bindings)
        self._note_written(targets)
        interpolated = range(len(bindings.textures) if bindings.interpolated else 0)
        for unit in interpolated:
            self._interpolation.use(unit)
        framebuffer = self._framebuffer(targets)
        if viewport is not None:
            framebuffer.viewport = viewport
        if rows is not None:
            framebuffer.scissor = (0, rows[0], targets[0].size[0], rows[1] - rows[0])
        framebuffer.use()
        self.context.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        cast("OpenGLProgram", program).draw()
        for unit in interpolated:
            self._interpolation.clear(unit)
        if viewport is not None:
            framebuffer.viewport = (0, 0, *targets[0].size)
        if rows is not None:
            cast("Any", framebuffer).scissor = None  # whose stub has no None
        self._idle.use()
        if len(targets) > 1:
            framebuffer.release()

    def draw_mesh(
        self, program: DeviceProgram, targets: Sequence[DeviceTexture], bindings: Bindings, mesh: DeviceResource
    ) -> None:
        handle = cast("OpenGLProgram", program).handle
        assert isinstance(handle, moderngl.Program)
        self._bind(bindings)
        self._note_written(targets)
        depth = self.context.depth_renderbuffer(targets[0].size)
        framebuffer = self.context.framebuffer(_handles(targets), depth)
        framebuffer.use()
        framebuffer.clear()
        self.context.disable(moderngl.BLEND | moderngl.CULL_FACE)
        self.context.enable(moderngl.DEPTH_TEST)
        cast("OpenGLMesh", mesh).draw(handle)
        self.context.disable(moderngl.DEPTH_TEST)
        self._idle.use()
        framebuffer.release()
        depth.release()

    def dispatch(
        self,
        program: DeviceProgram,
        targets: Sequence[DeviceTexture],
        bindings: Bindings,
        groups: tuple[int, int, int],
        *,
        reads_images: bool,
        first_row: int = 0,
    ) -> None:
        handle = cast("OpenGLProgram", program).handle
        assert isinstance(handle, moderngl.ComputeShader)
        self._bind(bindings, as_images=reads_images)
        self._note_written(targets)
        first = len(bindings.textures) if reads_images else 0
        for unit, texture in enumerate(_handles(targets), first):
            texture.bind_to_image(unit, read=False, write=True)
        program.set("first_row", first_row)
        self._functions.dispatch(handle, groups)
        self.context.memory_barrier()

    def clear(self, texture: DeviceTexture, color: tuple[float, float, float, float]) -> None:
        self._note_written((texture,))
        framebuffer = cast("OpenGLTexture", texture).framebuffer
        framebuffer.use()
        framebuffer.clear(*color)
        self._idle.use()

    def read_region(self, texture: DeviceTexture, region: PixelRect) -> np.ndarray:
        _, _, width, height = region
        pixels = np.empty((height, width, texture.components), np.float32)
        framebuffer = cast("OpenGLTexture", texture).framebuffer
        framebuffer.read_into(pixels, viewport=region, components=texture.components, dtype="f4", alignment=1)
        return pixels

    def finish(self) -> None:
        self._functions.finish()

    def time(self, work: Callable[[], None]) -> float:
        if self.target.software:  # its timer queries leave most of the work out
            self.finish()
            started = time.perf_counter()
            work()
            self.finish()
            return time.perf_counter() - started
        with self._timer:
            work()
        return self._timer.elapsed / 1e9

    def forget_bindings(self) -> None:
        if self.target.form == "compute":  # Mesa binds images only when it runs a program
            self._functions.dispatch(self._nothing, (1, 1, 1))

    def take_error(self) -> str:
        error = self.context.error
        return "" if error == "GL_NO_ERROR" else error

    def take_written(self) -> frozenset[int]:
        written = frozenset(self._written)
        self._written.clear()
        return written

    # --- the window it draws to --------------------------------------------------------------------------------------

    def target_window(self) -> None:
        self.context.screen.use()

    def clear_window(self, region: PixelRect, color: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        self.context.screen.clear(*color, viewport=region)

    def read_window_pixel(self) -> tuple[int, int, int]:
        self._update_window()
        red, green, blue = self.context.screen.read((0, 0, 1, 1), components=3, alignment=1)
        return red, green, blue

    def read_window(self, size: tuple[int, int]) -> np.ndarray:
        self._update_window()
        width, height = size
        pixels = np.frombuffer(self.context.screen.read((0, 0, *size), components=3, alignment=1), np.uint8)
        return pixels.reshape(height, width, 3)[::-1]

    def close(self) -> None:
        if "_precompiler" in self.__dict__:
            self._precompiler.close()
        self.context.release()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _update_window(self) -> None:
        """Let the driver notice a new size of the window. Mesa 22 ends the process in a read that is the first to."""
        self.context.screen.clear(viewport=(1, 0, 1, 1))

    @cached_property
    def _idle(self) -> moderngl.Framebuffer:
        """What stays bound between draws: a target must not, as it may be released before the next draw."""
        return self.context.framebuffer([self.context.texture((1, 1), 1)])

    @cached_property
    def _functions(self) -> OpenGLFunctions:
        return OpenGLFunctions(self.context)

    @cached_property
    def _nothing(self) -> moderngl.ComputeShader:
        """A program that reads and writes nothing."""
        return self.context.compute_shader("#version 430 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n")

    @cached_property
    def _interpolation(self) -> moderngl.Sampler:
        return self.context.sampler(repeat_x=False, repeat_y=False, filter=(moderngl.LINEAR, moderngl.LINEAR))

    @cached_property
    def _precompiler(self) -> Precompiler:
        return Precompiler(f"{self.target.renderer}\0{self.driver}\0{describe_processor()}")

    @cached_property
    def _timer(self) -> moderngl.Query:
        return self.context.query(time=True)

    @cached_property
    def _written(self) -> set[int]:
        return set()

    def _note_written(self, targets: Sequence[DeviceTexture]) -> None:
        self._written.update(target.native_handle for target in targets)

    def _bind(self, bindings: Bindings, *, as_images: bool = False) -> None:
        for unit, texture in enumerate(_handles(bindings.textures)):
            if as_images:
                texture.bind_to_image(unit, read=True, write=False)
            else:
                texture.use(unit)
        for unit, table in bindings.tables.items():
            cast("moderngl.Texture", table).use(unit)
        if bindings.weights is not None:
            cast("moderngl.Buffer", bindings.weights).bind_to_uniform_block(0)

    def _framebuffer(self, targets: Sequence[DeviceTexture]) -> moderngl.Framebuffer:
        """One texture has its own; for several of them one is made, and released after the draw."""
        if len(targets) == 1:
            return cast("OpenGLTexture", targets[0]).framebuffer
        return self.context.framebuffer(_handles(targets))


def _handles(textures: Sequence[DeviceTexture]) -> list[moderngl.Texture]:
    return [texture.handle for texture in cast("Sequence[OpenGLTexture]", textures)]


def describe_target(context: moderngl.Context) -> Target:
    """What a context can do; the form of passes is left as it is by default. Raises DeviceError for one too old."""
    info = context.info
    renderer = str(info["GL_RENDERER"])
    version = context.version_code
    if version < OLDEST:
        raise DeviceError(
            f"{renderer} offers OpenGL {version / 100:.1f}, but at least {OLDEST / 100:.1f} is needed: "
            "update the graphics driver, or install Mesa's software rasterizer"
        )
    software = is_software(renderer)
    return Target(
        renderer,
        version,
        software,
        max_size=int(info["GL_MAX_TEXTURE_SIZE"]),
        max_samplers=int(info["GL_MAX_TEXTURE_IMAGE_UNITS"]),
        precision="float" if software else "half",
    )
