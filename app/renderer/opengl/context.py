"""Opening OpenGL: a context of our own without a window, or the one of a window."""

from __future__ import annotations

import sys
import weakref
from collections.abc import Callable

import moderngl

from ...errors import DeviceError
from ...resources.machine import suggest_driver
from .device import OLDEST, OpenGLDevice, describe_target
from .driver_settings import DriverSettings
from .warming import EGL_LIBRARY, GL, wait_for_driver


def open_standalone(driver: DriverSettings) -> OpenGLDevice:
    """A device without a window. Raises DeviceError where OpenGL cannot be opened, or is too old.

    It ends with the last reference to it, or is closed before: moderngl ends no context by itself.
    """
    wait_for_driver()
    with driver.apply():
        context = _create_context()
        device = OpenGLDevice(context, describe_target(context))
        weakref.finalize(context, context.mglo.release).atexit = False
        return device


def open_current() -> OpenGLDevice:
    """The device of the context that is current on this thread, a window's. Raises DeviceError if it is too old."""
    moderngl.init_context()
    context = moderngl.get_context()
    return OpenGLDevice(context, describe_target(context), shared=True)


def _create_context() -> moderngl.Context:
    named = {"libegl": EGL_LIBRARY, "libgl": GL}  # searching for them would take two processes
    ways = ({"backend": "egl", **named}, {"backend": "egl"}, {}) if sys.platform.startswith("linux") else ({},)
    create: Callable[..., moderngl.Context] = moderngl.create_context  # its stub knows nothing of backends
    faults: list[str] = []
    for way in ways:
        try:
            return create(standalone=True, require=OLDEST, **way)
        except Exception as fault:  # moderngl and its loaders raise plain Exceptions
            faults.append(str(fault).strip().rstrip("."))
    reasons = "; ".join(dict.fromkeys(faults))
    raise DeviceError(f"OpenGL {OLDEST / 100:.1f} cannot be opened ({reasons}): {suggest_driver()}")
