"""An OpenGL context, and what it can do."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import cached_property
from threading import current_thread, get_ident

import moderngl
import numpy as np
from msgspec import Struct, field
from msgspec.structs import replace

from ...compiler import Target
from ...compiler.devices import is_software
from ...errors import DeviceError, UsageError

OLDEST = 410
"""macOS stops at OpenGL 4.1."""


class Device(Struct, frozen=True, dict=True):
    """An OpenGL context and what the compiler needs to know of it."""

    context: moderngl.Context
    target: Target
    shared: bool = False
    """True if the context belongs to somebody else, a window say, and is current whenever we are called."""
    thread: int = field(default_factory=get_ident)
    """The thread that opened it: a context is current on one thread, and only there can it be used."""

    def current(self) -> AbstractContextManager[object]:
        """Our context is the current one inside this block, whatever other contexts the process has.

        Raises UsageError on another thread than the one that opened the device.
        """
        if get_ident() != self.thread:
            name = current_thread().name
            raise UsageError(f"thread '{name}' did not open this device and cannot render on it: open one there")
        return nullcontext() if self.shared else self.context

    def within(self, memory: int) -> Device:
        """The same device, of which plans use no more bytes than that; 0 for all that there are."""
        return replace(self, target=replace(self.target, memory=memory))

    def to_screen(self) -> None:
        """What is drawn next by others goes to the window again."""
        self.context.screen.use()

    def read_screen(self) -> np.ndarray:
        """The window as it was shown last: [height, width, 3] of 8 bits, row 0 on top."""
        width, height = self.context.screen.size
        pixels = np.frombuffer(self.context.screen.read(components=3, alignment=1), np.uint8)
        return pixels.reshape(height, width, 3)[::-1]

    @contextmanager
    def drawing(self) -> Iterator[moderngl.Context]:
        """Our context is current inside this block; afterwards the framebuffer is bound that was bound before."""
        with self.current():
            before = self.context.fbo or self.idle
            try:
                self.context.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
                yield self.context
            finally:
                before.use()

    @cached_property
    def idle(self) -> moderngl.Framebuffer:
        """What stays bound between draws: moderngl rebinds the last framebuffer, even one that was released."""
        return self.context.framebuffer([self.context.texture((1, 1), 1)])

    def close(self) -> None:
        """Give the context back. Nothing made on it can be used any more."""
        self.context.release()

    @property
    def driver(self) -> str:
        """What the driver says of its version, such as `4.5 (Core Profile) Mesa 22.3.6`."""
        return str(self.context.info["GL_VERSION"])

    @property
    def description(self) -> str:
        """One line that says what does the work."""
        kind = "software rasterizer" if self.target.software else "GPU"
        return f"{self.target.renderer} ({kind}, OpenGL {self.target.version / 100:.1f}, {self.target.form} passes)"


def describe(context: moderngl.Context) -> Target:
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
