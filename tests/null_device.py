"""A device without pixels: it records what it is asked to do, and refuses what no device could do.

Textures remember whether they hold pixels and whether they were released. A draw or dispatch fails that reads a
texture without pixels, reads what it writes, or uses anything that was released or belongs to another device.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from halation.compiler import Target
from halation.nodes import Size
from halation.renderer.device import (
    Bindings,
    DeviceProgram,
    DeviceResource,
    DeviceTexture,
    PixelRect,
    ProgramVariant,
    TextureDepth,
)
from halation.resources.color_program import LookupTable
from halation.resources.mesh import Mesh


@dataclass(eq=False)
class NullResource:
    """Anything on the device: it may be released once."""

    device: NullDevice
    released: bool = False

    def __post_init__(self) -> None:
        self.device.live.append(self)

    def use(self) -> None:
        """Fail if the device cannot use it any more."""
        assert not self.released, "it was released"

    def release(self) -> None:
        self.use()
        self.released = True
        self.device.live.remove(self)


@dataclass(eq=False)
class NullTexture(NullResource):
    """A texture that knows whether it has pixels."""

    size: Size = (1, 1)
    components: int = 4
    depth: TextureDepth = "f4"
    filled: bool = False
    native_handle: int = 0

    def write(self, pixels: np.ndarray) -> None:
        self.use()
        width, height = self.size
        assert pixels.shape == (height, width, self.components) and pixels.flags.c_contiguous
        assert pixels.dtype == {"f1": np.uint8, "f2": np.float16, "f4": np.float32}[self.depth]
        self.filled = True
        self.device.writes.append(self)

    def read_into(self, pixels: np.ndarray) -> None:
        self.use()
        assert self.filled, "nothing was drawn into it"
        width, height = self.size
        assert pixels.shape == (height, width, self.components)
        pixels[...] = 0.0
        self.device.reads.append(self)


@dataclass(eq=False)
class NullProgram(NullResource):
    """A program that knows its source."""

    source: str = ""
    uniforms: dict[str, object] = field(default_factory=dict)

    def set(self, name: str, value: object) -> None:
        self.use()
        self.uniforms[name] = value


@dataclass(frozen=True)
class Command:
    """One draw or dispatch."""

    source: str
    textures: tuple[NullTexture, ...]
    targets: tuple[NullTexture, ...]


class NullDevice:
    """Implements `Device`. `live` is what was not released yet."""

    def __init__(self, target: Target) -> None:
        self._target = target
        self.driver, self.description = "none", "a device without pixels"
        self.live: list[NullResource] = []
        self.commands: list[Command] = []
        self.writes: list[NullTexture] = []
        self.reads: list[NullTexture] = []
        self.created_textures = 0
        self.closed = False

    @property
    def target(self) -> Target:
        return self._target

    def with_target(self, target: Target) -> NullDevice:
        self._target = target
        return self

    @contextmanager
    def make_current(self) -> Iterator[None]:
        assert not self.closed
        yield

    save_draw_target = make_current

    def create_texture(self, size: Size, components: int, depth: TextureDepth, *, linear: bool = False) -> NullTexture:
        assert max(size) <= self.target.max_size and min(size) > 0
        self.created_textures += 1
        return NullTexture(self, False, size, components, depth, native_handle=self.created_textures)

    def create_table(self, table: LookupTable) -> NullResource:
        return NullResource(self)

    def create_buffer(self, numbers: np.ndarray) -> NullResource:
        return NullResource(self)

    def create_mesh(self, mesh: Mesh) -> NullResource:
        return NullResource(self)

    def create_program(self, fragment: str, vertex: str = "") -> NullProgram:
        return NullProgram(self, source=fragment)

    def create_compute_program(self, source: str) -> NullProgram:
        return NullProgram(self, source=source)

    def precompile(self, variants: Sequence[ProgramVariant]) -> dict[ProgramVariant, Future[float]]:
        return {}

    def draw(
        self,
        program: DeviceProgram,
        targets: Sequence[DeviceTexture],
        bindings: Bindings,
        *,
        viewport: PixelRect | None = None,
        rows: tuple[int, int] | None = None,
    ) -> None:
        self._record(program, targets, bindings)

    def draw_mesh(
        self, program: DeviceProgram, targets: Sequence[DeviceTexture], bindings: Bindings, mesh: DeviceResource
    ) -> None:
        _ours(mesh).use()
        self._record(program, targets, bindings)

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
        assert min(groups) > 0 and first_row >= 0
        self._record(program, targets, bindings)

    def clear(self, texture: DeviceTexture, color: tuple[float, float, float, float]) -> None:
        _ours(texture).use()

    def read_region(self, texture: DeviceTexture, region: PixelRect) -> np.ndarray:
        return np.zeros((region[3], region[2], texture.components), np.float32)

    def finish(self) -> None:
        pass

    def time(self, work: Callable[[], None]) -> float:
        work()
        return 1e-3

    def take_error(self) -> str:
        return ""

    def forget_bindings(self) -> None:
        """It remembers none."""

    def take_written(self) -> frozenset[int]:
        return frozenset()

    def target_window(self) -> None:
        pass

    def clear_window(self, region: PixelRect, color: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        pass

    def read_window_pixel(self) -> tuple[int, int, int]:
        return 0, 0, 0

    def read_window(self, size: tuple[int, int]) -> np.ndarray:
        return np.zeros((*size[::-1], 3), np.uint8)

    def close(self) -> None:
        self.closed = True

    def _record(self, program: DeviceProgram, targets: Sequence[DeviceTexture], bindings: Bindings) -> None:
        assert isinstance(program, NullProgram)
        textures = tuple(_texture(texture) for texture in bindings.textures)
        written = tuple(_texture(texture) for texture in targets)
        weights = [bindings.weights] if bindings.weights is not None else []
        for resource in (program, *textures, *written, *map(_ours, (*bindings.tables.values(), *weights))):
            resource.use()
            assert resource.device is self
        assert all(texture.filled for texture in textures), "a texture is read before anything was drawn into it"
        assert not set(map(id, textures)) & set(map(id, written)), "a texture is read and written at once"
        assert len({texture.size for texture in written}) == 1
        for texture in written:
            texture.filled = True
        self.commands.append(Command(program.source, textures, written))


def _ours(resource: DeviceResource) -> NullResource:
    assert isinstance(resource, NullResource)
    return resource


def _texture(texture: DeviceTexture) -> NullTexture:
    assert isinstance(texture, NullTexture)
    return texture
