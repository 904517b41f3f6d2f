"""Textures on OpenGL: pictures, and the tables of color programs."""

from __future__ import annotations

import moderngl
import numpy as np
from halation.nodes import Size
from msgspec import Struct

from ...errors import DeviceError
from ...resources.color_program import LookupTable
from ..device import TextureDepth


class OpenGLTexture(Struct, eq=False):
    """A texture, and the framebuffer through which it is drawn to and read."""

    context: moderngl.Context
    handle: moderngl.Texture
    written: set[int]
    """The names of all textures of the device that were written."""
    _framebuffer: moderngl.Framebuffer | None = None

    @property
    def size(self) -> Size:
        return self.handle.size

    @property
    def components(self) -> int:
        return self.handle.components

    @property
    def native_handle(self) -> int:
        return self.handle.glo

    @property
    def framebuffer(self) -> moderngl.Framebuffer:
        """A framebuffer with this texture alone, made when it is first wanted."""
        if self._framebuffer is None:
            self._framebuffer = self.context.framebuffer([self.handle])
        return self._framebuffer

    def write(self, pixels: np.ndarray) -> None:
        self.handle.write(pixels)
        self.written.add(self.handle.glo)

    def read_into(self, pixels: np.ndarray) -> None:
        self.handle.read_into(pixels)

    def release(self) -> None:
        if self._framebuffer is not None:
            self._framebuffer.release()
        self.handle.release()


def create_texture(
    context: moderngl.Context, size: Size, components: int, depth: TextureDepth, linear: bool, written: set[int]
) -> OpenGLTexture:
    """A texture of undefined pixels, clamped at its edges. Raises DeviceError where there is no room for it.

    Its name is added to `written` whenever it is.
    """
    context.error  # noqa: B018  (reading it clears what earlier calls left behind)
    fault = f"the device has no room for a texture of {size[0]}x{size[1]} pixels"
    try:
        handle = context.texture(size, components, dtype=depth)
    except moderngl.Error:
        raise DeviceError(fault) from None
    # moderngl does not raise when the driver is out of memory.
    if context.error != "GL_NO_ERROR":
        handle.release()
        raise DeviceError(fault)
    _set_sampling(handle, linear)
    return OpenGLTexture(context, handle, written)


def create_table(context: moderngl.Context, table: LookupTable) -> moderngl.Texture | moderngl.Texture3D:
    """A table of two or three dimensions as a texture, clamped at its edges."""
    values = np.ascontiguousarray(table.values, np.float32)
    *depth, height, width, channels = values.shape
    if depth:
        texture = context.texture3d((width, height, depth[0]), channels, values, dtype="f4")
        texture.repeat_z = False
    else:
        texture = context.texture((width, height), channels, values, dtype="f4")
    _set_sampling(texture, table.linear)
    return texture


def _set_sampling(texture: moderngl.Texture | moderngl.Texture3D, linear: bool) -> None:
    way = moderngl.LINEAR if linear else moderngl.NEAREST
    texture.filter = (way, way)
    texture.repeat_x = texture.repeat_y = False
