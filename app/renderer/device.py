"""The device as the renderer and the editor see it: a small interface over OpenGL.

`opengl` implements it and is the only room that knows the graphics library. Tests implement it without pixels. Objects
on the device (textures, programs, meshes, buffers) are handles: whoever creates one releases it. All calls belong on
the thread that opened the device, inside `make_current` or `save_draw_target`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager
from typing import Literal, Protocol

import numpy as np
from halation.nodes import Size
from msgspec import Struct, field

from ..compiler import Target
from ..resources.color_program import LookupTable
from ..resources.mesh import Mesh

TextureDepth = Literal["f1", "f2", "f4"]
"""The type of a channel: 8 bits from 0 to 1, half float, float."""

PixelRect = tuple[int, int, int, int]
"""x, y, width, height in pixels of a texture, row 0 on top."""

WEIGHTS_BLOCK = "Weights"
"""The uniform block of a program that reads weights: see `Bindings.weights`."""


class DeviceResource(Protocol):
    """Something that lives on the device."""

    def release(self) -> None:
        """Give it back to the driver. It cannot be used any more."""
        ...


class DeviceTexture(DeviceResource, Protocol):
    """A two-dimensional texture, clamped at its edges."""

    @property
    def size(self) -> Size:
        """Width and height in pixels."""
        ...

    @property
    def components(self) -> int:
        """Channels that are stored: 1, 2 or 4."""
        ...

    @property
    def native_handle(self) -> int:
        """The number by which the graphics library knows it: what a window library draws it by."""
        ...

    def write(self, pixels: np.ndarray) -> None:
        """Replace its pixels by [height, width, components] of its own depth, contiguous."""
        ...

    def read_into(self, pixels: np.ndarray) -> None:
        """Copy its pixels into an array of the same shape and depth."""
        ...


class DeviceProgram(DeviceResource, Protocol):
    """A compiled program and the values of its uniforms."""

    def set(self, name: str, value: object) -> None:
        """Set a uniform. Nothing happens where the program does not read it."""
        ...


class ImageKind(Struct, frozen=True):
    """What a driver compiles a program for, of a picture that it reads or writes."""

    is_wide_power: bool
    """Whether the width is a power of two."""
    is_high_power: bool
    """Whether the height is one."""
    components: int
    depth: TextureDepth


class ProgramVariant(Struct, frozen=True):
    """A compute program, and the images for which it is compiled: a driver makes other code for other kinds."""

    source: str
    textures: tuple[ImageKind, ...]
    targets: tuple[ImageKind, ...]

    @property
    def identity(self) -> str:
        """A text that no other one has."""
        return f"{self.textures}{self.targets}{self.source}"


class Bindings(Struct, frozen=True):
    """What a program reads in one draw or dispatch."""

    textures: Sequence[DeviceTexture] = ()
    """Bound to texture or image units from 0 on."""
    tables: Mapping[int, DeviceResource] = field(default_factory=dict[int, DeviceResource])
    """Tables of color programs by texture unit."""
    weights: DeviceResource | None = None
    """A buffer for the uniform block `WEIGHTS_BLOCK`."""
    interpolated: bool = False
    """Samplers interpolate the textures, whatever they do otherwise."""


class Device(Protocol):
    """What runs programs: a GPU, or a software rasterizer."""

    @property
    def target(self) -> Target:
        """Its name and limits, as the compiler wants them."""
        ...

    @property
    def driver(self) -> str:
        """The driver's version, such as `4.5 (Core Profile) Mesa 22.3.6`."""
        ...

    @property
    def description(self) -> str:
        """One line about the device, for users."""
        ...

    def with_target(self, target: Target) -> Device:
        """The same device, for which plans are made otherwise: in another form, say, or within less memory."""
        ...

    def make_current(self) -> AbstractContextManager[object]:
        """Calls inside this block go to this device. Raises UsageError on a thread that did not open it."""
        ...

    def save_draw_target(self) -> AbstractContextManager[object]:
        """As `make_current`; after the block, others draw to the same framebuffer as before it."""
        ...

    # --- create ------------------------------------------------------------------------------------------------------

    def create_texture(
        self, size: Size, components: int, depth: TextureDepth, *, linear: bool = False
    ) -> DeviceTexture:
        """A texture of undefined pixels; with `linear`, samplers interpolate it. Raises DeviceError without room."""
        ...

    def create_table(self, table: LookupTable) -> DeviceResource:
        """The table of a color program as a texture of two or three dimensions."""
        ...

    def create_buffer(self, numbers: np.ndarray) -> DeviceResource:
        """A buffer that holds an array."""
        ...

    def create_mesh(self, mesh: Mesh) -> DeviceResource:
        """The vertices and triangles of a mesh."""
        ...

    def create_program(self, fragment: str, vertex: str = "") -> DeviceProgram:
        """Compile a fragment shader. A vertex shader gets a strip of four vertices, or those of a mesh.

        Without one all pixels of the targets are covered. Raises DeviceError with the log of a driver that refuses it.
        """
        ...

    def create_compute_program(self, source: str) -> DeviceProgram:
        """Compile a compute shader. Raises DeviceError with the log of a driver that refuses it."""
        ...

    def precompile(self, variants: Sequence[ProgramVariant]) -> Mapping[ProgramVariant, Future[float]]:
        """Begin to compile programs on other threads, if that is quicker than to compile them when they run.

        A future has the time by `time.monotonic` from which on a program can be created without compiling it.
        """
        ...

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
        """Draw over all pixels of `targets`, or of their `viewport`; with `rows` only those of them are written."""
        ...

    def draw_mesh(
        self, program: DeviceProgram, targets: Sequence[DeviceTexture], bindings: Bindings, mesh: DeviceResource
    ) -> None:
        """Draw the nearest triangles of a mesh on cleared targets."""
        ...

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
        """Run a compute program whose work groups write all pixels of `targets`.

        With `reads_images` textures are bound to image units, before the targets, instead of texture units. The rows of
        groups begin at `first_row`: a band of a picture may be computed by itself.
        """
        ...

    def clear(self, texture: DeviceTexture, color: tuple[float, float, float, float]) -> None:
        """Fill a texture with one color."""
        ...

    def read_region(self, texture: DeviceTexture, region: PixelRect) -> np.ndarray:
        """Pixels of a texture as [height, width, components] of float32."""
        ...

    def finish(self) -> None:
        """Wait until everything that was asked for is done."""
        ...

    def time(self, work: Callable[[], None]) -> float:
        """The seconds that the device spends on what `work` asks for. Waits for it."""
        ...

    def forget_bindings(self) -> None:
        """Let the driver forget what the last program read and wrote.

        Until then it may keep the memory of textures that were released.
        """
        ...

    def take_error(self) -> str:
        """The error that a call has caused since this was asked last, such as `GL_OUT_OF_MEMORY`; "" without one."""
        ...

    def take_written(self) -> frozenset[int]:
        """The native handles of textures whose pixels were written since this was asked last."""
        ...

    # --- the window it draws to, where it has one ---------------------------------------------------------------------

    def target_window(self) -> None:
        """Let others draw to the window again."""
        ...

    def clear_window(self, region: PixelRect, color: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        """Fill a part of the window, row 0 at the bottom, with one color."""
        ...

    def read_window_pixel(self) -> tuple[int, int, int]:
        """The pixel at the lower left corner of the window; the one right of it turns black."""
        ...

    def read_window(self, size: tuple[int, int]) -> np.ndarray:
        """A window of that size as it was shown last: [height, width, 3] of 8 bits, row 0 on top.

        The second pixel of the last row turns black, in the window too.
        """
        ...

    def close(self) -> None:
        """Give the device back. Nothing created on it can be used any more."""
        ...
