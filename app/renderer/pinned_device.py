"""Opens Mesa's software rasterizer with pinned settings, so that it gives the same bytes on all machines.

Passes are fragment shaders, intermediates have 32 bits (`RenderRequest.precision`), and the processor's instructions
stop at SSE 4.1: newer ones multiply and add in one step, which rounds once instead of twice. The number of threads
changes no bit; the width of vectors only changes the renderer's name.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..resources.sandbox import Sandbox
from .device import Device
from .opening import open_device

_PINNED_VARIABLES = {
    "LIBGL_ALWAYS_SOFTWARE": "1",
    "GALLIUM_DRIVER": "llvmpipe",
    "GALLIUM_OVERRIDE_CPU_CAPS": "sse4.1",
    "LP_NATIVE_VECTOR_WIDTH": "128",
}
_REMOVED_VARIABLES = (
    "MESA_LOADER_DRIVER_OVERRIDE",
    "MESA_GL_VERSION_OVERRIDE",
    "MESA_GLSL_VERSION_OVERRIDE",
    "MESA_EXTENSION_OVERRIDE",
    "MESA_NO_ERROR",
    "GALLIUM_NOSSE",
    "LP_DEBUG",
    "LP_PERF",
    "GALLIVM_DEBUG",
    "GALLIVM_PERF",
    "DRI_PRIME",
)
_MESA = Path("/usr/share/glvnd/egl_vendor.d/50_mesa.json")


@contextmanager
def pin_driver() -> Iterator[None]:
    """Let OpenGL contexts that are opened in this block use the pinned software rasterizer, if the system has it.

    Afterwards the environment variables are as before. A process that has already opened a context keeps the
    instructions that the driver chose then.
    """
    pinned = {**_PINNED_VARIABLES, **({"__EGL_VENDOR_LIBRARY_FILENAMES": str(_MESA)} if _MESA.is_file() else {})}
    before = {name: os.environ.get(name) for name in (*pinned, *_REMOVED_VARIABLES)}
    for name in _REMOVED_VARIABLES:
        os.environ.pop(name, None)
    os.environ.update(pinned)
    try:
        yield
    finally:
        for name, text in before.items():
            if text is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = text


def open_pinned(memory: int = 0, *, sandbox: Sandbox) -> Device:
    """The pinned software rasterizer, or another device if there is none. Raises DeviceError without OpenGL.

    `Device.target.software` says which one it is.
    """
    with pin_driver():
        return open_device("fragment", memory, sandbox=sandbox)
