"""Opens Mesa's software rasterizer with pinned settings, so that it gives the same bytes on all machines.

Passes are fragment shaders, intermediates have 32 bits (`RenderRequest.precision`), and the processor's instructions
stop at SSE 4.1: newer ones multiply and add in one step, which rounds once instead of twice. The number of threads
changes no bit; the width of vectors only changes the renderer's name.
"""

from __future__ import annotations

from pathlib import Path

from ..resources.sandbox import Sandbox
from .device import Device
from .opengl.driver_settings import DriverSettings
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
    "GLCONTEXT_DEVICE_INDEX",
)
_MESA = Path("/usr/share/glvnd/egl_vendor.d/50_mesa.json")


def pin_driver() -> DriverSettings:
    """The settings under which a context is the software rasterizer's, where the system has one."""
    vendor = {"__EGL_VENDOR_LIBRARY_FILENAMES": str(_MESA)} if _MESA.is_file() else {}
    return DriverSettings({**_PINNED_VARIABLES, **vendor}, _REMOVED_VARIABLES)


def open_pinned(memory: int = 0, *, sandbox: Sandbox) -> Device:
    """The pinned software rasterizer, or another device if there is none. Raises DeviceError without OpenGL.

    `Device.target.software` says which one it is.
    """
    return open_device("fragment", memory, sandbox=sandbox, driver=pin_driver())
