"""Opening OpenGL, with or without a display, with the form of passes that suits it."""

from __future__ import annotations

import sys
from collections.abc import Callable

import moderngl
from msgspec.structs import replace

from ..compiler import Form
from ..compiler.devices import choose
from ..errors import DeviceError
from .calibration import kept_or_measured
from .opengl.device import OLDEST, Device, describe
from .opengl.warming import EGL, GL


def open_device(form: Form | None = None) -> Device:
    """Open OpenGL without a window. Raises DeviceError where there is none, or one that is too old.

    `form` overrides how passes are emitted; otherwise the table says, or what was measured at the first start.
    """
    context = _standalone()
    return _fitted(Device(context, describe(context)), form)


def adopt(form: Form | None = None) -> Device:
    """The device of the OpenGL context that is current on this thread, a window's. Raises DeviceError if it is old."""
    moderngl.init_context()
    context = moderngl.get_context()
    return _fitted(Device(context, describe(context), shared=True), form)


def _fitted(device: Device, form: Form | None) -> Device:
    target = device.target
    chosen = choose(target.renderer, target.version, form, lambda: kept_or_measured(device))
    return replace(device, target=replace(target, form=chosen.form, why=chosen.why))


def _standalone() -> moderngl.Context:
    named = {"libegl": EGL, "libgl": GL}  # searching for them would take two processes
    ways = ({"backend": "egl", **named}, {"backend": "egl"}, {}) if sys.platform.startswith("linux") else ({},)
    create: Callable[..., moderngl.Context] = moderngl.create_context  # its stub knows nothing of backends
    faults: list[str] = []
    for way in ways:
        try:
            return create(standalone=True, require=OLDEST, **way)
        except Exception as fault:  # moderngl and its loaders raise plain Exceptions
            faults.append(str(fault).strip().rstrip("."))
    raise DeviceError(f"OpenGL {OLDEST / 100:.1f} cannot be opened ({'; '.join(dict.fromkeys(faults))}): {_way_out()}")


def _way_out() -> str:
    if sys.platform.startswith("linux"):
        return "install a graphics driver or the software rasterizer (Debian, Ubuntu: apt-get install libegl1 libgl1)"
    if sys.platform == "win32":
        return "install the graphics driver of your card's maker"
    return "run where a window system is available"
